#pragma once

#include <fmt/format.h>

#include <memory>
#include <string>

#include "carom/evolvers/parts.h"
#include "carom/evolvers/traits.h"
#include "carom/laws/frictionless.h"
#include "tests/benchmarks/gas.h"
#include "tests/benchmarks/live_bytes.h"

namespace carom::benchmark {

/// Compiled apart from the evolver, as it is in the engine.
std::unique_ptr<BroadPhase<3>> make_grid();

/// The bare gas in a program of its own: one evolver, one law and one broad phase, put together by hand, and
/// nothing that a scene could name beside them. Called with BALLS STEPS; prints a row of JSON.
template <template <class> class Evolver>
int run_bare(const std::string& evolver, char** argv) {
  const Scenario scene = bare_gas(std::stoul(argv[1]));
  const std::int64_t heap_before = live_bytes();
  const std::unique_ptr<Simulation> simulation =
      std::make_unique<Evolver<Traits<3, false, Frictionless, false>>>(
          scene, Parts<3>{make_grid(), nullptr, nullptr});
  fmt::print("{}\n", measure(*simulation, scene, "bare", evolver, std::stol(argv[2]), heap_before));
  return 0;
}

}  // namespace carom::benchmark
