#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenario/scenario.h"
#include "trajectory/trajectory.h"

namespace carom {

/// An impact as the recorded frames tell it.
struct SeenImpact {
  static constexpr std::int32_t kWall = -1;     ///< a wall, a slab or a barrier
  static constexpr std::int32_t kUnknown = -2;  ///< something that the frames do not tell

  double time_s = 0.0;
  std::int32_t ball = 0;
  std::int32_t other = kWall;  ///< a ball's index, kWall or kUnknown
};

/// The impacts of a run, by time: whatever changed a velocity between two frames by more than flight
/// explains,
///   |v₁ - v₀ - (a₀ + a₁) h/2| > |a₁ - a₀| h + 10⁻⁵ v_max, (1)
/// a the acceleration by gravity, drag and the Magnus force at either frame, h the time between them. The
/// first term on the right bounds what the trapezoidal rule leaves where a changes steadily; the second is a
/// hundred roundings of an engine in single precision.
///
/// Whom a ball met is told by where both would have been without the impact: two balls whose velocities
/// changed and whose flights, taken on from the frame before or back from the frame after, touch. A ball that
/// stays on another, or on a wall, from frame to frame has one impact, its first. Impacts that come in one
/// interval at the same contact are one.
///
/// @param most  how many to look for
struct SeenImpacts {
  std::vector<SeenImpact> impacts;
  bool more = false;  ///< whether the search ended before the run did
};
SeenImpacts find_impacts(const Scenario& scenario, const Trajectory& trajectory, std::size_t most);

}  // namespace carom
