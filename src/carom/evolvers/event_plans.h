#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "carom/evolvers/event_cells.h"
#include "carom/evolvers/event_flights.h"
#include "carom/evolvers/event_plan.h"
#include "carom/evolvers/event_queue.h"
#include "carom/evolvers/event_times.h"
#include "carom/permute.h"

namespace carom {

/// What comes next for each ball of the event-driven evolver, and for which of them first.
///
/// Every ball has one plan. It is made when the ball's flight begins, with all that are near; it grows when
/// the ball crosses into new neighbours; and an impact is struck off when its time comes and the other one's
/// flight has changed meanwhile. Of any two balls that are near, the one whose flight began last, or that
/// came near, has seen the other on its present flight: so the earliest impact of all is always the earliest
/// of some plan. Source of the scheme: B. D. Lubachevsky, "How to simulate billiards and similar systems",
/// J. Comput. Phys. 94, 255 (1991). Deviation: plans are not withdrawn when a partner is lost, but looked at
/// when they come up; and they hold more than one impact, so that there is mostly a next one.
///
/// A wall is looked at from cell to cell, as far as the ball's next crossing: most cells are far from all.
///
/// EventSearch, beside it, is the slow twin.
template <int Dim, bool kGravity>
class EventPlans {
 public:
  using Flights = EventFlights<Dim, kGravity>;
  using Times = EventTimes<Dim, kGravity>;

  /// Flights and times must outlive the plans.
  EventPlans(const Scenario& scene, const Flights& flights, const Times& times)
      : flights_(flights),
        times_(times),
        plans_(scene.balls.size()),
        flight_(scene.balls.size()),
        queue_(new_queue()) {
    if (scene.effects.collisions) {
      const World<Dim> world(scene.balls);
      cells_.emplace(world.position, world.radius.each());
      near_.resize(scene.balls.size() + 1);
      left_.resize(scene.balls.size() + 1);
    }
    for (std::uint32_t ball = 0; ball < balls(); ++ball) plan_flight(ball);
  }
  /// The queue asks these plans for ranks, here where they are.
  EventPlans(const EventPlans&) = delete;
  EventPlans& operator=(const EventPlans&) = delete;

  /// The next impact up to `limit_s`, if there is one.
  std::optional<EventMeeting> next(double limit_s) {
    while (true) {
      const std::uint32_t ball = queue_.first();
      if (ball == EventQueue::kNobody || queue_.time(ball) > limit_s) return std::nullopt;
      EventPlan& plan = plans_[ball];
      const EventImpact& first = plan.first();
      if (plan.crossing.time < first.time) {
        cross(ball);
      } else if (first.partner == ball) {
        look_again(ball);
      } else if (holds(first)) {
        return EventMeeting{first.time, ball, first.partner};
      } else {
        strike_off(ball);
      }
    }
  }

  /// The ball's flight has ended: what others planned with it holds no longer.
  void end_flight(std::uint32_t ball) { ++flight_[ball]; }

  /// An immovable ball that stands still has no plan: whoever comes sees it.
  void plan_flight(std::uint32_t ball) {
    if (!flights_.movable(ball) && flights_.velocity(ball).isZero(0.0)) return;
    plan_crossing(ball, flights_.clock(ball));
    see_all<true>(ball);
    enqueue(ball);
  }

  /// Counts all times from a moment `shift_s` later. The flights have done so: what was seen is computed anew
  /// from them, so that it has the bits that it would have had, had it been seen now.
  void rebase(double shift_s) {
    for (std::uint32_t ball = 0; ball < balls(); ++ball) {
      plans_[ball].crossing.time -= shift_s;
      see_planned(ball);
    }
    enqueue_all();
  }

  /// An order of the balls in which those that are near in space follow each other; empty where there is
  /// none.
  std::vector<std::uint32_t> order() const { return cells_ ? cells_->order() : std::vector<std::uint32_t>(); }

  /// Numbers the balls anew: ball `order[k]` becomes ball k. @pre from order(); the flights have done so
  void renumber(const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> number(order.size());
    for (std::uint32_t k = 0; k < balls(); ++k) number[order[k]] = k;
    permute(plans_, order);
    permute(flight_, order);
    for (EventPlan& plan : plans_) {
      for (EventImpact& impact : plan.impacts) {
        if (!is_wall(impact.partner)) impact.partner = number[impact.partner];
      }
    }
    cells_->renumber(order);
    enqueue_all();
  }

  void add_settings(Settings& settings) const {
    if (!cells_) return;
    settings["cell_width_m"] = cells_->width_m();
    settings["balls_outside_cells"] = static_cast<double>(cells_->giants());
  }

 private:
  std::uint32_t balls() const { return static_cast<std::uint32_t>(plans_.size()); }
  bool is_wall(std::uint32_t partner) const { return partner >= balls(); }

  /// Whether the partner is still on the flight that it was seen on.
  bool holds(const EventImpact& impact) const {
    return is_wall(impact.partner) || impact.flight == flight_[impact.partner];
  }

  /// The ball goes over into the next cell, as planned, and sees who is near there.
  void cross(std::uint32_t ball) {
    const EventCrossing crossing = plans_[ball].crossing;
    cells_->cross(ball, crossing.axis, crossing.direction);
    plan_crossing(ball, crossing.time);
    plans_[ball].crossing.is_by_wall = times_.is_by_wall(ball, cells_->lower_corner(ball), cells_->width_m());
    see_walls(ball);
    see<false>(ball, [&](const auto& visit) {
      cells_->visit_ahead(ball, crossing.axis, crossing.direction, near_, visit);
    });
    enqueue(ball);
  }

