#pragma once

#include "comparison/results.h"
#include "report/page/html.h"
#include "report/page/style.h"

namespace carom::page {

/// Whether a scene of the group hard/ is among the results.
bool has_hard_cases(const Results& results);

/// The chapter "Hard cases": which engine survives which of them. Nothing where there are none.
void add_survival(Node parent, const Results& results, const Legend& legend);

}  // namespace carom::page
