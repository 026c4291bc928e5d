#pragma once

#include <optional>

#include "comparison/examine_textbook.h"
#include "report/page/html.h"

namespace carom::page {

/// The chapter on the course program's formulas: which are right, and what the others do. Nothing where they
/// were not examined.
void add_textbook(Node parent, const std::optional<TextbookFindings>& findings);

}  // namespace carom::page
