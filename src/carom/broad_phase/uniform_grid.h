#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "carom/world.h"

namespace carom {

/// Balls sorted into square (cubic) cells, found through a hash table so that space has no edges. Its pairs
/// are those of BruteForce, where the contract of a broad phase stands.
///
/// Balls of very different sizes, or speeds, would ruin a single grid: cells wide enough for the largest hold
/// thousands of the smallest. So there is one grid per size class, each class half as wide as the one above,
/// and a ball lives in the finest class whose cells are as wide as its own bounding circle. A pair is found
/// by its ball of the finer class, which looks around itself in its own class and in the coarser ones: at
/// most three cells along each axis in every class that is in use.
template <int Dim>
class UniformGrid {
 public:
  static constexpr std::string_view kName = "uniform-grid";

  void build(const VectorColumn<Dim>& position, std::span<const double> bound) {
    position_ = &position;
    bound_ = bound;
    choose_classes();
    sort_into_buckets();
  }

  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (std::size_t i = 0; i < bound_.size(); ++i) {
      for (std::size_t level = level_[i]; level < levels_.size(); ++level) {
        const bool own = level == level_[i];
        visit_level(i, level, [&](std::size_t j) {
          if (!own || j > i) visit(std::min(i, j), std::max(i, j));
        });
      }
    }
  }

  void bound_grew(std::size_t ball) {
    double& largest = levels_[level_[ball]].largest_bound;
    largest = std::max(largest, bound_[ball]);
  }

