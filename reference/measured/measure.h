#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "engine/truth_source.h"
#include "reference/measured/publication.h"

namespace carom::measured {

/// What an experiment takes from a run: the states at the end, and how many impacts there were at each frame,
/// the first one at t = 0.
struct Record {
  std::vector<BallState> states;
  std::vector<std::int64_t> impacts;
};

/// Whatever can run a scene: an engine, a truth source.
using Runner = std::function<Record(const Scenario& scene)>;

/// @pre engine outlives the runner
Runner runner_of(const Engine& engine, std::string profile = "faithful");
Runner runner_of(const TruthSource& source);

/// A measured number, and how sure the measurement itself is.
struct Measurement {
  double value = 0.0;
  double uncertainty = 0.0;  ///< 0: nothing but rounding
};

/// Runs what the value was measured in, and measures it anew.
Measurement measure(const Value& value, const Runner& run);

/// The scene of an impact: it touches halfway through the duration, with the partner's centre or the wall
/// below.
Scenario impact_scene(const Impact& impact);

/// Whether a measurement meets the published value: within both uncertainties together.
bool meets(const Value& value, const Measurement& measurement);

}  // namespace carom::measured
