#pragma once

#include <vector>

#include "comparison/law_report.h"
#include "report/page/html.h"

namespace carom::page {

/// The chapter on laws of impact: which keeps what, over random pairs. Nothing where none were examined.
/// @param reports  the right law first
void add_laws(Node parent, const std::vector<LawReport>& reports);

}  // namespace carom::page