  /// The partner has been hit by somebody else.
  void strike_off(std::uint32_t ball) {
    plans_[ball].drop_first();
    enqueue(ball);
  }

  void look_again(std::uint32_t ball) {
    see_all<false>(ball);
    enqueue(ball);
  }

  /// @tparam kBeganLast  see EventTimes::sieve()
  template <bool kBeganLast>
  void see_all(std::uint32_t ball) {
    plans_[ball].impacts = {};
    see_walls(ball);
    if (cells_) see<kBeganLast>(ball, [&](const auto& visit) { cells_->visit_near(ball, near_, visit); });
  }

  /// Computes anew what the ball has planned, after clocks have been rounded. Who did not touch it still does
  /// not, but for those within the sieve's margin: for them the ball looks again, as it does for impacts that
  /// it forgot, and under gravity always.
  void see_planned(std::uint32_t ball) {
    const auto planned = plans_[ball].impacts;
    if (kGravity ? planned.front().time < kNever
                 : plans_[ball].looks_again(ball) || times_.is_far_from_start(ball)) {
      see_all<false>(ball);
      return;
    }
    plans_[ball].impacts = {};
    for (const EventImpact& impact : planned) {
      if (impact.time < kNever && holds(impact)) plan_impact(ball, seen(ball, impact.partner));
    }
  }

  /// An impact of the ball as it is seen now.
  EventImpact seen(std::uint32_t ball, std::uint32_t partner) const {
    if (is_wall(partner)) return {times_.to_wall(ball, partner - balls()), partner};
    return {times_.to_touch(ball, partner), partner, flight_[partner]};
  }

  void see_walls(std::uint32_t ball) {
    if (!plans_[ball].crossing.is_by_wall || !flights_.movable(ball)) return;
    for (std::uint32_t wall = 0; wall < times_.walls(); ++wall) {
      if (wall == flights_.bearer(ball)) continue;
      if (!times_.might_reach(ball, wall, plans_[ball].crossing.time)) continue;
      plan_impact(ball, seen(ball, balls() + wall));
    }
  }

  /// First all are sieved without a branch, as half of them part and most of the others miss, at random.
  template <bool kBeganLast, class VisitOthers>
  void see(std::uint32_t ball, const VisitOthers& visit_others) {
    const auto might_touch = times_.template sieve<kBeganLast>(ball);
    std::uint32_t* const first = left_.data();
    std::uint32_t* end = first;
    visit_others([&](std::uint32_t other) {
      *end = other;
      end += might_touch(other) ? 1 : 0;
    });
    plan_impacts(ball, {first, end});
  }

  /// Those with the others that might be touched.
  void plan_impacts(std::uint32_t ball, std::span<const std::uint32_t> others) {
    for (const std::uint32_t other : others) {
      if (!flights_.movable(ball) && !flights_.movable(other)) continue;
      // Who came through the sieve and does not touch is within its margin of touching. As seen(), of balls
      // alone.
      const EventImpact impact = {times_.to_touch(ball, other), other, flight_[other]};
      const bool grazes = !kGravity && impact.time == kNever;
      plan_impact(ball, grazes ? EventImpact{kNever, ball} : impact);
    }
  }

  void plan_impact(std::uint32_t ball, const EventImpact& impact) {
    plans_[ball].insert(ball, impact, [&](const EventImpact& a, const EventImpact& b) {
      return name(a.partner) < name(b.partner);
    });
  }

  void plan_crossing(std::uint32_t ball, double time_s) {
    if (!cells_ || !cells_->holds(ball)) return;
    EventCrossing& crossing = plans_[ball].crossing;
    const bool is_by_wall = crossing.is_by_wall;
    crossing = times_.to_crossing(ball, cells_->lower_corner(ball), cells_->width_m(), time_s);
    crossing.is_by_wall = is_by_wall;
  }

  /// A ball's number in the scene; walls come after balls.
  std::uint32_t name(std::uint32_t partner) const {
    return is_wall(partner) ? partner : flights_.name(partner);
  }

  void enqueue(std::uint32_t ball) {
    queue_.set(ball, std::min(plans_[ball].crossing.time, plans_[ball].first().time));
  }

  void enqueue_all() {
    queue_ = new_queue();
    for (std::uint32_t ball = 0; ball < balls(); ++ball) enqueue(ball);
  }

  EventQueue new_queue() const {
    return {plans_.size(), [this](std::uint32_t ball) { return rank(ball); }};
  }

  /// Of the ball's next event. To cross and to look again changes nothing: at one time these come before all
  /// impacts.
  std::uint64_t rank(std::uint32_t ball) const {
    const EventPlan& plan = plans_[ball];
    const EventImpact& first = plan.first();
    const bool is_impact = first.time <= plan.crossing.time && first.partner != ball;
    return is_impact ? event_rank(flights_.name(ball), name(first.partner)) : 0;
  }

  const Flights& flights_;
  const Times& times_;
  std::optional<EventCells<Dim>> cells_;  ///< none where balls pass through each other
  std::vector<EventPlan> plans_;
  std::vector<std::uint32_t> flight_;  ///< counts the flights of each ball
  std::vector<std::uint32_t> near_;    ///< room for the balls that are looked at
  std::vector<std::uint32_t> left_;    ///< room for what the sieve leaves of them
  EventQueue queue_;
};

// Each is compiled in a file of its own: in larger ones the compiler leaves calls where it matters.
extern template class EventPlans<2, false>;
extern template class EventPlans<2, true>;
extern template class EventPlans<3, false>;
extern template class EventPlans<3, true>;

}  // namespace carom
