#pragma once

#include <vector>

#include "comparison/symmetry.h"
#include "scenario/scenario.h"
#include "trajectory/record.h"

namespace carom {

/// Runs every twin that the scene asks for (Scenario::symmetries, make_twin()) in every engine whose run of
/// the scene itself ended well, each in a process of its own, and holds it against that run, frame by frame.
///
/// "To rounding" is judged against a floor, measured in each engine by one more twin: it is disturbed by what
/// rounding can add up to. Each of n steps and impacts rounds a coordinate by at most ½ε of its size, in the
/// scene's run and in the twin's, all one way in the worst case:
///   δx = n ε X,  δv = n ε V,
/// with ε of the engine's precision, X and V the largest distance from the origin and the largest speed in
/// the run, or what a boost makes of them. How far the disturbed twin comes from the scene is the floor: so
/// it holds what the scene itself makes of an error, which grows at every impact.
///
/// @pre runs[i] is that of engines[i]. @return one for each run; empty where its run did not end well, or the
/// scene asks for nothing
std::vector<RunSymmetries> check_symmetries(const Scenario& scene, const std::vector<Run>& runs,
                                            const std::vector<EngineChoice>& engines,
                                            const ProcessLimits& limits, int parallel);

}  // namespace carom
