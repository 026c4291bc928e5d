#pragma once

#include <vector>

#include "comparison/comparison.h"

namespace carom {

/// Holds the runs of a scene against the truth, against what physics conserves, against the scene's gates and
/// against each other. What is expected of each quantity, whatever the engine, stands with its metric in
/// metrics/.
///
/// @param under_test  names of the engines that [gate] is meant for
/// @param symmetries  what check_symmetries() found, one for each run; none given: nothing was checked
SceneComparison compare(ScenarioPtr scene, Truth truth, std::vector<Run> runs,
                        const std::vector<std::string>& under_test,
                        std::vector<RunSymmetries> symmetries = {});

}  // namespace carom
