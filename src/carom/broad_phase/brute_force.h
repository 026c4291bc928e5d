#pragma once

#include <span>
#include <string_view>

#include "carom/broad_phase/count.h"
#include "carom/broad_phase/reach.h"

namespace carom {

/// Looks at all pairs: O(n²), obviously right, the twin of all other broad phases and the fastest for few
/// balls. What a broad phase promises stands in broad_phase.h.
template <int Dim, class Count = NoCount>
class BruteForce {
 public:
  static constexpr std::string_view kName = "brute-force";

  /// Notes where the balls stand. Positions and bounds are columns of the caller's: the positions stay as
  /// they are until the pairs are found, the bounds may grow later.
  void build(const VectorColumn<Dim>& position, Bounds bound) {
    position_ = &position;
    bound_ = bound;
  }

  /// Calls visit(i, j) once for every pair, i < j.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (std::size_t i = 0; i < bound_.size(); ++i) {
      for (std::size_t j = i + 1; j < bound_.size(); ++j) {
        if (meets(i, j)) visit(i, j);
      }
    }
  }

  /// Says that bound[ball] has grown.
  void bound_grew(std::size_t /*ball*/) {}

  /// Calls visit(j) for every ball that may meet something with this reach; here, for all.
  template <class Visit>
  void for_each_near(const Reach<Dim>& /*reach*/, Visit&& visit) const {
    for (std::size_t j = 0; j < bound_.size(); ++j) visit(j);
  }

  const Count& count() const { return count_; }

 private:
  Reach<Dim> reach(std::size_t ball) const { return {(*position_)[ball], bound_[ball]}; }

  bool meets(std::size_t i, std::size_t j) const {
    count_.pair_test();
    return may_meet(reach(i), reach(j));
  }

  const VectorColumn<Dim>* position_ = nullptr;  ///< where the balls stand
  Bounds bound_;
  [[no_unique_address]] Count count_;
};

}  // namespace carom
