#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/broad_phase/count.h"
#include "carom/broad_phase/reach.h"

namespace carom {

/// One grid for balls of about one size, in a plain array. Its pairs are those of BruteForce, where the
/// contract of a broad phase stands.
///
/// A cell is as wide as two balls reach, so that those that may meet are in one cell or in neighbours. Space
/// is wrapped around the array, like a thread around a reel: the cells along an axis are numbered 0 to n - 1
/// and then again from 0. So there is no border, balls that fly far away cost nothing, and cells that share a
/// place are told apart by the distance test that is made anyway. Unlike in a hash table the cells of a row
/// lie side by side: what a ball may meet is in two stretches of balls in 2D, and five in 3D. Source of the
/// stretches: D. Frenkel, B. Smit, "Understanding Molecular Simulation" (2002), appendix F, "cell lists".
template <int Dim, class Count = NoCount>
class WrappedGrid {
 public:
  static constexpr std::string_view kName = "wrapped-grid";

  void build(const VectorColumn<Dim>& position, Bounds bound, const Threads& threads = Threads()) {
    position_ = &position;
    bound_ = bound;
    largest_bound_ = threads.largest(bound.size(), [&](std::size_t ball) { return double{bound[ball]}; });
    cells_per_m_ = 0.5 / (largest_bound_ * (1.0 + kSlack));
    choose_shape();
    sort_into_cells(threads);
  }

  std::size_t size() const { return bound_.size(); }

  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for_each_pair(0, size(), visit);
  }

  /// The pairs of a stretch of the balls as they stand in the cells: of all rows that begin there. Each cell
  /// meets itself and those behind it: of two neighbours one is behind the other.
  template <class Visit>
  void for_each_pair(std::size_t begin, std::size_t end, Visit&& visit) const {
    const std::int32_t rows = shape_[1] * (Dim == 3 ? shape_[Dim - 1] : 1);
    for (std::int32_t row = 0; row < rows; ++row) {
      const std::uint32_t row_begin = cells(row, 0, 0).first;
      if (row_begin < begin || row_begin >= end) continue;
      const auto behind = rows_behind(row);
      for (std::int32_t x = 0; x < shape_[0]; ++x) {
        const Stretch own = cells(row, x, 1);
        for (std::uint32_t p = own.first; p < own.end; ++p) {
          visit_stretch(p, {p + 1, own.end}, visit);
          visit_row(p, row, x + 1, 1, visit);
          for (const std::int32_t other : behind) visit_row(p, other, x - 1, 3, visit);
        }
      }
    }
  }

  void bound_grew(std::size_t ball) { largest_bound_ = std::max(largest_bound_, double{bound_[ball]}); }

  /// All balls in the cells around: where in its cell a ball stood is not kept.
  template <class Visit>
  void for_each_near(const Reach<Dim>& reach, Visit&& visit) const {
    // Along an axis cells differ by at most the whole part of the distance, in cells, and one.
    const double away = std::min(0x1p29, (reach.bound + largest_bound_) * cells_per_m_ + kRounding);
    const std::int32_t around = static_cast<std::int32_t>(away) + 1;
    std::array<std::int32_t, 3> first{};
    std::array<std::int32_t, 3> count = {1, 1, 1};
    for (int axis = 0; axis < Dim; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      count[k] = std::min(2 * around + 1, shape_[k]);
      first[k] = wrapped(cell_along(axis, reach.centre[axis]), k) - (count[k] < shape_[k] ? around : 0);
    }
    for (std::int32_t z = first[2]; z < first[2] + count[2]; ++z) {
      for (std::int32_t y = first[1]; y < first[1] + count[1]; ++y) {
        for_each_stretch(row_of(y, z), first[0], count[0], [&](Stretch stretch) {
          for (std::uint32_t q = stretch.first; q < stretch.end; ++q) visit(std::size_t{ball_at_[q]});
        });
      }
    }
  }

  /// Cell by cell.
  void hand_over_order(Column<std::uint32_t>& balls) {
    balls = std::move(ball_at_);
    ball_at_ = {};
    start_ = {};
  }

  const Count& count() const { return count_; }

 private:
  /// Balls from one place of ball_at_ up to, but without, another.
  struct Stretch {
    std::uint32_t first;
    std::uint32_t end;
  };

