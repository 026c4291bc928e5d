#pragma once

#include "carom/laws/cluster_law.h"

namespace carom {

/// Impacts that travel: only contacts that approach push, all of these at once, and those that they set
/// approaching come next.
///
/// In each round the velocities v are reflected about their projection p onto what the approaching contacts
/// allow, the nearest velocities in the metric of the masses at which none of them approaches:
///   v' = p + e (p - v).                                                               (1)
/// This is (1) of resolve_in_rounds() over the approaching contacts alone, for its impulses are 1 + e times
/// those of the projection; there an e_c of each contact has a meaning too. Five touching balls hit by one of
/// their own kind at v: it stops, and only the last leaves, at v.
/// Source: B. Smith, D. M. Kaufman, E. Vouga, R. Tamstorf, E. Grinspun, "Reflections on simultaneous impact",
/// ACM Trans. Graph. 31, 106 (2012), for e = 1. Here e < 1 acts in every round, so that a single contact
/// obeys Newton's restitution and a row of balls that barely touch is the limit of one with gaps.
template <int Dim>
class GeneralizedReflections final : public ClusterLaw<Dim> {
 public:
  static constexpr std::string_view kName = "generalized-reflections";

  std::string_view name() const override { return kName; }
  void resolve(World<Dim>& world, std::span<ClosedContact<Dim>> contacts) const override;
};

}  // namespace carom
