#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "engine/engine.h"
#include "scenario/scenario.h"

namespace carom::benchmark {

// The gas in which costs are counted. Every benchmark sets up the same balls, so that counts can be compared.

/// A gas with everything that a scene can name: every effect but linear drag, which stands in the place of
/// the quadratic one, friction, a box, a slab and a quantum barrier.
Scenario full_gas(std::size_t balls);

/// The same balls, at the same places and velocities, that collide and do nothing else.
Scenario bare_gas(std::size_t balls);

/// Advances the simulation by `steps` and returns what that took as a row of JSON. callgrind counts the
/// instructions of these steps and nothing else (see count_here()).
/// @param heap_before  live_bytes() before the simulation was made
std::string measure(Simulation& simulation, const Scenario& scene, const std::string& name,
                    const std::string& evolver, std::int64_t steps, std::int64_t heap_before);

}  // namespace carom::benchmark
