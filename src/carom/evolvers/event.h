#pragma once

#include <memory>
#include <string>

#include "engine/engine.h"
#include "scenario/scenario.h"

namespace carom {

/// Of a position's rounding: the height of a rebound that is none. A position is the sum of a few terms, each
/// rounded.
inline constexpr double kRestEpsilons = 4.0;

/// Why the event-driven evolver does not take the scene, in a sentence; empty where it does.
std::string event_refusal(const Scenario& scene);

/// The event-driven evolver for a scene of this dimension. @pre event_refusal() is empty
template <int Dim>
std::unique_ptr<Simulation> make_event(const Scenario& scene);

}  // namespace carom
