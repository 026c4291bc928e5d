#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "carom/evolvers/event_flights.h"
#include "carom/time_of_impact.h"

namespace carom {

/// A plane that balls stay above: normal·x - offset >= r.
template <int Dim>
struct EventWall {
  Vec<Dim> normal;
  double offset;  ///< m
};

/// When a ball leaves its cell, and by which side: up (direction 1) or down (-1) the axis.
struct EventCrossing {
  double time = kNever;  ///< s
  std::int8_t axis = 0;
  std::int8_t direction = 0;
  bool is_by_wall = true;  ///< false where no wall can be reached from within the cell
};

/// When things will happen to balls on their present flights, on the flights' clocks, s; kNever where they do
/// not. Times are computed from where flights began: they are the same bits whenever one asks.
template <int Dim, bool kGravity>
class EventTimes {
 public:
  EventTimes(const EventFlights<Dim, kGravity>& flights, const Scenario& scene)
      : flights_(flights), step_s_(scene.step_s) {
    if constexpr (kGravity) field_speed_ = step_s_ * scene.effects.gravity->norm();
    for (const Wall& wall : scene.walls) walls_.push_back({flattened<Dim>(wall.normal), wall.offset});
  }

  std::uint32_t walls() const { return static_cast<std::uint32_t>(walls_.size()); }
  const EventWall<Dim>& wall(std::uint32_t index) const { return walls_[index]; }

  /// False where balls that fly straight touch no wall while their centres are in the cell, or an eighth of
  /// its width outside, so that rounding has no say.
  bool is_by_wall(std::uint32_t ball, const Vec<Dim>& lower, double width_m) const {
    if constexpr (kGravity) return true;
    const Vec<Dim> centre = lower.array() + 0.5 * width_m;
    return std::any_of(walls_.begin(), walls_.end(), [&](const EventWall<Dim>& wall) {
      const double depth = (0.5 + 0.125) * width_m * wall.normal.template lpNorm<1>();
      return wall.normal.dot(centre) - depth - wall.offset <= flights_.radius(ball);
    });
  }

  /// False where the ball flies straight and does not reach the wall up to `until_s`, on its flight's clock.
  /// It is asked of twice the way, so that rounding has no say.
  bool might_reach(std::uint32_t ball, std::uint32_t index, double until_s) const {
    if constexpr (kGravity) return true;
    const EventWall<Dim>& wall = walls_[index];
    const double clock = flights_.clock(ball);
    const Motion<Dim> start = flights_.start(ball);
    const double closing = -wall.normal.dot(start.v);
    const double rounding_s = kEpsilon * (std::abs(clock) + std::abs(until_s));
    return closing > 0.0 && gap(ball, start, wall) <= 2.0 * closing * (until_s - clock + rounding_s);
  }

  /// When the ball touches the wall.
  double to_wall(std::uint32_t ball, std::uint32_t index) const {
    const EventWall<Dim>& wall = walls_[index];
    const double clock = flights_.clock(ball);
    const Motion<Dim> start = flights_.start(ball);
    const double rounding = velocity_rounding(speed_bound(start.v) + field_speed_);
    return clock + time_to_close(gap(ball, start, wall), wall.normal.dot(start.v), wall.normal.dot(start.a),
                                 rounding, step_s_);
  }

  /// False where the balls part, or pass by more than rounding: with d from i to j and w its rate of change,
  /// d·w > m |w|, or by Lagrange's identity
  ///   |d × w|² = d² w² - (d·w)² > w² (σ + m)².                                            (1)
  /// The margin m = kMargin σ is for what rebase() may do to d, see is_far_from_start(); what both sides of
  /// (1) and to_touch() are computed with has its own, a few epsilons of d² w². Says nothing of those that
  /// are accelerated differently.
  bool might_touch(std::uint32_t i, std::uint32_t j) const {
    constexpr double kRounding = 64.0 * kEpsilon;
    const double both = std::max(flights_.clock(i), flights_.clock(j));
    const double tau_i = both - flights_.clock(i);
    const double tau_j = both - flights_.clock(j);
    double approach = 0.0;
    double distance_2 = 0.0;
    double speed_2 = 0.0;
    for (int axis = 0; axis < Dim; ++axis) {
      const double d = flights_.place_after(tau_j, j, axis) - flights_.place_after(tau_i, i, axis);
      const double w = flights_.velocity_after(tau_j, j, axis) - flights_.velocity_after(tau_i, i, axis);
      approach += d * w;
      distance_2 += d * d;
      speed_2 += w * w;
    }
    const double sigma = flights_.radius(i) + flights_.radius(j);
    const double sigma_2 = sigma * sigma;
    const double parting = kMargin * kMargin * sigma_2 * speed_2;
    const double beyond = (1.0 - kRounding) * distance_2 - (1.0 + 3.0 * kMargin) * sigma_2;
    bool might = static_cast<bool>(static_cast<int>(approach * std::abs(approach) < parting) &
                                   static_cast<int>(beyond * speed_2 <= approach * approach));
    if constexpr (kGravity) might = might || flights_.acceleration(i) != flights_.acceleration(j);
    return might;
  }

