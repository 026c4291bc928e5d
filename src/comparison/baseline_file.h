#pragma once

#include <string>
#include <string_view>

#include "comparison/baseline.h"

namespace carom {

/// A baseline as JSON: scenes and engines in the order of their names and one metric to a line, so that a
/// change of a value is a changed line in a repository. Numbers read back to the same double.
std::string baseline_json(const Baseline& baseline);

/// Reads what baseline_json() wrote. @param file  for messages
/// @throws InputError "file:line: key: …" where it is something else
Baseline parse_baseline(std::string_view text, const std::string& file);

}  // namespace carom
