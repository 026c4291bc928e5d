#pragma once

#include <span>
#include <string_view>

#include "carom/world.h"

namespace carom {

/// A broad phase finds the pairs of balls that may meet within a step: ball i stays within bound[i] of where
/// it stood when the step began, so i and j may meet only if |x_i - x_j| <= bound[i] + bound[j]. Every broad
/// phase reports exactly these pairs, in an order of its own; what follows does not depend on the order.
///
/// This one looks at all of them: O(n²), obviously right, the twin of all others and the fastest for few
/// balls.
template <int Dim>
class BruteForce {
 public:
  static constexpr std::string_view kName = "brute-force";

  /// Starts a step. Positions and bounds are columns of the caller's: the positions stay as they are during
  /// the step, the bounds may grow.
  void build(const VectorColumn<Dim>& position, std::span<const double> bound) {
    position_ = &position;
    bound_ = bound;
  }

  /// Calls visit(i, j) once for every pair, i < j.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (std::size_t i = 0; i < bound_.size(); ++i) {
      for (std::size_t j = i + 1; j < bound_.size(); ++j) {
        if (may_meet(i, j)) visit(i, j);
      }
    }
  }

  /// Says that bound[ball] has grown.
  void bound_grew(std::size_t /*ball*/) {}

  /// Calls visit(j) for every other ball that `ball` may meet.
  template <class Visit>
  void for_each_near(std::size_t ball, Visit&& visit) const {
    for (std::size_t j = 0; j < bound_.size(); ++j) {
      if (j != ball && may_meet(ball, j)) visit(j);
    }
  }

 private:
  Vec<Dim> at(std::size_t ball) const { return (*position_)[ball]; }

  bool may_meet(std::size_t i, std::size_t j) const {
    const double reach = bound_[i] + bound_[j];
    return (at(i) - at(j)).squaredNorm() <= reach * reach;
  }

  const VectorColumn<Dim>* position_ = nullptr;  ///< where the balls stood when the step began
  std::span<const double> bound_;
};

}  // namespace carom
