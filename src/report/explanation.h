#pragma once

#include <string>

#include "comparison/explain.h"

namespace carom {

/// An explanation as text for a terminal of 80 columns: what comes first, a table of all settings, and what
/// is left.
std::string explanation_table(const ExplainedScene& explained);

/// The same as JSON. Divergences and shares are null where a run failed or there is nothing to share.
std::string explanation_json(const ExplainedScene& explained, const std::string& carom_version);

}  // namespace carom
