#pragma once

#include "comparison/comparison.h"
#include "report/page/html.h"

namespace carom::page {

/// The scene's runs as data for the viewer, which puts a button beside them (reports/web/viewer/report.js).
/// Nothing where no run ended well.
void add_player(Node parent, const SceneComparison& scene);

}  // namespace carom::page
