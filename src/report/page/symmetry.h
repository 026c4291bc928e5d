#pragma once

#include "comparison/results.h"
#include "report/page/html.h"
#include "report/page/style.h"

namespace carom::page {

/// Whether any scene was held against twins of it.
bool has_symmetries(const Results& results);

/// Which engine keeps which symmetry: the worst over all scenes that were asked, then each scene by itself.
/// Nothing where none was.
void add_symmetries(Node parent, const Results& results, const Legend& legend);

}  // namespace carom::page
