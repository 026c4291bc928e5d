#pragma once

#include <string>

#include "comparison/results.h"

namespace carom {

/// The results as a table for a terminal of 80 columns, a block for each scene.
/// @param color  whether verdicts are coloured with ANSI codes; each has its word in any case
std::string results_table(const Results& results, bool color);

}  // namespace carom
