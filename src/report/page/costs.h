#pragma once

#include <filesystem>

#include "report/page/html.h"

namespace carom::page {

/// What each effect and each broad phase costs, as tests/benchmarks/run has counted it. Nothing where there
/// is no such file. @throws InputError naming the file where it is not what that program writes
void add_costs(Node parent, const std::filesystem::path& file);

}  // namespace carom::page
