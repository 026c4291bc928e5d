#pragma once

#include <vector>

#include "report/page/html.h"
#include "report/page/style.h"
#include "study/study.h"

namespace carom::page {

/// The work–precision diagram of a scene: error over CPU time, both as powers of ten. A line for each engine
/// as its profile has it, from coarse steps to fine ones; every run a marker that says its setting; the
/// Pareto front; and the floor below which the truth tells nothing.
/// @pre a run of the scene was timed and its error is known
void add_work_precision(Node parent, const StudyScene& scene, const Legend& legend);

/// Time per ball and step over the number of balls, of gases of one dimension.
void add_growth_plot(Node parent, const std::vector<StudyGrowth>& growths, const Legend& legend);

}  // namespace carom::page
