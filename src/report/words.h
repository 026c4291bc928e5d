#pragma once

#include <string>
#include <vector>

#include "comparison/results.h"

namespace carom {

/// A number for people: three significant digits, "n/a" where there is none.
std::string short_number(std::optional<double> value);

/// What makes the check fail, one line each: scene, engine, metric, value and limit, or the reason of a run
/// that ended badly. Empty where everything holds.
std::vector<std::string> violations(const Results& results);

/// The violations of one run; empty where it violates nothing.
std::vector<std::string> violations(const SceneComparison& scene, const RunComparison& run);

/// One sentence on what was checked, for results in which nothing is violated.
std::string all_is_well(const Results& results);

}  // namespace carom
