#pragma once

#include <string>

#include "scenario/scenario.h"

namespace carom {

/// Why the event-driven evolver cannot begin the scene, in a sentence; empty where it can. Under gravity it
/// lays balls on one smooth wall each, so none may lie from the start on another ball, in a corner, or on a
/// wall with friction.
///
/// Decides the start alone. Elastic balls that fly come to lie on each other only if they meet with a
/// velocity of nothing but rounding, which no look at the scene foretells: the run then ends with the reason.
std::string lies_at_start(const Scenario& scene);

}  // namespace carom
