#pragma once

#include <memory>
#include <vector>

#include "carom/compose.h"
#include "engine/tuning.h"

namespace carom {

/// What can be tuned about a variant in a scene: how pairs are found, where the evolver takes a broad phase
/// and none is named; and the law for several contacts at once, where balls can touch so and nothing is
/// rough. The latter changes nothing in a scene in which impacts come one at a time.
std::vector<Tuning> variant_tunings(const Scenario& scene, const Variant& variant);

/// As compose(), with one setting at this value. @pre it is one of variant_tunings()
std::unique_ptr<Simulation> compose_tuned(const Scenario& scene, const Variant& variant, const Tuned& tuned);

}  // namespace carom
