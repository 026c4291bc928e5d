#pragma once

#include "reference/converged/number.h"
#include "scenario/scenario.h"

namespace carom::converged {

/// One side of an impact. A wall, and an immovable ball, is one that no impulse moves.
struct Side {
  Real per_mass = 0;     ///< 1/m, 1/kg
  Real per_turning = 0;  ///< 1/(κ m), 1/kg: r²/I
  Real radius_m = 0;
  Vector v = Vector::Zero();     ///< m/s
  Vector spin = Vector::Zero();  ///< rad/s

  static Side of(const Ball& ball, const Vector& v, const Vector& spin);
};

/// The three-parameter impact of a and b; n is the unit vector from a to b at the contact. Changes both, and
/// returns the impulse on b, N s; a gets the opposite.
///
/// The points that touch are at r_a n from the centre of a and at -r_b n from that of b. They slip by
///
///   s = (v_b - r_b ω_b × n) - (v_a + r_a ω_a × n),   of which along the surface  s_t = s - (s·n) n (1)
///
/// and an impulse J on b, -J on a, at that point gives
///
///   Δv_b = J/m_b,  Δω_b = (-r_b n) × J/I_b;   Δv_a = -J/m_a,  Δω_a = (r_a n) × (-J)/I_a                  (2)
///
/// so with -(n × J) × n = -J_t and I = κ m r², put into (1),
///
///   Δs_n = J_n (1/m_a + 1/m_b),   Δs_t = J_t Σ (1/m)(1 + 1/κ) (3)
///
/// Newton's law asks for s_n' = -e s_n. Where the surfaces stick the third parameter asks for
/// s_t' = -β0 s_t; friction can give no more than μ J_n, and where it gives that they slide:
///
///   J_n = -(1 + e) s_n / (1/m_a + 1/m_b),
///   J_t = -(1 + β0) s_t / Σ (1/m)(1 + 1/κ),   or, where that is longer than μ J_n,   -μ J_n s_t/|s_t| (4)
///
/// Source of the law: O. R. Walton, in "Particulate Two-Phase Flow" (1993), chapter 25; S. F. Foerster,
/// M. Y. Louge, H. Chang, K. Allia, Phys. Fluids 6, 1108 (1994). (2) and (3) are Newton's second law and hold
/// for unequal balls.
/// @pre something moves, and they approach: (v_b - v_a)·n < 0.
Vector strike(const Contact& contact, const Vector& n, Side& a, Side& b);

}  // namespace carom::converged
