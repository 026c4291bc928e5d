#pragma once

#include <string>

#include "study/study.h"

namespace carom {

/// Every measured point of a study as CSV, a row each, with a heading: SI units, times in seconds of CPU.
/// Numbers have the digits that read back to the same double; what there is not is empty. Last
/// come the gases of ever more balls, which have times and no errors.
std::string study_csv(const Study& study);

}  // namespace carom
