#pragma once

#include <nlohmann/json_fwd.hpp>

#include "report/page/html.h"

namespace carom::page {

/// By which power of the number of balls the work of each broad phase grows. @param broad_phases  what
/// tests/benchmarks/broad_phase_growth.cpp prints
void add_growth(Node parent, const nlohmann::json& broad_phases);

}  // namespace carom::page
