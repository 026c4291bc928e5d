#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scenario/scenario.h"

namespace carom::benchmark {

/// A gas of equal balls in a box as a plain program has it: arrays, a grid that is filled anew every step, a
/// bounce where balls overlap and approach. It is the yardstick beside which the evolvers are timed, in the
/// same run: no account, no laws, no order, no correction of overlaps.
template <int Dim>
class PlainGas {
 public:
  explicit PlainGas(const Scenario& scene) : diameter_m_(2.0 * scene.balls.front().radius) {
    for (int axis = 0; axis < Dim; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      low_[k] = scene.box->min[axis] + scene.balls.front().radius;
      high_[k] = scene.box->max[axis] - scene.balls.front().radius;
      cells_[k] = std::max(1, static_cast<int>((high_[k] - low_[k]) / (kCell * diameter_m_)));
      for (const Ball& ball : scene.balls) {
        x_[k].push_back(ball.position[axis]);
        v_[k].push_back(ball.velocity[axis]);
      }
    }
  }

  void advance(double step_s, std::int64_t steps) {
    for (std::int64_t k = 0; k < steps; ++k) {
      move(step_s);
      fill_cells();
      for (std::size_t cell = 0; cell + 1 < start_.size(); ++cell) bounce_around(static_cast<int>(cell));
    }
  }

 private:
  static constexpr double kCell = 1.3;  ///< diameters, the width of a cell that took the least time

  void move(double step_s) {
    for (std::size_t k = 0; k < Dim; ++k) {
      for (std::size_t i = 0; i < x_[k].size(); ++i) {
        x_[k][i] += step_s * v_[k][i];
        if (x_[k][i] < low_[k]) v_[k][i] = std::abs(v_[k][i]);
        if (x_[k][i] > high_[k]) v_[k][i] = -std::abs(v_[k][i]);
      }
    }
  }

  int along(std::size_t k, double x) const {
    const double share = (x - low_[k]) / (high_[k] - low_[k]);
    return std::clamp(static_cast<int>(share * cells_[k]), 0, cells_[k] - 1);
  }

  void fill_cells() {
    const std::size_t count = x_[0].size();
    std::size_t cells = 1;
    for (const int number : cells_) cells *= static_cast<std::size_t>(number);
    start_.assign(cells + 1, 0);
    cell_of_.resize(count);
    ball_at_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      int cell = 0;
      for (std::size_t k = Dim; k-- > 0;) cell = cell * cells_[k] + along(k, x_[k][i]);
      cell_of_[i] = cell;
      ++start_[static_cast<std::size_t>(cell)];
    }
    std::uint32_t end = 0;
    for (std::uint32_t& start : start_) start = end += start;
    for (std::size_t i = count; i-- > 0;) {
      ball_at_[--start_[static_cast<std::size_t>(cell_of_[i])]] = static_cast<std::uint32_t>(i);
    }
  }

  /// The balls of a cell with each other, and with those of the cells behind it: the next one in its row, and
  /// three in each of the next rows. Rows lie along x, so that the cells of a row are one stretch of balls.
  void bounce_around(int cell) {
    const auto own = static_cast<std::size_t>(cell);
    if (start_[own] == start_[own + 1]) return;
    const int x = cell % cells_[0];
    const int y = cell / cells_[0] % cells_[1];
    const int z = cell / cells_[0] / cells_[1];
    const int behind = std::min(x + 1, cells_[0] - 1);
    for (std::uint32_t p = start_[own]; p < start_[own + 1]; ++p)
      bounce_with(p, p + 1, start_of(behind + 1, y, z));
    const int depth = Dim == 3 && z + 1 < cells_[Dim - 1] ? 1 : 0;
    for (int dz = 0; dz <= depth; ++dz) {
      for (int row = dz == 0 ? y + 1 : std::max(y - 1, 0); row <= std::min(y + 1, cells_[1] - 1); ++row) {
        const std::uint32_t first = start_of(std::max(x - 1, 0), row, z + dz);
        const std::uint32_t end = start_of(behind + 1, row, z + dz);
        for (std::uint32_t p = start_[own]; p < start_[own + 1]; ++p) bounce_with(p, first, end);
      }
    }
  }

  std::uint32_t start_of(int x, int y, int z) const {
    return start_[static_cast<std::size_t>((z * cells_[1] + y) * cells_[0] + x)];
  }

  void bounce_with(std::uint32_t p, std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t q = first; q < end; ++q) bounce(ball_at_[p], ball_at_[q]);
  }

  void bounce(std::size_t i, std::size_t j) {
    double square = 0.0;
    double approach = 0.0;
    for (std::size_t k = 0; k < Dim; ++k) {
      const double d = x_[k][j] - x_[k][i];
      square += d * d;
      approach += d * (v_[k][j] - v_[k][i]);
    }
    if (square > diameter_m_ * diameter_m_ || approach >= 0.0) return;
    for (std::size_t k = 0; k < Dim; ++k) {
      const double change = approach / square * (x_[k][j] - x_[k][i]);
      v_[k][i] += change;
      v_[k][j] -= change;
    }
  }

  double diameter_m_;
  std::array<std::vector<double>, Dim> x_;
  std::array<std::vector<double>, Dim> v_;
  std::array<double, Dim> low_;  ///< m, of the centres
  std::array<double, Dim> high_;
  std::array<int, Dim> cells_;
  std::vector<std::uint32_t> start_;
  std::vector<int> cell_of_;
  std::vector<std::uint32_t> ball_at_;
};

}  // namespace carom::benchmark
