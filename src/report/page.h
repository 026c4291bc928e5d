#pragma once

#include <filesystem>
#include <string>

#include "comparison/results.h"
#include "study/study.h"

namespace carom {

/// The report as one HTML file that needs nothing else: styles, script and plots are inside.
/// @param web     the folder with the page's style sheet and script (reports/web)
/// @param viewer  the folder with the bundled viewer (report.js, report.css); where it is not there, scenes
/// are not played
/// @param study   shown as a chapter, where there is one
/// @throws InputError where the web sources cannot be read.
std::string render_page(const Results& results, const std::filesystem::path& web,
                        const std::filesystem::path& viewer = {}, const Study* study = nullptr);

/// A study alone, as such a file.
std::string render_study_page(const Study& study, const std::filesystem::path& web);

}  // namespace carom
