#pragma once

#include "reference/exact/setting.h"

namespace carom::exact {

/// How fast two bodies approach along the normal from a to b, m/s; negative where they part.
Real approach_mps(const Body& a, const Body& b, const Vector& normal);

/// Carries out an impact of two spheres, or of a wall (a) and a sphere (b), and returns the impulse on b, N
/// s.
///
/// With n the unit normal from a to b, w the speed of approach, and J the impulse on b,
///
///   J_n = (1 + e) w / (1/m_a + 1/m_b)                                                     (1)
///
/// The surfaces slip at the contact, r_a n from the centre of a and -r_b n from that of b, by
///
///   s = v_b - v_a - (r_a ω_a + r_b ω_b) × n,  without its part along n                       (2)
///
/// and an impulse J_t along the surface changes s by J_t/m_t, as it turns both spheres by -r n × J_t/(κ m
/// r²):
///
///   1/m_t = Σ (1/m + r²/(κ m r²))                                                      (3)
///   J_t = -(1 + β0) m_t s              where the surfaces stick: where that is at most μ J_n
///   J_t = -μ J_n s/|s|                 where they slide                                   (4)
///
/// Source: S. F. Foerster, M. Y. Louge, H. Chang, K. Allia, Phys. Fluids 6, 1108 (1994), equations 1 to 6,
/// for equal homogeneous spheres; derived here for any two.
/// @pre they touch, approach, and not both are immovable
Vector collide(Body& a, const Matter& matter_a, Body& b, const Matter& matter_b, const Vector& normal,
               const Contact& contact);

}  // namespace carom::exact
