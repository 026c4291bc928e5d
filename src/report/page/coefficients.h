#pragma once

#include <vector>

#include "comparison/coefficients.h"
#include "report/page/html.h"
#include "report/page/style.h"

namespace carom::page {

/// The chapter on the restitution and the friction that every engine really delivers; nothing where they were
/// not measured.
void add_coefficients(Node parent, const std::vector<CoefficientPanel>& panels, const Legend& legend);

}  // namespace carom::page
