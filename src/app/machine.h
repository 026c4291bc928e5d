#pragma once

#include "comparison/results.h"

namespace carom {

/// The machine that this program runs on, and how it was built.
Machine this_machine();

}  // namespace carom
