#pragma once

#include <memory>

#include "carom/evolvers/toi.h"
#include "carom/evolvers/toi_written.h"
#include "carom/evolvers/traits.h"
#include "carom/laws/written_law.h"

namespace carom {

template <int Dim>
std::unique_ptr<Simulation> make_toi_written(const Scenario& scene, Parts<Dim> parts,
                                             const std::shared_ptr<LawFormula>& law) {
  const bool rough = has_friction(scene) || law->file().has_tangential();
  parts.law = law;
  const bool accelerates = parts.flight != nullptr;
  if (rough && accelerates)
    return detail::with_law<Dim, true, WrittenLaw<true>, ToiEvolver>(scene, std::move(parts));
  if (rough) return detail::with_law<Dim, false, WrittenLaw<true>, ToiEvolver>(scene, std::move(parts));
  if (accelerates) return detail::with_law<Dim, true, WrittenLaw<false>, ToiEvolver>(scene, std::move(parts));
  return detail::with_law<Dim, false, WrittenLaw<false>, ToiEvolver>(scene, std::move(parts));
}

}  // namespace carom
