#pragma once

#include <string>

#include "comparison/results.h"

namespace carom {

/// Balls whose final state is listed for each run, unless all are asked for.
inline constexpr std::size_t kListedBalls = 1000;

/// The results as JSON, in the form that the README documents. Numbers read back to the same double; a metric
/// that does not apply, and an infinite mass, are null.
std::string results_json(const Results& results, bool all_balls);

}  // namespace carom
