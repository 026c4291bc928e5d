#pragma once

#include <string>

#include "comparison/results.h"

namespace carom {

/// The gates as Markdown that a code host shows: the verdict in a sentence, what is violated, and a table of
/// scenes and engines.
std::string results_summary(const Results& results);

}  // namespace carom
