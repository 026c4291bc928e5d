#pragma once

#include "carom/laws/cluster_law.h"

namespace carom {

/// All contacts of a cluster push at once: a linear complementarity problem with Newton's restitution, over
/// the contacts that approach and those at rest (resolve_in_rounds). Rigid bodies without any wave between
/// them: of five touching balls hit by one of their own kind at v, the first flies back at 0.6 v and the
/// others leave together at 0.4 v, so nothing breaks away from them. Source: B. Smith, D. M. Kaufman, E.
/// Vouga, R. Tamstorf, E. Grinspun, "Reflections on simultaneous impact", ACM Trans. Graph. 31, 106 (2012),
/// where it is called the LCP model.
template <int Dim>
class Simultaneous final : public ClusterLaw<Dim> {
 public:
  static constexpr std::string_view kName = "simultaneous";

  std::string_view name() const override { return kName; }
  void resolve(World<Dim>& world, std::span<ClosedContact<Dim>> contacts) const override;
};

}  // namespace carom
