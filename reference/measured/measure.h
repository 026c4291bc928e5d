#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "engine/engine.h"
#include "engine/truth_source.h"
#include "reference/measured/publication.h"

namespace carom::measured {

/// Sees the balls and the engine's account at t = 0 and at the end of each frame.
using Watch = std::function<void(std::span<const BallState> states, const Tally& tally)>;

/// Whatever can run a scene: an engine, a truth source.
using Runner = std::function<void(const Scenario& scene, const Watch& watch)>;

/// @pre engine outlives the runner
Runner runner_of(const Engine& engine, std::string profile = "faithful");
Runner runner_of(const TruthSource& source);

/// A measured number, and how sure the measurement itself is.
struct Measurement {
  double value = 0.0;
  double uncertainty = 0.0;  ///< 0: nothing but rounding
};

/// Measures values anew, each in what it was measured in; a fluid that several of them ask for runs once.
class Laboratory {
 public:
  explicit Laboratory(Runner run);
  ~Laboratory();
  Laboratory(const Laboratory&) = delete;
  Laboratory& operator=(const Laboratory&) = delete;

  Measurement measure(const Value& value);

 private:
  struct Fluids;
  Runner run_;
  std::unique_ptr<Fluids> fluids_;
};

/// One value alone.
Measurement measure(const Value& value, const Runner& run);

/// The scene of an impact: it touches halfway through the duration, with the partner's centre or the wall
/// below.
Scenario impact_scene(const Impact& impact);

/// Whether a measurement meets the published value: within both uncertainties together.
bool meets(const Value& value, const Measurement& measurement);

}  // namespace carom::measured