  template <class Visit>
  void for_each_near(std::size_t ball, Visit&& visit) const {
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      visit_level(ball, level, [&](std::size_t j) {
        if (j != ball) visit(j);
      });
    }
  }

 private:
  Vec<Dim> at(std::size_t ball) const { return (*position_)[ball]; }

  using Cell = std::array<std::int64_t, Dim>;

  /// One grid; level 0 is the finest.
  struct Level {
    double width = 0.0;          ///< m, of a cell
    double largest_bound = 0.0;  ///< m, of the balls in it
    std::size_t balls = 0;
  };

  struct Entry {
    Cell cell;
    std::uint32_t level;
    std::uint32_t ball;
  };

  /// Halvings of the cell width beyond which balls share the finest class: 2⁻³⁰ of the largest ball.
  static constexpr int kMostLevels = 30;

  void choose_classes() {
    const double largest = *std::max_element(bound_.begin(), bound_.end());
    const double smallest = *std::min_element(bound_.begin(), bound_.end());
    int count = 1;
    while (count < kMostLevels && std::ldexp(largest, -count) >= smallest) ++count;
    levels_.assign(static_cast<std::size_t>(count), {});
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      levels_[level].width = std::ldexp(2.0 * largest, static_cast<int>(level) + 1 - count);
    }
    level_.resize(bound_.size());
    for (std::size_t i = 0; i < bound_.size(); ++i) {
      std::uint32_t level = 0;
      while (level + 1 < levels_.size() && levels_[level].width < 2.0 * bound_[i]) ++level;
      level_[i] = level;
      ++levels_[level].balls;
      bound_grew(i);
    }
  }

  /// Counting sort of the balls by the hash of their cell.
  void sort_into_buckets() {
    std::size_t buckets = 16;
    while (buckets < 2 * bound_.size()) buckets *= 2;
    mask_ = buckets - 1;
    bucket_start_.assign(buckets + 1, 0);
    bucket_of_.resize(bound_.size());
    for (std::size_t i = 0; i < bound_.size(); ++i) {
      bucket_of_[i] = bucket(cell_of(at(i), levels_[level_[i]].width), level_[i]);
      ++bucket_start_[bucket_of_[i] + 1];
    }
    for (std::size_t b = 0; b < buckets; ++b) bucket_start_[b + 1] += bucket_start_[b];
    entries_.resize(bound_.size());
    fill_ = bucket_start_;
    for (std::size_t i = 0; i < bound_.size(); ++i) {
      entries_[fill_[bucket_of_[i]]++] = {cell_of(at(i), levels_[level_[i]].width), level_[i],
                                          static_cast<std::uint32_t>(i)};
    }
  }

  static Cell cell_of(const Vec<Dim>& place, double width) {
    Cell cell;
    for (int axis = 0; axis < Dim; ++axis) {
      // A coordinate beyond the range of the cell number shares the outermost cell.
      const double number = std::clamp(std::floor(place[axis] / width), -0x1p62, 0x1p62);
      cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(number);
    }
    return cell;
  }

  std::size_t bucket(const Cell& cell, std::size_t level) const {
    // Odd multipliers mix the coordinates (Fibonacci hashing, D. Knuth, TAOCP vol. 3, §6.4).
    constexpr std::array<std::uint64_t, 3> kOdd = {0x9E3779B97F4A7C15U, 0xC2B2AE3D27D4EB4FU,
                                                   0x165667B19E3779F9U};
    std::uint64_t hash = level * 0x27D4EB2F165667C5U;
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      hash = (hash ^ static_cast<std::uint64_t>(cell[axis])) * kOdd[axis];
      hash ^= hash >> 29;
    }
    return hash & mask_;
  }

  /// Calls visit(j) for the balls of a level, `ball` itself included, that `ball` may meet.
  template <class Visit>
  void visit_level(std::size_t ball, std::size_t level, Visit&& visit) const {
    const Level& grid = levels_[level];
    if (grid.balls == 0) return;
    const Vec<Dim> centre = at(ball);
    const double sum = bound_[ball] + grid.largest_bound;
    // A little more than the sum, so that rounding does not cut off a cell that an exactly reached ball is
    // in.
    const Vec<Dim> reach =
        Vec<Dim>::Constant(sum) + 4.0 * kEpsilon * (centre.cwiseAbs() + Vec<Dim>::Constant(sum));
    const Cell low = cell_of(centre - reach, grid.width);
    const Cell high = cell_of(centre + reach, grid.width);
    const auto visit_if_near = [&](std::size_t j) {
      const double sum = bound_[ball] + bound_[j];
      if ((at(ball) - at(j)).squaredNorm() <= sum * sum) visit(j);
    };

    double cells = 1.0;
    for (std::size_t axis = 0; axis < Dim; ++axis) cells *= static_cast<double>(high[axis] - low[axis]) + 1.0;
    if (cells > static_cast<double>(entries_.size())) {  // cheaper to look at every ball
      for (const Entry& entry : entries_) {
        if (entry.level == level) visit_if_near(entry.ball);
      }
      return;
    }
    for (Cell cell = low; cell[Dim - 1] <= high[Dim - 1]; advance(cell, low, high)) {
      const std::size_t b = bucket(cell, level);
      for (std::size_t e = bucket_start_[b]; e < bucket_start_[b + 1]; ++e) {
        if (entries_[e].level == level && entries_[e].cell == cell) visit_if_near(entries_[e].ball);
      }
    }
  }

  /// The next cell of the block from low to high; past the last one its last coordinate leaves the block.
  static void advance(Cell& cell, const Cell& low, const Cell& high) {
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      if (++cell[axis] <= high[axis] || axis + 1 == Dim) return;
      cell[axis] = low[axis];
    }
  }

  const VectorColumn<Dim>* position_ = nullptr;  ///< where the balls stood when the step began
  std::span<const double> bound_;
  std::vector<Level> levels_;
  std::vector<std::uint32_t> level_;  ///< of each ball
  std::vector<Entry> entries_;        ///< the balls, bucket by bucket
  std::vector<std::size_t> bucket_start_;
  std::vector<std::size_t> bucket_of_;
  std::vector<std::size_t> fill_;
  std::size_t mask_ = 0;
};

}  // namespace carom
