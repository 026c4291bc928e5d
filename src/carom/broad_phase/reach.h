#pragma once

#include <cmath>
#include <limits>
#include <span>

#include "carom/world.h"

namespace carom {

/// Of each ball, m: how far from where it stood it may be. Floats, for their rounding costs few pairs, and a
/// million of doubles four megabytes.
using Bounds = std::span<const float>;

/// The least of the floats that are not less.
inline float rounded_up(double value) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (value > std::numeric_limits<float>::max()) return kInfinity;
  const auto nearest = static_cast<float>(value);
  return nearest < value ? std::nextafter(nearest, kInfinity) : nearest;
}

/// Where a ball can be within a step, or while a list of pairs lives: no farther than `bound` metres from
/// `centre`.
template <int Dim>
struct Reach {
  Vec<Dim> centre;
  double bound;
};

/// Whether two balls may meet, the one question of every broad phase. It is asked in this one way, so that
/// all of them report the same pairs to the last bit; the order of the two does not matter.
template <int Dim>
bool may_meet(const Reach<Dim>& a, const Reach<Dim>& b) {
  const double sum = a.bound + b.bound;
  return (a.centre - b.centre).squaredNorm() <= sum * sum;
}

/// How far along each axis the box around a reach extends from its centre, rounding included: whatever
/// may_meet() says yes to has boxes that touch.
///
/// With u = ε/2, may_meet() squares a rounded difference and adds up, so |x_a - x_b| <= s (1 + 4u) along
/// every axis, s = bound_a + bound_b. The corners x ± (bound + slack) are each off by at most
/// u (|x| + 2 (bound + slack)), and slack = 8ε (|x| + bound) = 16u (|x| + bound) is more than twice these
/// together: it leaves room for a corner that is shifted by a rounded sum.
template <int Dim>
Vec<Dim> half_width(const Vec<Dim>& centre, double bound) {
  const Vec<Dim> along = Vec<Dim>::Constant(bound);
  return along + 8.0 * kEpsilon * (centre.cwiseAbs() + along);
}

/// The box around the places where balls can be.
template <int Dim>
struct ReachBox {
  Vec<Dim> low = Vec<Dim>::Constant(std::numeric_limits<double>::infinity());
  Vec<Dim> high = -low;

  static ReachBox around(const Reach<Dim>& reach) {
    const Vec<Dim> half = half_width<Dim>(reach.centre, reach.bound);
    return {reach.centre - half, reach.centre + half};
  }

  void include(const ReachBox& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }

  /// Without a branch for each side: which one keeps boxes apart no processor can foresee.
  bool touches(const ReachBox& other) const {
    unsigned touch = 1;
    for (int axis = 0; axis < Dim; ++axis) {
      touch &= unsigned{low[axis] <= other.high[axis]} & unsigned{other.low[axis] <= high[axis]};
    }
    return touch != 0;
  }
};

}  // namespace carom
