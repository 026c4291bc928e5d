#pragma once

#include <string>

#include "study/study.h"

namespace carom {

/// Every measured point of a study as CSV, a row each, with a heading: SI units, times in seconds of CPU.
/// Numbers have the digits that read back to the same double; what there is not is empty. How the cost grows
/// with the number of balls is in the JSON alone.
std::string study_csv(const Study& study);

}  // namespace carom
