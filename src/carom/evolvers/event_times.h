#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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
    // Both are asked, as half of all balls head for the wall at random.
    const bool in_time = gap(ball, start, wall) <= 2.0 * closing * (until_s - clock + rounding_s);
    return static_cast<bool>(static_cast<int>(closing > 0.0) & static_cast<int>(in_time));
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

  /// Tells of other balls whether they might touch this one: false where they part, or pass by more than
  /// rounding: with d from i to j and w its rate of change, where b = d·w > m |w|, or by Lagrange's identity
  ///   |d × w|² = d² w² - b² > w² (σ + m)²,                                                (1)
  /// both of which one comparison tells: d² w² + b |b| > w² (σ² + 3 m σ).
  /// The margin m = kMargin σ is for what rebase() may do to d, see is_far_from_start(); what both sides of
  /// (1) and to_touch() are computed with has its own, a few epsilons of d² w². Says nothing of those that
  /// are accelerated differently.
  /// @tparam kBeganLast  the ball's flight began last of all: the others are looked at when it did
  template <bool kBeganLast>
  auto sieve(std::uint32_t i) const {
    return [this, i, start = flights_.start(i), clock = flights_.clock(i),
            radius = flights_.radius(i)](std::uint32_t j) {
      constexpr double kRounding = 64.0 * kEpsilon;
      const double both = kBeganLast ? clock : std::max(clock, flights_.clock(j));
      const Motion<Dim> from = kBeganLast ? start : flights_.motion(i, both);
      const Vec<Dim> d = flights_.place(j, both) - from.x;
      const Vec<Dim> w = flights_.velocity(j, both) - from.v;
      const double approach = d.dot(w);
      const double distance_2 = d.squaredNorm();
      const double speed_2 = w.squaredNorm();
      const double sigma = radius + flights_.radius(j);
      const double beyond = (1.0 - kRounding) * distance_2 - (1.0 + 3.0 * kMargin) * (sigma * sigma);
      bool might = beyond * speed_2 + approach * std::abs(approach) < 0.0;
      if constexpr (kGravity) might = might || start.a != flights_.acceleration(j);
      return might;
    };
  }

  /// Whether the ball is so far from where places or clocks count from that rounding a clock may move it by
  /// more than a part of the margin of sieve(). A clock c, however often it counted anew, has been
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
    const Vec<Dim> v_i = flights_.velocity(i, both);
    const Vec<Dim> v_j = flights_.velocity(j, both);
    const Vec<Dim> d = flights_.place(j, both) - flights_.place(i, both);
    const Vec<Dim> w = v_j - v_i;
    const double sigma = flights_.radius(i) + flights_.radius(j);
    const double rounding = velocity_rounding(speed_bound(v_i) + speed_bound(v_j) + field_speed_);
    if constexpr (kGravity) {
      const Vec<Dim> a = flights_.acceleration(j) - flights_.acceleration(i);
      if (!a.isZero(0.0)) {
        const double horizon = time_out_of_reach(d.norm() + sigma, w.norm(), a.norm());
        return both + time_to_touch<Dim>(d, w, a, sigma, rounding, horizon);
      }
    }
    return both + time_to_touch<Dim>(d, w, sigma, rounding);
  }

  /// When the ball leaves a cell, after `time_s`. By which side is a toss of a coin, so that no branch is
  /// taken on it.
  /// @param lower  the cell's lowest corner, m
  EventCrossing to_crossing(std::uint32_t ball, const Vec<Dim>& lower, double width_m, double time_s) const {
    std::array<double, Dim> times;
    std::array<bool, Dim> up;
    const Motion<Dim> start = flights_.start(ball);
    EventCrossing first;
    for (int axis = 0; axis < Dim; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      if constexpr (kGravity) {
        const double to_lower = to_side(ball, axis, -1, lower[axis], time_s);
        const double to_upper = to_side(ball, axis, 1, lower[axis] + width_m, time_s);
        times[k] = std::min(to_lower, to_upper);
        up[k] = to_upper < to_lower;
      } else {
        // A straight flight passes the side that it heads for; the other it has passed before.
        const double side = lower[axis] + 0.5 * width_m + std::copysign(0.5 * width_m, start.v[axis]);
        const double wait = (side - start.x[axis]) / start.v[axis];
        times[k] = start.v[axis] == 0.0 ? kNever : flights_.clock(ball) + wait;
        up[k] = start.v[axis] > 0.0;
      }
      first.time = std::min(first.time, times[k]);
    }
    // The axis is the number of those before it that take longer.
    std::size_t axis = 0;
    std::size_t longer = 1;
    for (std::size_t k = 0; k + 1 < Dim; ++k) {
      longer &= times[k] > first.time ? 1U : 0U;
      axis += longer;
    }
    first.axis = static_cast<std::int8_t>(axis);
    first.direction = up[axis] ? 1 : -1;
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
