#pragma once

#include <vector>

#include "comparison/coefficients.h"
#include "trajectory/record.h"

namespace carom {

/// Measures which restitution and friction every engine delivers: all probes (comparison/coefficients.h) in
/// all of them, each run in a process of its own.
std::vector<CoefficientPanel> measure_coefficients(const std::vector<EngineChoice>& engines,
                                                   const ProcessLimits& limits, int parallel);

}  // namespace carom
