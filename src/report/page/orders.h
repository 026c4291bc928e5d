#pragma once

#include <filesystem>

#include "report/page/html.h"

namespace carom::page {

/// By which power of the step the errors of Carom's evolvers fall, as tests/benchmarks/run has measured it.
/// Nothing where there is no such file. @throws InputError naming the file where it is not what that program
/// writes
void add_orders(Node parent, const std::filesystem::path& file);

}  // namespace carom::page
