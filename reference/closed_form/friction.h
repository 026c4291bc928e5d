#pragma once

#include "reference/closed_form/scene_facts.h"
#include "reference/closed_form/twofold_vector.h"
#include "scenario/scenario.h"

namespace carom::closed_form {

/// The tangential impulse of an impact, N s, on the body whose surface slips at s against the other's:
///
///   J_t = -(1 + β0) s / w         where the surfaces stick,                          (1)
///   J_t = -μ J_n s / |s|          where they slide: where (1) is more than μ J_n     (2)
///
/// w is by how much one newton second at the contact, along the surface, changes the slip, 1/kg. A sphere of
/// mass m and moment of inertia κ m r² moves its surface by 1/m as a whole and by r²/(κ m r²) as it is spun:
///
///   w = Σ (1 + 1/κ) / m           over both bodies                                   (3)
///
/// Source: the three-parameter law, S. F. Foerster, M. Y. Louge, H. Chang, K. Allia, Phys. Fluids 6, 1108
/// (1994), equations 1 to 6, there for κ = 2/5 and equal balls.
inline Vec3Twofold friction_impulse(const Contact& contact, const Vec3Twofold& slip_mps,
                                    const Twofold& w_per_kg, const Twofold& normal_Ns) {
  const Twofold slip = length(slip_mps);
  const Twofold sticking = (Twofold(1.0) + contact.tangential_restitution) / w_per_kg;
  const Twofold sliding = normal_Ns * contact.friction;
  return slip_mps * (sticking * slip <= sliding ? -sticking : -sliding / slip);
}

/// 1/m; nothing moves an immovable ball.
inline Twofold inverse_mass(const Ball& ball) {
  return is_immovable(ball) ? Twofold(0.0) : Twofold(1.0) / ball.mass;
}

/// (1 + 1/κ) / m of (3).
inline Twofold slip_per_impulse(const Ball& ball) {
  return (Twofold(1.0) + Twofold(1.0) / ball.inertia) * inverse_mass(ball);
}

}  // namespace carom::closed_form
