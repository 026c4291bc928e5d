#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "carom/evolvers/event_cells.h"
#include "carom/evolvers/event_flights.h"
#include "carom/evolvers/event_queue.h"
#include "carom/evolvers/event_times.h"

namespace carom {

/// What comes next for each ball of the event-driven evolver, and for which of them first.
///
/// Every ball has one plan: the first impact that was seen when it was last looked at, with whom, and when it
/// leaves its cell. A plan is made when a ball's flight begins, with all that are near; it grows when a ball
/// crosses into new neighbours; and it is made again when its time comes and the other one's flight has
/// changed meanwhile. Of any two balls that are near, the one whose flight began last, or that came near, has
/// seen the other on its present flight: so the earliest impact of all is always the earliest of some plan.
/// Source of the scheme: B. D. Lubachevsky, "How to simulate billiards and similar systems", J. Comput. Phys.
/// 94, 255 (1991). Deviation: plans are not withdrawn when a partner is lost, but looked at when they come
/// up.
template <int Dim, bool kGravity>
class EventPlans {
 public:
  /// What comes next for a ball. A partner from the number of balls on is a wall.
  struct Plan {
    double impact_time = kNever;    ///< s
    double crossing_time = kNever;  ///< s, when the ball leaves its cell
    std::uint32_t partner = 0;
    std::uint32_t partner_flight = 0;  ///< of the partner, when the plan was made
    std::uint32_t flight = 0;          ///< counts the ball's own
    std::int16_t crossing_axis = 0;
    std::int16_t crossing_direction = 0;
  };

  /// The flights must outlive the plans.
  EventPlans(const Scenario& scene, const EventFlights<Dim, kGravity>& flights)
      : flights_(flights), times_(flights_, scene), plans_(scene.balls.size()), queue_(scene.balls.size()) {
    for (const Wall& wall : scene.walls) walls_.push_back({flattened<Dim>(wall.normal), wall.offset});
    if (scene.effects.collisions) {
      const World<Dim> world(scene.balls);
      cells_.emplace(world.position, world.radius);
    }
    for (std::uint32_t ball = 0; ball < balls(); ++ball) plan_flight(ball);
  }

  std::uint32_t balls() const { return static_cast<std::uint32_t>(plans_.size()); }
  bool is_wall(std::uint32_t partner) const { return partner >= balls(); }
  const EventWall<Dim>& wall(std::uint32_t index) const { return walls_[index]; }
  const Plan& of(std::uint32_t ball) const { return plans_[ball]; }

  /// The ball whose plan comes first; EventQueue::kNobody where nothing will ever happen.
  std::uint32_t first() { return queue_.first(); }
  /// When its plan comes, s.
  double time_s(std::uint32_t ball) const { return queue_.key(ball).time; }

  /// Whether the partner, a ball, is still on the flight that the plan was made with.
  bool holds(const Plan& plan) const { return plan.partner_flight == plans_[plan.partner].flight; }

  /// The ball's flight has ended: plans with it hold no longer.
  void end_flight(std::uint32_t ball) { ++plans_[ball].flight; }

  /// An immovable ball that stands still has none: whoever comes sees it.
  void plan_flight(std::uint32_t ball) {
    if (!flights_.movable(ball) && flights_.velocity(ball).isZero(0.0)) return;
    plan_impact(ball);
    plan_crossing(ball, flights_.clock(ball));
    enqueue(ball);
  }

  /// The ball flies on, but its partner is lost.
  void plan_again(std::uint32_t ball) {
    plan_impact(ball);
    enqueue(ball);
  }

  /// The ball goes over into the next cell, as planned, and sees who is near there.
  void cross(std::uint32_t ball) {
    const Plan& plan = plans_[ball];
    const int axis = plan.crossing_axis;
    const int direction = plan.crossing_direction;
    cells_->cross(ball, axis, direction);
    plan_crossing(ball, plan.crossing_time);
    cells_->find_ahead(ball, axis, direction, near_);
    consider_near(ball);
    enqueue(ball);
  }

  /// Counts all times from a moment `shift_s` later.
  void rebase(double shift_s) {
    for (Plan& plan : plans_) {
      plan.impact_time -= shift_s;
      plan.crossing_time -= shift_s;
    }
    queue_.shift(shift_s);
  }

  void add_settings(Settings& settings) const {
    if (!cells_) return;
    settings["cell_width_m"] = cells_->width_m();
    settings["balls_outside_cells"] = static_cast<double>(cells_->giants());
  }

 private:
  /// Among events of one time: by first ball, then balls before walls, then by second ball or wall.
  static std::uint64_t rank(std::uint32_t ball, std::uint32_t partner) {
    return (std::uint64_t{std::min(ball, partner)} << 32U) | std::max(ball, partner);
  }

  void plan_impact(std::uint32_t ball) {
    plans_[ball].impact_time = kNever;
    if (flights_.movable(ball)) {
      for (std::uint32_t wall = 0; wall < walls_.size(); ++wall) {
        if (wall != flights_.bearer(ball)) consider(ball, balls() + wall, times_.to_wall(ball, walls_[wall]));
      }
    }
    if (!cells_) return;
    cells_->find_near(ball, near_);
    consider_near(ball);
  }

  /// First all are sieved without a branch, as half of them part and most of the others miss, at random.
  void consider_near(std::uint32_t ball) {
    std::size_t left = 0;
    for (const std::uint32_t other : near_) {
      near_[left] = other;
      left += times_.might_touch(ball, other) ? 1 : 0;
    }
    for (std::size_t k = 0; k < left; ++k) {
      if (flights_.movable(ball) || flights_.movable(near_[k])) {
        consider(ball, near_[k], times_.to_touch(ball, near_[k]));
      }
    }
  }

  void consider(std::uint32_t ball, std::uint32_t partner, double time) {
    Plan& plan = plans_[ball];
    if (time > plan.impact_time || time == kNever) return;
    if (time == plan.impact_time && rank(ball, plan.partner) < rank(ball, partner)) return;
    plan.impact_time = time;
    plan.partner = partner;
    plan.partner_flight = is_wall(partner) ? 0 : plans_[partner].flight;
  }

  void plan_crossing(std::uint32_t ball, double time_s) {
    Plan& plan = plans_[ball];
    plan.crossing_time = kNever;
    if (!cells_ || !cells_->holds(ball)) return;
    for (int axis = 0; axis < Dim; ++axis) {
      for (const int direction : {-1, 1}) {
        const double side = cells_->lower_face(ball, axis) + (direction > 0 ? cells_->width_m() : 0.0);
        const double time = times_.to_side(ball, axis, direction, side, time_s);
        if (time >= plan.crossing_time) continue;
        plan.crossing_time = time;
        plan.crossing_axis = static_cast<std::int16_t>(axis);
        plan.crossing_direction = static_cast<std::int16_t>(direction);
      }
    }
  }

  void enqueue(std::uint32_t ball) {
    const Plan& plan = plans_[ball];
    if (plan.crossing_time < plan.impact_time) {
      queue_.set(ball, {plan.crossing_time, rank(ball, std::numeric_limits<std::uint32_t>::max())});
    } else {
      queue_.set(ball, {plan.impact_time, rank(ball, plan.partner)});
    }
  }

  const EventFlights<Dim, kGravity>& flights_;
  EventTimes<Dim, kGravity> times_;
  std::optional<EventCells<Dim>> cells_;  ///< none where balls pass through each other
  std::vector<EventWall<Dim>> walls_;
  std::vector<Plan> plans_;
  std::vector<std::uint32_t> near_;  ///< balls that are looked at
  EventQueue queue_;
};

}  // namespace carom
