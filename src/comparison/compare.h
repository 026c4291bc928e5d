#pragma once

#include <vector>

#include "comparison/comparison.h"

namespace carom {

/// Holds the runs of a scene against the truth, against what physics conserves, against the scene's gates and
/// against each other. What is expected of each quantity, whatever the engine, stands with its metric in
/// metrics/.
///
/// @param under_test  names of the engines that [gate] is meant for
SceneComparison compare(ScenarioPtr scene, Truth truth, std::vector<Run> runs,
                        const std::vector<std::string>& under_test);

}  // namespace carom
