#pragma once

#include <memory>

#include "carom/evolvers/parts.h"
#include "carom/laws/law_formula.h"
#include "engine/engine.h"

namespace carom {

/// The evolver `toi` under a law from a file (laws/written_law.h).
template <int Dim>
std::unique_ptr<Simulation> make_toi_written(const Scenario& scene, Parts<Dim> parts,
                                             const std::shared_ptr<LawFormula>& law);

}  // namespace carom
