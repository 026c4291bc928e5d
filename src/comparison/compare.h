#pragma once

#include <vector>

#include "comparison/comparison.h"

namespace carom {

/// Holds the runs of a scene against the truth, against what physics conserves, against the scene's gates and
/// against each other.
///
/// What is expected of the conserved quantities, whatever the engine:
/// - Energy. With a truth, the truth's. Without one: E_0 where nothing dissipates; where something does,
/// energy
///   may fall but never rise, so only `energy_gain` is known (the highest rise above any earlier value).
/// - Momentum. P_0 + M g t, plus the impulses of walls and immovable balls that the engine itself booked, and
/// for
///   linear drag -c Σ Δx. For quadratic drag only a truth tells.
/// - Angular momentum about the centre of mass at t = 0. With a truth, the truth's. Without one: L_0, plus
/// the
///   booked angular impulses and gravity's moment M (½ v_cm t²) × g in flight; with walls under gravity only
///   the component along gravity is known without following the centre of mass, and drag leaves nothing
///   known.
///
/// @param under_test  names of the engines that [gate] is meant for
SceneComparison compare(ScenarioPtr scene, Truth truth, std::vector<Run> runs,
                        const std::vector<std::string>& under_test);

}  // namespace carom
