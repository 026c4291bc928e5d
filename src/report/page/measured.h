#pragma once

#include <filesystem>

#include "report/page/html.h"

namespace carom::page {

/// Carom against published measurements, as tests/benchmarks/run has measured it. Nothing where there is no
/// such file. @throws InputError naming the file where it is not what that program writes
void add_measured(Node parent, const std::filesystem::path& file);

}  // namespace carom::page
