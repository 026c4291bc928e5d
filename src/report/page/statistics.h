#pragma once

#include "comparison/comparison.h"
#include "report/page/html.h"
#include "report/page/style.h"

namespace carom::page {

/// What a scene of many balls says beyond the horizon of its trajectories: each engine's statistics against
/// what theory expects, the speeds drawn, and when every two engines part. Nothing for a scene of few balls.
void add_statistics(Node parent, const SceneComparison& scene, const Legend& legend);

}  // namespace carom::page
