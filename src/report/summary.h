#pragma once

#include <string>

#include "comparison/results.h"

namespace carom {

/// The gates as Markdown that a code host shows: the verdict in a sentence, what is violated in full, what a
/// baseline had to say, how many runs of each engine ended how; every scene and engine in a box that is
/// closed.
std::string results_summary(const Results& results);

}  // namespace carom
