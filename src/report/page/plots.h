#pragma once

#include "comparison/results.h"
#include "report/page/html.h"
#include "report/page/style.h"

namespace carom::page {

/// Energy, momentum and position error over time, one line for each run that ended well. A plot in which
/// nothing is known is left out.
void add_plots(Node parent, const SceneComparison& scene, const Legend& legend);

}  // namespace carom::page
