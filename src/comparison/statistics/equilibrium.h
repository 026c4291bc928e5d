#pragma once

#include "comparison/statistics/gas.h"
#include "trajectory/trajectory.h"

namespace carom {

/// Measures what is asked of a gas in equilibrium after its warm-up: speeds, fourth moment, collision rate,
/// pressure on the walls, equipartition.
void measure_equilibrium(const Gas& gas, const Trajectory& trajectory, RunStatistics& statistics);

}  // namespace carom
