#pragma once

#include "comparison/results.h"
#include "report/page/html.h"
#include "report/page/style.h"

namespace carom::page {

/// Everything about one scene: what it is, how each engine did, the paths, the plots and the tables.
void add_scene(Node parent, const SceneComparison& scene, const Legend& legend, bool plays);

}  // namespace carom::page
