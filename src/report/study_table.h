#pragma once

#include <string>

#include "study/study.h"

namespace carom {

/// A study for a terminal of 80 columns: for each scene how every engine converges, what a digit costs and
/// what is the cheapest setting for a tolerance; the overview; where a peer is ahead of the engine under
/// test; how the cost grows with the number of balls.
std::string study_table(const Study& study);

}  // namespace carom
