#pragma once

#include "comparison/comparison.h"

namespace carom {

/// Holds a measured run against what the scene's [gate] says of it, and over it [gate.<engine>]; sets its
/// gates and its verdict.
void hold_gates(const Gate& gate, RunComparison& result);

/// What a run comes to by how it ended and by its gates: shown where it ended well and has none.
Verdict verdict_of(const RunComparison& result);

}  // namespace carom