  /// Whether the ball is so far from where places or clocks count from that rounding a clock may move it by
  /// more than a part of the margin of might_touch(). A clock c, however often it counted anew, has been
  /// rounded by less than ε |c|, as has the other ball's; a time of flight, not longer than |c|, is rounded
  /// by half of ε |c| and a place by half of ε (|x| + 2 |v| |c|), once before and once after. In all a ball
  /// of radius r is moved by less than 5 ε (|x| + |v| |c|), and here by less than kMargin r / 3.
  bool is_far_from_start(std::uint32_t ball) const {
    constexpr double kFarthest = kMargin / (16.0 * kEpsilon);
    const Motion<Dim> start = flights_.start(ball);
    const double distance = speed_bound(start.x) + speed_bound(start.v) * std::abs(flights_.clock(ball));
    return distance > kFarthest * flights_.radius(ball);
  }

  /// When the balls touch; the same whichever comes first.
  double to_touch(std::uint32_t i, std::uint32_t j) const {
    const double both = std::max(flights_.clock(i), flights_.clock(j));
    const auto [a, b] = motions(i, j);
    const Vec<Dim> d = b.x - a.x;
    const Vec<Dim> w = b.v - a.v;
    const double sigma = flights_.radius(i) + flights_.radius(j);
    const double rounding = velocity_rounding(speed_bound(a.v) + speed_bound(b.v) + field_speed_);
    if constexpr (kGravity) {
      const Vec<Dim> relative = b.a - a.a;
      if (!relative.isZero(0.0)) {
        const double horizon = time_out_of_reach(d.norm() + sigma, w.norm(), relative.norm());
        return both + time_to_touch<Dim>(d, w, relative, sigma, rounding, horizon);
      }
    }
    return both + time_to_touch<Dim>(d, w, sigma, rounding);
  }

  /// When the ball leaves a cell, after `time_s`.
  /// @param lower  the cell's lowest corner, m
  EventCrossing to_crossing(std::uint32_t ball, const Vec<Dim>& lower, double width_m, double time_s) const {
    EventCrossing first;
    const auto see = [&](double time, int axis, int direction) {
      if (time >= first.time) return;
      first = {time, static_cast<std::int8_t>(axis), static_cast<std::int8_t>(direction)};
    };
    for (int axis = 0; axis < Dim; ++axis) {
      const double upper = lower[axis] + width_m;
      if constexpr (kGravity) {
        see(to_side(ball, axis, -1, lower[axis], time_s), axis, -1);
        see(to_side(ball, axis, 1, upper, time_s), axis, 1);
      } else {
        // A straight flight passes the side that it heads for; the other it has passed before.
        const Motion<Dim> start = flights_.start(ball);
        const bool up = start.v[axis] > 0.0;
        const double wait = ((up ? upper : lower[axis]) - start.x[axis]) / start.v[axis];
        see(start.v[axis] == 0.0 ? kNever : flights_.clock(ball) + wait, axis, up ? 1 : -1);
      }
    }
    return first;
  }

 private:
  /// Of σ: a pair that misses by more touches in no computation of its flights; only one in so many balls
  /// that do not touch comes through.
  static constexpr double kMargin = 0x1p-30;

  double gap(std::uint32_t ball, const Motion<Dim>& motion, const EventWall<Dim>& wall) const {
    return wall.normal.dot(motion.x) - wall.offset - flights_.radius(ball);
  }

  /// When a falling ball passes a side of its cell on the way up (direction 1) or down (-1) the axis, after
  /// `time_s`.
  double to_side(std::uint32_t ball, int axis, int direction, double side, double time_s) const {
    const Motion<Dim> motion = flights_.motion(ball, time_s);
    const double gap = std::max(0.0, direction * (side - motion.x[axis]));
    return time_s +
           time_to_close(gap, -direction * motion.v[axis], -direction * motion.a[axis], 0.0, step_s_);
  }

  /// |v|, or up to √Dim more: for rounding, without a root.
  static double speed_bound(const Vec<Dim>& v) { return v.template lpNorm<1>(); }

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
  std::vector<EventWall<Dim>> walls_;
  double step_s_;             ///< a time that counts, for telling motion from rounding
  double field_speed_ = 0.0;  ///< m/s, what gravity gives in it
};

}  // namespace carom
