#pragma once

#include <vector>

#include "comparison/metrics/yardstick.h"

namespace carom {

/// Measures `momentum` of a run, and its series over the frames.
///
/// Expected is P_0 + M g t, plus the impulses of walls and immovable balls that the engine itself booked, and
/// for linear drag -c Σ Δx. For quadratic drag and the Magnus force only a truth tells.
///
/// @param conserved  the run's, in every frame
void measure_momentum(const Yardstick& yardstick, const std::vector<Conserved>& conserved,
                      RunComparison& result);

/// Measures `angular_momentum` about the centre of mass at t = 0.
///
/// Expected is the truth's where it is known. Elsewhere L_0, plus the booked angular impulses and gravity's
/// moment M (½ v_cm t²) × g in flight; with walls under gravity only the component along gravity is known
/// without following the centre of mass, and drag leaves nothing known.
///
/// @param conserved  the run's, in every frame
void measure_angular_momentum(const Yardstick& yardstick, const std::vector<Conserved>& conserved,
                              RunComparison& result);

}  // namespace carom