  /// Cell numbers are counted from here, so that they are positive, and end at twice as much: what is farther
  /// away shares the outermost cells. Rounding moves a place by less than kRounding of a cell (2³¹ u and a
  /// few u more, u = 2⁻⁵³), and a cell is wider than two reaches by more than that: of balls that may meet,
  /// with |x_a - x_b| <= s (1 + 4u) along each axis (half_width()), cells differ by one at most.
  static constexpr double kMiddle = 0x1p30;
  static constexpr double kRounding = 0x1p-20;
  static constexpr double kSlack = 0x1p-18;
  /// Rows behind a row: beside it, and in 3D the three below.
  static constexpr std::size_t kRowsBehind = Dim == 2 ? 1 : 4;
  /// Fewer cells along an axis, and a neighbour on one side would be the one on the other side, too.
  static constexpr std::int32_t kFewestCells = 3;
  static constexpr std::size_t kSample = 1024;

  Reach<Dim> reach(std::size_t ball) const { return {(*position_)[ball], bound_[ball]}; }

  /// As many cells along each axis as the balls take, had they filled a box evenly whose sides are √12 times
  /// the spread of their places; and not many more in all than there are balls.
  void choose_shape() {
    const std::size_t stride = std::max<std::size_t>(1, bound_.size() / kSample);
    double cells = 1.0;
    std::array<double, Dim> along;
    for (int axis = 0; axis < Dim; ++axis) {
      const double sides = std::sqrt(12.0) * spread(axis, stride);
      const double number = std::min(std::max(3.0, sides * cells_per_m_), 1e9);
      along[static_cast<std::size_t>(axis)] = number;
      cells *= number;
    }
    const double most = 2.0 * static_cast<double>(bound_.size()) + 64.0;
    const double scale = cells > most ? std::pow(most / cells, 1.0 / Dim) : 1.0;
    for (std::size_t k = 0; k < Dim; ++k) {
      shape_[k] = std::max(kFewestCells, static_cast<std::int32_t>(std::min(scale * along[k], most)));
      per_turn_[k] = 1.0 / shape_[k];
    }
  }

