#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "carom/evolvers/event_times.h"

namespace carom {

/// An impact that a ball has ahead, as it was seen.
struct EventImpact {
  static constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

  double time = kNever;             ///< s
  std::uint32_t partner = kNobody;  ///< a ball, or from the number of balls on a wall
  std::uint32_t flight = 0;         ///< of the partner, a ball: which one it was on
};

/// The impact that comes next of all.
struct EventMeeting {
  double time;            ///< s
  std::uint32_t ball;     ///< who saw it
  std::uint32_t partner;  ///< as in EventImpact
};

/// Among impacts of one time: by first ball, then balls before walls, then by second ball or wall; all by
/// their numbers in the scene.
inline std::uint64_t event_rank(std::uint32_t ball, std::uint32_t partner) {
  return (std::uint64_t{std::min(ball, partner)} << 32U) | std::max(ball, partner);
}

/// What comes next for a ball: the first few impacts that it has seen on its flight, in order, and when it
/// leaves its cell. One cache line.
///
/// Why more than the first: the partner is hit by somebody else before in every second case, and what comes
/// next would have to be looked for among all that are near. Impacts that find no place are forgotten, but
/// not the time of the first of them: then the ball looks again. That time stands in the list as an impact
/// with the ball itself; it is kNever where the ball has to look again only when clocks are rounded.
struct EventPlan {
  std::array<EventImpact, 3> impacts;
  EventCrossing crossing;

  const EventImpact& first() const { return impacts.front(); }

  /// Whether there is more to see than the list holds for ball `self`.
  bool looks_again(std::uint32_t self) const {
    return std::any_of(impacts.begin(), impacts.end(),
                       [self](const EventImpact& impact) { return impact.partner == self; });
  }

  void drop_first() {
    std::move(impacts.begin() + 1, impacts.end(), impacts.begin());
    impacts.back() = {};
  }

  /// Puts an impact of ball `self` in its place of the list. `before` orders what is planned at one time.
  template <class Before>
  void insert(std::uint32_t self, EventImpact impact, const Before& before) {
    for (EventImpact& place : impacts) {
      if (impact.time == kNever && impact.partner != self) return;
      if (place.partner == self && place.time <= impact.time) return;  // the ball will look again before
      if (impact.time < place.time || (impact.time == place.time && before(impact, place))) {
        std::swap(impact, place);
      }
    }
    if (impact.time < kNever || impact.partner == self) impacts.back().partner = self;
  }
};

}  // namespace carom
