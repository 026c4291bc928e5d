#pragma once

#include <vector>

#include "comparison/metrics/yardstick.h"

namespace carom {

/// Measures `energy`, `energy_gain` and `energy_loss` of a run, and its series over the frames.
///
/// Expected is the truth's energy where it is known. Elsewhere E_0, or where something dissipates any value
/// that never rises: then only the gain is known, the highest rise above any earlier value. What events
/// brought or took is expected too, and left out of the series.
///
/// @param conserved  the run's, in every frame
void measure_energy(const Yardstick& yardstick, const std::vector<Conserved>& conserved,
                    RunComparison& result);

}  // namespace carom
