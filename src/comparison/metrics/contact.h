#pragma once

#include "comparison/metrics/yardstick.h"

namespace carom {

/// Measures `penetration`, and `escaped` where the scene has walls or slabs to be behind of.
void measure_contact(const Yardstick& yardstick, RunComparison& result);

}  // namespace carom
