#pragma once

#include <span>

#include "engine/engine.h"
#include "scenario/scenario.h"

namespace carom {

/// The deepest overlap among the balls, and of a ball with a wall, divided by the smaller radius; 0 where
/// nothing overlaps. Balls that may pass through each other are not held against each other. Sorts along x
/// and looks only at balls whose extents overlap there: independent of every engine's own search.
double deepest_overlap(const Scenario& scenario, std::span<const BallState> balls);

}  // namespace carom
