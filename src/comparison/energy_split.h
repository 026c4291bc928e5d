#pragma once

#include <optional>

#include "scenario/scenario.h"
#include "trajectory/trajectory.h"

namespace carom {

/// Where a run gained (above 0) or lost (below) its energy, J. All six add up to E(t) - E(0) to round-off,
/// because what the engine's account of pushes leaves is flight:
///   flight = E(t) - E(0) - (ball impacts + wall impacts + friction + position correction + events).  (1)
/// So flight is drag, the errors of how an engine integrates gravity and drag, and what it does to velocities
/// without a push (sleep, clamps, stops by continuous collision).
struct EnergySplit {
  double flight_J = 0.0;
  double ball_impacts_J = 0.0;
  double wall_impacts_J = 0.0;
  double friction_J = 0.0;
  double correction_J = 0.0;
  double events_J = 0.0;  ///< what events brought or took
};

/// The split over the whole run. Nothing where the run did not end well, or its engine keeps no account.
std::optional<EnergySplit> split_energy(const Scenario& scene, const Run& run);

}  // namespace carom
