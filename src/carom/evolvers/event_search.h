#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "carom/evolvers/event_flights.h"
#include "carom/evolvers/event_plan.h"
#include "carom/evolvers/event_times.h"

namespace carom {

/// The slow twin of EventPlans, obviously right: it plans nothing, and for each impact looks at every ball
/// with every wall and every other ball. Both give the same impacts at the same times, bit for bit.
template <int Dim, bool kGravity>
class EventSearch {
 public:
  using Flights = EventFlights<Dim, kGravity>;
  using Times = EventTimes<Dim, kGravity>;

  EventSearch(const Scenario& scene, const Flights& flights, const Times& times)
      : flights_(flights), times_(times), collisions_(scene.effects.collisions) {}

  /// The next impact up to `limit_s`, if there is one.
  std::optional<EventMeeting> next(double limit_s) const {
    std::optional<EventMeeting> first;
    const auto see = [&](const EventMeeting& meeting) {
      if (meeting.time > limit_s || meeting.time == kNever) return;
      if (!first || comes_before(meeting, *first)) first = meeting;
    };
    for (std::uint32_t ball = 0; ball < balls(); ++ball) {
      for (std::uint32_t wall = 0; wall < times_.walls(); ++wall) {
        if (!flights_.movable(ball) || wall == flights_.bearer(ball)) continue;
        see({times_.to_wall(ball, wall), ball, balls() + wall});
      }
      for (std::uint32_t other = 0; collisions_ && other < ball; ++other) {
        if (!flights_.movable(ball) && !flights_.movable(other)) continue;
        see({times_.to_touch(ball, other), ball, other});
      }
    }
    return first;
  }

  // What EventPlans has to do to stay right.
  void end_flight(std::uint32_t /*ball*/) {}
  void plan_flight(std::uint32_t /*ball*/) {}
  void rebase(double /*shift_s*/) {}
  std::vector<std::uint32_t> order() const { return {}; }
  void renumber(const std::vector<std::uint32_t>& /*order*/) {}
  void add_settings(Settings& /*settings*/) const {}

 private:
  std::uint32_t balls() const { return static_cast<std::uint32_t>(flights_.size()); }

  bool comes_before(const EventMeeting& a, const EventMeeting& b) const {
    return a.time < b.time || (a.time == b.time && rank(a) < rank(b));
  }
  std::uint64_t rank(const EventMeeting& meeting) const {
    const bool with_wall = meeting.partner >= balls();
    return event_rank(flights_.name(meeting.ball),
                      with_wall ? meeting.partner : flights_.name(meeting.partner));
  }

  const Flights& flights_;
  const Times& times_;
  bool collisions_;
};

}  // namespace carom
