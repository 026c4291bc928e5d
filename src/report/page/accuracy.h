#pragma once

#include "comparison/results.h"
#include "report/page/html.h"
#include "report/page/style.h"

namespace carom::page {

/// Whether any run can be held against a truth.
bool has_judgements(const Results& results);

/// Which engine is exact, which within tolerance, which parted from the truth by chaos alone and which for
/// another reason, scene by scene; and what each truth took and how long it holds.
void add_accuracy(Node parent, const Results& results, const Legend& legend);

}  // namespace carom::page
