#pragma once

#include <string>

#include "report/page/html.h"
#include "report/page/style.h"
#include "study/study.h"

namespace carom::page {

/// The name of a scene's part of the study in this page's addresses.
std::string study_anchor(const StudyScene& scene);

/// One scene of a study: its diagram, who is ahead, the cheapest settings, orders and prices, and every run.
/// @param own  the family of the engine under test
void add_study_scene(Node parent, const StudyScene& scene, const std::string& own, const Legend& legend);

}  // namespace carom::page
