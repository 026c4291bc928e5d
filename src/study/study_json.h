#pragma once

#include <string>
#include <string_view>

#include "study/study.h"

namespace carom {

/// A study, whole or stopped, as JSON: the results for people who plot for themselves, and what a study that
/// was stopped is resumed from. Numbers read back to the same double.
std::string study_json(const Study& study);

/// @param file  named in errors
/// @throws InputError where the text is not that of a study, with the place
Study parse_study(std::string_view text, const std::string& file);

}  // namespace carom
