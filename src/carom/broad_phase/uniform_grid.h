#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "carom/broad_phase/count.h"
#include "carom/broad_phase/reach.h"

namespace carom {

/// Balls sorted into square (cubic) cells, found through a hash table so that space has no edges. Its pairs
/// are those of BruteForce, where the contract of a broad phase stands.
///
/// Balls of very different sizes, or speeds, would ruin a single grid: cells wide enough for the largest hold
/// thousands of the smallest. So there is one grid per size class, each class half as wide as the one above,
/// and a ball lives in the finest class whose cells are as wide as its own bounding circle. A pair is found
/// by its ball of the finer class, which looks around itself in its own class and in the coarser ones: at
/// most three cells along each axis in every class that is in use.
template <int Dim, class Count = NoCount>
class UniformGrid {
 public:
  static constexpr std::string_view kName = "uniform-grid";

  void build(const VectorColumn<Dim>& position, Bounds bound) {
    bound_ = bound;
    choose_classes();
    sort_into_buckets(position);
  }

  /// Within a class a ball finds those in the layers of cells above its own, and in its own layer those with
  /// higher numbers.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (const Entry& self : entries_) {
      const auto visit_pair = [&](std::size_t j) {
        visit(std::min<std::size_t>(self.ball, j), std::max<std::size_t>(self.ball, j));
      };
      const std::int64_t layer = self.cell.back();
      Block block = block_around(self.reach, self.level);
      block.low.back() = layer;
      visit_block(self.reach, block, visit_pair, [&self, layer](const Entry& other) {
        return other.cell.back() > layer || (other.cell.back() == layer && other.ball > self.ball);
      });
      for (std::size_t level = self.level + std::size_t{1}; level < levels_.size(); ++level) {
        if (levels_[level].balls == 0) continue;
        visit_block(self.reach, block_around(self.reach, level), visit_pair,
                    [](const Entry&) { return true; });
      }
    }
  }

  void bound_grew(std::size_t ball) {
    Entry& entry = entries_[place_of_[ball]];
    entry.reach.bound = bound_[ball];
    note_bound(levels_[entry.level], bound_[ball]);
  }

  template <class Visit>
  void for_each_near(const Reach<Dim>& reach, Visit&& visit) const {
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      if (levels_[level].balls == 0) continue;
      visit_block(reach, block_around(reach, level), visit, [](const Entry&) { return true; });
    }
  }

  const Count& count() const { return count_; }

 private:
  using Cell = std::array<std::int64_t, Dim>;

  /// One grid; level 0 is the finest.
  struct Level {
    double cells_per_m = 0.0;
    double largest_bound = 0.0;  ///< m, of the balls in it
    std::size_t balls = 0;
  };

  struct Entry {
    Reach<Dim> reach;
    Cell cell;
    std::uint32_t level;
    std::uint32_t ball;
  };

  /// All cells of a level from `low` to `high`, both included.
  struct Block {
    Cell low;
    Cell high;
    std::size_t level;
  };

  /// Halvings of the cell width beyond which balls share the finest class: 2⁻³⁰ of the largest ball.
  static constexpr int kMostLevels = 30;

  static void note_bound(Level& level, double bound) {
    level.largest_bound = std::max(level.largest_bound, bound);
  }

  void choose_classes() {
    levels_.clear();
    level_.resize(bound_.size());
    if (bound_.empty()) return;
    const auto [smallest, largest] = std::minmax_element(bound_.begin(), bound_.end());
    int count = 1;
    while (count < kMostLevels && std::ldexp(*largest, -count) >= *smallest) ++count;
    levels_.resize(static_cast<std::size_t>(count));
    std::array<double, kMostLevels> widest{};  // m, the bounds that fit into each class
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      widest[level] = std::ldexp(*largest, static_cast<int>(level) + 1 - count);
      levels_[level].cells_per_m = 0.5 / widest[level];
    }
    for (std::size_t i = 0; i < bound_.size(); ++i) {
      std::uint32_t level = 0;
      while (level + 1 < levels_.size() && widest[level] < bound_[i]) ++level;
      level_[i] = level;
      ++levels_[level].balls;
      note_bound(levels_[level], bound_[i]);
    }
  }

  /// Counting sort of the balls by the bucket of their cell.
  void sort_into_buckets(const VectorColumn<Dim>& position) {
    std::size_t buckets = 16;
    while (buckets < 2 * bound_.size()) buckets *= 2;
    mask_ = buckets - 1;
    bucket_start_.assign(buckets + 1, 0);
    bucket_of_.resize(bound_.size());
    for (std::size_t i = 0; i < bound_.size(); ++i) {
      bucket_of_[i] = bucket(cell_of(position[i], level_[i]), level_[i]);
      ++bucket_start_[bucket_of_[i]];
    }
    std::uint32_t end = 0;
    for (std::uint32_t& start : bucket_start_) start = end += start;
    // Filled from behind, so that every end of a bucket becomes its start.
    entries_.resize(bound_.size());
    place_of_.resize(bound_.size());
    for (std::size_t i = bound_.size(); i-- > 0;) {
      place_of_[i] = --bucket_start_[bucket_of_[i]];
      entries_[place_of_[i]] = {{position[i], bound_[i]},
                                cell_of(position[i], level_[i]),
                                level_[i],
                                static_cast<std::uint32_t>(i)};
    }
    count_.build_operations(buckets + 2 * bound_.size());
  }

  Cell cell_of(const Vec<Dim>& place, std::size_t level) const {
    Cell cell;
    for (int axis = 0; axis < Dim; ++axis) {
      // A coordinate beyond the range of the cell number shares the outermost cell.
      const double number = std::min(0x1p62, std::max(-0x1p62, place[axis] * levels_[level].cells_per_m));
      const auto towards_zero = static_cast<std::int64_t>(number);
      cell[static_cast<std::size_t>(axis)] =
          towards_zero - (static_cast<double>(towards_zero) > number ? 1 : 0);
    }
    return cell;
  }

  /// The bucket of a cell; the next cell along x is in the next one, so that a row of cells is one stretch.
  std::size_t bucket(const Cell& cell, std::size_t level) const {
    // Odd multipliers mix the coordinates (Fibonacci hashing, D. Knuth, TAOCP vol. 3, §6.4).
    constexpr std::array<std::uint64_t, 2> kOdd = {0x9E3779B97F4A7C15U, 0xC2B2AE3D27D4EB4FU};
    std::uint64_t hash = level * 0x27D4EB2F165667C5U;
    for (std::size_t axis = 1; axis < Dim; ++axis) {
      hash = (hash ^ static_cast<std::uint64_t>(cell[axis])) * kOdd[axis - 1];
      hash ^= hash >> 29;
    }
    return (hash + static_cast<std::uint64_t>(cell[0])) & mask_;
  }

  /// The cells of a level with all balls that may meet this one.
  Block block_around(const Reach<Dim>& reach, std::size_t level) const {
    const Vec<Dim> half = half_width<Dim>(reach.centre, reach.bound + levels_[level].largest_bound);
    return {cell_of(reach.centre - half, level), cell_of(reach.centre + half, level), level};
  }

  /// Calls visit(j) for the wanted balls in a block that something with this reach may meet.
  template <class Visit, class Wanted>
  void visit_block(const Reach<Dim>& reach, const Block& block, Visit&& visit, Wanted&& wanted) const {
    const auto visit_if_near = [&](const Entry& other) {
      if (other.level != block.level || !wanted(other)) return;
      count_.pair_test();
      if (may_meet(reach, other.reach)) visit(std::size_t{other.ball});
    };
    if (cells_in(block) > static_cast<double>(entries_.size())) {  // cheaper to look at every ball
      for (const Entry& other : entries_) visit_if_near(other);
      return;
    }
    for (Cell row = block.low; row[Dim - 1] <= block.high[Dim - 1]; next_row(row, block)) {
      for_each_in_row(row, block, visit_if_near);
    }
  }

  static double cells_in(const Block& block) {
    double cells = 1.0;
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      cells *= static_cast<double>(block.high[axis]) - static_cast<double>(block.low[axis]) + 1.0;
    }
    return cells;
  }

  /// The next row of the block; past the last one its last coordinate leaves the block.
  static void next_row(Cell& row, const Block& block) {
    for (std::size_t axis = 1; axis < Dim; ++axis) {
      if (++row[axis] <= block.high[axis] || axis + 1 == Dim) return;
      row[axis] = block.low[axis];
    }
  }

  /// Calls at(entry) for the entries in the cells of a row, which starts in `row` and ends where the block
  /// does, and for some of other levels. @pre the row is shorter than the hash table
  template <class At>
  void for_each_in_row(const Cell& row, const Block& block, At&& at) const {
    auto left = static_cast<std::size_t>(block.high[0] - row[0]) + 1;
    count_.cell_visits(left);
    for (std::size_t first = bucket(row, block.level); left > 0; first = 0) {
      const std::size_t stretch = std::min(left, mask_ + 1 - first);  // up to the end of the table
      for (std::size_t e = bucket_start_[first]; e < bucket_start_[first + stretch]; ++e) {
        if (in_row(entries_[e].cell, row, block)) at(entries_[e]);
      }
      left -= stretch;
    }
  }

  static bool in_row(const Cell& cell, const Cell& row, const Block& block) {
    for (std::size_t axis = 1; axis < Dim; ++axis) {
      if (cell[axis] != row[axis]) return false;
    }
    return row[0] <= cell[0] && cell[0] <= block.high[0];
  }

  Bounds bound_;
  std::vector<Level> levels_;
  std::vector<std::uint32_t> level_;  ///< of each ball
  std::vector<Entry> entries_;        ///< the balls, bucket by bucket
  std::vector<std::uint32_t> bucket_start_;
  std::vector<std::uint32_t> place_of_;  ///< of each ball in entries_
  std::vector<std::size_t> bucket_of_;   ///< of each ball, for use while building
  std::size_t mask_ = 0;                 ///< buckets, a power of two, less one
  [[no_unique_address]] Count count_;
};

}  // namespace carom
