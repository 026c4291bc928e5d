#pragma once

#include <span>

#include "carom/laws/cluster_law.h"

namespace carom {

/// Whether contacts that neither approach nor separate push in a round of impacts.
enum class AtRest { takes_part, stands_by };

/// Contacts that are closed at one moment, resolved in rounds until none approaches.
///
/// With u the opening velocities of the contacts, G their normals and M the masses, a round finds impulses
///   λ >= 0,  u' = u + G M⁻¹ Gᵀ λ,  w' = u' + e_c u >= 0,  λᵀw' = 0                    (1)
/// for those contacts that approach, u < 0, and, where they take part, for those at rest, u = 0. Contacts
/// that separate are left out: for them (1) would allow an approach, and u' >= 0 in its place would gain
/// energy. One that a round has set approaching is in the next. So the law makes sure, for any e_c in [0, 1]:
/// - A round exists: u' = -u is above every aim while immovable balls are at rest.
/// - No energy is gained: where λ_c > 0, u'_c = -e_c u_c, and the round's energy changes by
///   ½ Σ λ_c (u_c + u'_c) = ½ Σ λ_c (1 - e_c) u_c <= 0, and by nothing for e = 1.      (2)
///   Newton's w' >= 0 for all contacts with an e_c of each its own could gain.
/// - Balls that can open all their contacts at once separate after finitely many elastic rounds: the impulses
///   have no end but along such a motion. A ball wedged between walls would rebound forever, and balls with
///   e < 1 can rebound infinitely often; after kMostRounds the approach that is left is taken out at once, as
///   by (1) with e = 0 for all contacts, u' >= 0, which loses ½ λᵀ G M⁻¹ Gᵀ λ.
///
/// (1) is Newton's restitution as a complementarity problem: Ch. Glocker, F. Pfeiffer, "Multiple impacts with
/// friction in rigid multibody systems", Nonlinear Dynamics 7, 471 (1995); (2) is how its energy is judged in
/// R. I. Leine, N. van de Wouw, "Stability and Convergence of Mechanical Systems with Unilateral Constraints"
/// (2008), §5.
/// On return the impulses of all rounds are added up in the contacts.
template <int Dim>
void resolve_in_rounds(World<Dim>& world, std::span<ClosedContact<Dim>> contacts, AtRest at_rest);

}  // namespace carom
