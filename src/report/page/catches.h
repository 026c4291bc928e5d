#pragma once

#include <filesystem>

#include "report/page/html.h"

namespace carom::page {

/// Which gate catches which of the engines that are broken on purpose, as tests/benchmarks/run has found it
/// out. Nothing where there is no such file. @throws InputError naming the file where it is not what that
/// program writes
void add_catches(Node parent, const std::filesystem::path& file);

}  // namespace carom::page
