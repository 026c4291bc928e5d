#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "scenario/scenario.h"
#include "tests/benchmarks/speed/samples.h"

namespace carom::benchmark {

/// What a cost is divided by.
enum class Unit { ball_step, ball_impact };

/// An engine with a scene in it, to be timed again and again as it goes on.
struct Runner {
  std::string engine;  ///< as on the command line: "carom:step", "bullet-f64"
  const Scenario* scene = nullptr;
  Unit unit = Unit::ball_step;
  double longer = 1.0;      ///< it is timed so many times as long as others at least
  std::size_t threads = 1;  ///< that share the balls, in the hand-written engine
  bool real_time = false;   ///< is taken, in place of CPU time
};

/// Time, ns, of one ball in one step of 1/240 s, or of one impact between two balls.
struct Cost {
  std::string engine;
  std::size_t balls = 0;
  Samples ns;
};

/// Times runners against each other, one after the other in each of several rounds, so that whatever else the
/// machine is doing meets all of them alike. Nothing is recorded: only Simulation::advance() is timed, by
/// Google Benchmark.
/// @param shortest_s  that a runner is timed for in a round
/// @return costs in the order of the runners
/// @throws MachineError where an engine is not built
std::vector<Cost> race(const std::vector<Runner>& runners, int rounds, double shortest_s);

}  // namespace carom::benchmark
