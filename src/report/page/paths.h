#pragma once

#include "comparison/results.h"
#include "report/page/html.h"
#include "report/page/style.h"

namespace carom::page {

/// The paths of the balls, a picture for each engine that ended well, side by side and to the same scale.
void add_paths(Node parent, const SceneComparison& scene, const Legend& legend);

}  // namespace carom::page