  double spread(int axis, std::size_t stride) const {
    double count = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < position_->size(); i += stride, ++count) sum += (*position_)[i][axis];
    double squares = 0.0;
    for (std::size_t i = 0; i < position_->size(); i += stride) {
      const double from_mean = (*position_)[i][axis] - sum / count;
      squares += from_mean * from_mean;
    }
    return std::sqrt(squares / std::max(count, 1.0));
  }

  /// The number of a place's cell before wrapping. The maximum in this order makes a place that is not a
  /// number one that has a cell.
  std::int32_t cell_along(int /*axis*/, double place) const {
    const double number = std::min(std::max(0.0, place * cells_per_m_ + kMiddle), 2.0 * kMiddle - 1.0);
    return static_cast<std::int32_t>(number);
  }

  /// Halves keep the quotient from rounding up or down to the next turn.
  std::int32_t wrapped(std::int32_t cell, std::size_t axis) const {
    const auto turns = static_cast<std::int32_t>((cell + 0.5) * per_turn_[axis]);
    return cell - turns * shape_[axis];
  }

  /// Counting sort.
  void sort_into_cells(const Threads& threads) {
    const std::size_t count = bound_.size();
    Column<std::uint32_t> cell_of(count, 0);
    threads.in_parallel(count, [&](std::size_t begin, std::size_t end) { find_cells(begin, end, cell_of); });
    std::size_t cells = 1;
    for (const std::int32_t along : shape_) cells *= static_cast<std::size_t>(along);
    start_.resize(cells + 1);
    start_[cells] = static_cast<std::uint32_t>(count);
    ball_at_.resize(count);
    threads.in_parallel(cells, [&](std::size_t begin, std::size_t end) { fill_cells(begin, end, cell_of); });
    count_.build_operations(cells + 2 * count);
  }

  void find_cells(std::size_t begin, std::size_t end, std::span<std::uint32_t> cell_of) const {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec<Dim>& place = (*position_)[i];
      std::uint32_t cell = 0;
      for (int axis = Dim; axis-- > 0;) {
        const auto k = static_cast<std::size_t>(axis);
        const std::int32_t along = wrapped(cell_along(axis, place[axis]), k);
        cell = cell * static_cast<std::uint32_t>(shape_[k]) + static_cast<std::uint32_t>(along);
      }
      cell_of[i] = cell;
    }
  }

  /// Fills a stretch of the cells: threads look at the cells of all balls, and write to their own stretch.
  void fill_cells(std::size_t begin, std::size_t end, std::span<const std::uint32_t> cell_of) {
    const auto is_before = [begin](std::uint32_t cell) { return cell < begin; };
    const auto is_own = [begin, end](std::uint32_t cell) { return cell - begin < end - begin; };
    std::fill(start_.data() + begin, start_.data() + end, 0U);
    for (const std::uint32_t cell : cell_of) {
      if (is_own(cell)) ++start_[cell];
    }
    auto filled =
        static_cast<std::uint32_t>(begin == 0 ? 0 : std::count_if(cell_of.begin(), cell_of.end(), is_before));
    for (std::size_t cell = begin; cell < end; ++cell) start_[cell] = filled += start_[cell];
    // Filled from behind, so that every end of a cell becomes its start.
    for (std::size_t i = cell_of.size(); i-- > 0;) {
      if (is_own(cell_of[i])) ball_at_[--start_[cell_of[i]]] = static_cast<std::uint32_t>(i);
    }
  }

  // --- rows of cells, which may be numbered beyond the ends of the array

  static std::int32_t turned(std::int32_t number, std::int32_t count) {
    return number < 0 ? number + count : (number >= count ? number - count : number);
  }

  std::int32_t row_of(std::int32_t y, std::int32_t z) const {
    if constexpr (Dim == 2) return turned(y, shape_[1]);
    return turned(z, shape_[Dim - 1]) * shape_[1] + turned(y, shape_[1]);
  }

  std::array<std::int32_t, kRowsBehind> rows_behind(std::int32_t row) const {
    const std::int32_t y = row % shape_[1];
    const std::int32_t z = row / shape_[1];
    if constexpr (Dim == 2)
      return {row_of(y + 1, 0)};
    else
      return {row_of(y + 1, z), row_of(y - 1, z + 1), row_of(y, z + 1), row_of(y + 1, z + 1)};
  }

  /// The balls in cells of a row. @pre the cells are in the array
  Stretch cells(std::int32_t row, std::int32_t x, std::int32_t number) const {
    const auto first =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(shape_[0]) + static_cast<std::size_t>(x);
    return {start_[first], start_[first + static_cast<std::size_t>(number)]};
  }

  /// Calls at(stretch) for cells of a row, which go around at its ends.
  template <class At>
  void for_each_stretch(std::int32_t row, std::int32_t x, std::int32_t number, At&& at) const {
    count_.cell_visits(static_cast<std::size_t>(number));
    if (x >= 0 && x + number <= shape_[0]) return at(cells(row, x, number));
    const std::int32_t first = turned(x, shape_[0]);
    const std::int32_t before_end = std::min(number, shape_[0] - first);
    at(cells(row, first, before_end));
    if (before_end < number) at(cells(row, 0, number - before_end));
  }

  template <class Visit>
  void visit_row(std::uint32_t p, std::int32_t row, std::int32_t x, std::int32_t number,
                 Visit&& visit) const {
    for_each_stretch(row, x, number, [&](Stretch stretch) { visit_stretch(p, stretch, visit); });
  }

  template <class Visit>
  void visit_stretch(std::uint32_t p, Stretch others, Visit&& visit) const {
    const std::size_t i = ball_at_[p];
    const Reach<Dim> self = reach(i);
    for (std::uint32_t q = others.first; q < others.end; ++q) {
      const std::size_t j = ball_at_[q];
      count_.pair_test();
      if (may_meet(self, reach(j))) visit(std::min(i, j), std::max(i, j));
    }
  }

  const VectorColumn<Dim>* position_ = nullptr;
  Bounds bound_;
  double largest_bound_ = 0.0;  ///< m
  double cells_per_m_ = 0.0;
  std::array<std::int32_t, Dim> shape_{};  ///< cells along each axis
  std::array<double, Dim> per_turn_{};     ///< 1/shape_
  Column<std::uint32_t> start_;            ///< of each cell in ball_at_, x fastest
  Column<std::uint32_t> ball_at_;          ///< the balls, cell by cell
  [[no_unique_address]] Count count_;
};

}  // namespace carom
