#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/broad_phase/count.h"
#include "carom/broad_phase/reach.h"

namespace carom {

/// Balls sorted by where their reach begins along one axis, the one along which the centres spread most; a
/// sweep along it then meets only pairs whose intervals overlap. Its pairs are those of BruteForce, where
/// the contract of a broad phase stands.
///
/// A ball has all those in a slab across the space as its candidates: n^(1/2) of them in 2D and n^(2/3) in
/// 3D where balls fill a square or a cube, all in all O(n^(3/2)) and O(n^(5/3)), and O(n log n) only where
/// they stand in a row. Source: D. Baraff, "Dynamic Simulation of Non-Penetrating Rigid Bodies", thesis,
/// Cornell University (1992).
template <int Dim, class Count = NoCount>
class SortAndSweep {
 public:
  static constexpr std::string_view kName = "sort-and-sweep";

  void build(const VectorColumn<Dim>& position, Bounds bound) {
    bound_ = bound;
    growth_ = 0.0;
    axis_ = axis_of_largest_spread(position);
    sort_by_start(position);
    place_balls(position);
  }

  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (std::size_t a = 0; a < items_.size(); ++a) {
      const double end = end_of(items_[a].reach);
      for (std::size_t b = a + 1; b < items_.size() && start_[b].first <= end; ++b) {
        if (meets(items_[a].reach, items_[b].reach)) visit_in_order(items_[a].ball, items_[b].ball, visit);
      }
    }
  }

  /// The order stays that of the starts at build(): searches allow for how much they have moved since.
  void bound_grew(std::size_t ball) {
    const std::size_t place = place_of_[ball];
    Item& item = items_[place];
    item.reach.bound = bound_[ball];
    growth_ = std::max(growth_, start_[place].first - start_of(item.reach));
    const double end = end_of(item.reach);
    for (std::size_t b = place; b < items_.size() && farthest_end_[b] < end; ++b) farthest_end_[b] = end;
  }

  template <class Visit>
  void for_each_near(const Reach<Dim>& reach, Visit&& visit) const {
    const double start = start_of(reach);
    const double end = end_of(reach) + growth_;
    const auto behind = std::partition_point(start_.begin(), start_.end(),
                                             [end](const Start& other) { return other.first <= end; });
    for (auto b = static_cast<std::size_t>(behind - start_.begin()); b-- > 0 && farthest_end_[b] >= start;) {
      if (meets(reach, items_[b].reach)) visit(std::size_t{items_[b].ball});
    }
  }

  const Count& count() const { return count_; }

 private:
  struct Item {
    Reach<Dim> reach;
    std::uint32_t ball;
  };
  /// Where the reach of a ball begins, m, and the ball.
  using Start = std::pair<double, std::uint32_t>;

  static constexpr double kEndless = std::numeric_limits<double>::infinity();

  static int axis_of_largest_spread(const VectorColumn<Dim>& position) {
    int best = 0;
    double largest = 0.0;
    for (int axis = 0; axis < Dim; ++axis) {
      const auto [low, high] = position.range(axis);
      if (!(high - low > largest)) continue;
      largest = high - low;
      best = axis;
    }
    return best;
  }

  double start_of(const Reach<Dim>& reach) const { return ReachBox<Dim>::around(reach).low[axis_]; }
  double end_of(const Reach<Dim>& reach) const { return ReachBox<Dim>::around(reach).high[axis_]; }

  void sort_by_start(const VectorColumn<Dim>& position) {
    start_.clear();
    for (std::size_t i = 0; i < bound_.size(); ++i) {
      // The maximum in this order turns a start that is not a number into one that can be sorted.
      start_.emplace_back(std::max(-kEndless, start_of({position[i], bound_[i]})),
                          static_cast<std::uint32_t>(i));
    }
    std::sort(start_.begin(), start_.end(), [this](const Start& a, const Start& b) {
      count_.build_operations(1);
      return a < b;
    });
  }

  void place_balls(const VectorColumn<Dim>& position) {
    items_.resize(bound_.size());
    place_of_.resize(bound_.size());
    farthest_end_.resize(bound_.size());
    double farthest = -kEndless;
    for (std::size_t place = 0; place < items_.size(); ++place) {
      const std::uint32_t ball = start_[place].second;
      items_[place] = {{position[ball], bound_[ball]}, ball};
      place_of_[ball] = static_cast<std::uint32_t>(place);
      farthest = std::max(farthest, end_of(items_[place].reach));
      farthest_end_[place] = farthest;
    }
    count_.build_operations(items_.size());
  }

  bool meets(const Reach<Dim>& a, const Reach<Dim>& b) const {
    count_.pair_test();
    return may_meet(a, b);
  }

  template <class Visit>
  static void visit_in_order(std::size_t i, std::size_t j, Visit&& visit) {
    visit(std::min(i, j), std::max(i, j));
  }

  Bounds bound_;
  int axis_ = 0;
  std::vector<Start> start_;  ///< at build(), sorted; all that follows is in this order
  std::vector<Item> items_;
  std::vector<double> farthest_end_;     ///< m, of the reaches up to here
  std::vector<std::uint32_t> place_of_;  ///< of each ball in this order
  double growth_ = 0.0;                  ///< m, by which starts have moved since build() at most
  [[no_unique_address]] Count count_;
};

}  // namespace carom
