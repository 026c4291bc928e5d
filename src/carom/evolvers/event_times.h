#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "carom/evolvers/event_flights.h"
#include "carom/time_of_impact.h"

namespace carom {

/// A plane that balls stay above: normal·x - offset >= r.
template <int Dim>
struct EventWall {
  Vec<Dim> normal;
  double offset;  ///< m
};

/// When things will happen to balls on their present flights, on the flights' clocks, s; kNever where they do
/// not. Times are computed from where flights began: they are the same bits whenever one asks.
template <int Dim, bool kGravity>
class EventTimes {
 public:
  EventTimes(const EventFlights<Dim, kGravity>& flights, const Scenario& scene)
      : flights_(flights), step_s_(scene.step_s) {
    if constexpr (kGravity) field_speed_ = step_s_ * scene.effects.gravity->norm();
  }

  /// When the ball touches the wall.
  double to_wall(std::uint32_t ball, const EventWall<Dim>& wall) const {
    const double clock = flights_.clock(ball);
    const Motion<Dim> start = flights_.motion(ball, clock);
    const double gap = wall.normal.dot(start.x) - wall.offset - flights_.radius(ball);
    const double rounding = velocity_rounding(start.v.norm() + field_speed_);
    return clock + time_to_close(gap, wall.normal.dot(start.v), wall.normal.dot(start.a), rounding, step_s_);
  }

  /// False where the balls part, or pass by more than rounding: d·w >= 0, or |d × w|² > |w|² σ². Says nothing
  /// of those that are accelerated differently.
  bool might_touch(std::uint32_t i, std::uint32_t j) const {
    constexpr double kRounding = 64.0 * kEpsilon;
    const auto [a, b] = motions(i, j);
    const Vec<Dim> d = b.x - a.x;
    const Vec<Dim> w = b.v - a.v;
    const double sigma = flights_.radius(i) + flights_.radius(j);
    const bool approach = d.dot(w) < 0.0;
    const double reach = w.squaredNorm() * (sigma * sigma + kRounding * d.squaredNorm());
    const bool hit = cross_squared<Dim>(d, w) <= reach;
    bool might = static_cast<bool>(static_cast<int>(approach) & static_cast<int>(hit));
    if constexpr (kGravity) might = might || a.a != b.a;
    return might;
  }

  /// When the balls touch; the same whichever comes first.
  double to_touch(std::uint32_t i, std::uint32_t j) const {
    const double both = std::max(flights_.clock(i), flights_.clock(j));
    const auto [a, b] = motions(i, j);
    const Vec<Dim> d = b.x - a.x;
    const Vec<Dim> w = b.v - a.v;
    const double sigma = flights_.radius(i) + flights_.radius(j);
    const double rounding = velocity_rounding(a.v.norm() + b.v.norm() + field_speed_);
    if constexpr (kGravity) {
      const Vec<Dim> relative = b.a - a.a;
      if (!relative.isZero(0.0)) {
        const double horizon = time_out_of_reach(d.norm() + sigma, w.norm(), relative.norm());
        return both + time_to_touch<Dim>(d, w, relative, sigma, rounding, horizon);
      }
    }
    return both + time_to_touch<Dim>(d, w, sigma, rounding);
  }

  /// When the ball passes a side of its cell on the way up (direction 1) or down (-1) the axis, after
  /// `time_s`. Straight flights pass the side that they head for, the others have passed it before.
  double to_side(std::uint32_t ball, int axis, int direction, double side, double time_s) const {
    if constexpr (kGravity) {
      const Motion<Dim> motion = flights_.motion(ball, time_s);
      const double gap = std::max(0.0, direction * (side - motion.x[axis]));
      return time_s +
             time_to_close(gap, -direction * motion.v[axis], -direction * motion.a[axis], 0.0, step_s_);
    } else {
      const double clock = flights_.clock(ball);
      const Motion<Dim> start = flights_.motion(ball, clock);
      if (direction * start.v[axis] <= 0.0) return kNever;
      return clock + (side - start.x[axis]) / start.v[axis];
    }
  }

 private:
  /// Both balls when both are on their present flights.
  std::pair<Motion<Dim>, Motion<Dim>> motions(std::uint32_t i, std::uint32_t j) const {
    const double both = std::max(flights_.clock(i), flights_.clock(j));
    return {flights_.motion(i, both), flights_.motion(j, both)};
  }

  /// The time after which ½ a t² - w t exceeds the reach: bodies of relative acceleration a and velocity w
  /// are apart from then on.
  static double time_out_of_reach(double reach, double w, double a) {
    return (w + std::sqrt(w * w + 2.0 * a * reach)) / a;
  }

  const EventFlights<Dim, kGravity>& flights_;
  double step_s_;             ///< a time that counts, for telling motion from rounding
  double field_speed_ = 0.0;  ///< m/s, what gravity gives in it
};

}  // namespace carom
