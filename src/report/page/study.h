#pragma once

#include <string>

#include "report/page/html.h"
#include "study/study.h"

namespace carom::page {

/// What accuracy costs in time: all scenes at a glance, a diagram and tables for each, how the cost grows
/// with the number of balls, and how all of it was measured.
/// @param how_to_read  Markdown, from the page's web folder
void add_study(Node parent, const Study& study, const std::string& how_to_read);

}  // namespace carom::page
