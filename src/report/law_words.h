#pragma once

#include <string>

#include "comparison/law_report.h"

namespace carom {

/// What a law keeps and what it breaks, for a terminal of 80 columns, beside the right law.
/// @pre both were examined with the same pairs
std::string law_table(const LawReport& report, const LawReport& right);

/// The same as JSON: {"law", "file", "expressions", "pairs", "seed", "not_finite", "rules": [{"rule",
/// "meaning", "measure", "holds", "broken_share", "median", "worst", "worst_pair", "right_worst"}]}. What is
/// infinite is null.
std::string law_json(const LawReport& report, const LawReport& right);

/// The names and functions that an expression may use, with their meaning, for a terminal.
std::string law_vocabulary();

}  // namespace carom
