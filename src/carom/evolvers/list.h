#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "carom/evolvers/parts.h"
#include "engine/engine.h"

namespace carom {

/// A way of carrying a scene through time.
struct Evolver {
  std::string_view name;
  std::string_view about;  ///< one sentence
  bool takes_broad_phase;  ///< false where it finds pairs in a way of its own
  /// Why it does not take the scene, a sentence; empty where it does.
  std::string (*refuses)(const Scenario& scene);
  /// Whether it is a choice for the scene where the scene leaves it open.
  bool (*suits)(const Scenario& scene);
  std::unique_ptr<Simulation> (*make_2d)(const Scenario& scene, Parts<2> parts);
  std::unique_ptr<Simulation> (*make_3d)(const Scenario& scene, Parts<3> parts);
  bool takes_steps = true;  ///< false where the step changes nothing
  /// p where its error is claimed to fall like stepᵖ in the scene; nothing, or no function: exact but for
  /// rounding.
  std::optional<int> (*claimed_order)(const Scenario& scene) = nullptr;
};

/// Every evolver, the most accurate first: where the choice is left open, the first that suits the scene
/// runs. A new evolver is a header beside this one and a row here.
const std::vector<Evolver>& all_evolvers();

}  // namespace carom
