#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "engine/tuning.h"
#include "trajectory/intervals.h"
#include "trajectory/isolate.h"
#include "trajectory/trajectory.h"

namespace carom {

/// An engine that can be asked for by name. It is opened only inside the process that runs it, so that a
/// module which cannot even be loaded is a row of the result.
struct EngineSource {
  std::string name;
  std::function<const Engine&()> open;
};

/// An engine in one of its profiles.
struct EngineChoice {
  EngineSource source;
  std::string profile = "faithful";
  /// Settings that are as the engine's other profile has them; names from EngineInfo::switches.
  std::vector<std::string> switched = {};
  std::optional<Tuned> tuned = {};  ///< a setting that is not as the profile has it
};

/// Sets the scene up as the choice says. @pre its engine is this one and can run the scene
std::unique_ptr<Simulation> create_simulation(const Engine& engine, const Scenario& scenario,
                                              const EngineChoice& choice);

/// Runs the scene in every engine, each in a process of its own, and hands back one Run for each, in order.
std::vector<Run> run_engines(const Scenario& scenario, const std::vector<EngineChoice>& engines,
                             const ProcessLimits& limits, int parallel,
                             const std::function<void(std::size_t)>& done = {});

/// What an engine says of itself, asked in a process of its own; where that fails, `about` is empty and
/// `version` gives the reason.
std::vector<EngineInfo> describe_engines(const std::vector<EngineSource>& engines,
                                         const ProcessLimits& limits, int parallel);

}  // namespace carom
