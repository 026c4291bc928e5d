#pragma once

#include "report/page/html.h"
#include "report/page/style.h"

namespace carom::page {

/// Where each engine gained or lost energy in this scene, as a table with a bar for each;
/// nothing where no engine lost or gained any that matters.
void add_energy_causes(Node parent, const SceneComparison& scene, const Legend& legend);

}  // namespace carom::page
