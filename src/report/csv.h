#pragma once

#include <string>

#include "comparison/comparison.h"

namespace carom {

/// The trajectory of one run as CSV, a row for each frame and ball, with a header; SI units.
std::string trajectory_csv(const Trajectory& trajectory);

}  // namespace carom
