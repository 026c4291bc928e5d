#pragma once

#include <filesystem>

#include "report/page/html.h"

namespace carom::page {

/// How fast Carom is beside its peers and how its cost grows, as tests/benchmarks/run has measured it, with
/// what was to be reached. Nothing where there is no such file.
/// @throws InputError naming the file where it is not what that program writes
void add_speed(Node parent, const std::filesystem::path& file);

}  // namespace carom::page
