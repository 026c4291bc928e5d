#pragma once

#include "comparison/results.h"
#include "report/page/html.h"
#include "report/page/style.h"

namespace carom::page {

/// The top of the page: what it is, whether the gates hold, and the matrix of scenes and engines.
void add_overview(Node parent, const Results& results, const Legend& legend);

/// A verdict as shape and word.
void add_verdict(Node parent, Verdict verdict);

}  // namespace carom::page
