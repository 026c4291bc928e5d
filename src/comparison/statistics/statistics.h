#pragma once

#include "comparison/statistics/gas.h"
#include "trajectory/trajectory.h"

namespace carom {

/// Everything that is asked of a run of the gas. @pre the run ended well
RunStatistics measure_statistics(const Gas& gas, const Trajectory& trajectory);

}  // namespace carom
