#pragma once

#include "comparison/comparison.h"

namespace carom {

/// Holds a measured run against what the scene's [gate] says of it, and over it [gate.<engine>]; sets its
/// gates and its verdict.
void hold_gates(const Gate& gate, RunComparison& result);

}  // namespace carom
