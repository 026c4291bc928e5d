#pragma once

#include <string_view>

#include "carom/world.h"
#include "scenario/scenario.h"

namespace carom {

/// Two smooth spheres, or a smooth sphere and a plane: the impulse acts along the normal.
///
/// With n the unit normal from a to b, v_n = (v_b - v_a)·n < 0 the normal relative velocity and
/// 1/m = 1/m_a + 1/m_b, Newton's restitution v_n' = -e v_n and the conservation of momentum give
///   J = -(1 + e) m v_n  on b, and -J on a.                                            (1)
/// The pair loses ½ m (1 - e²) v_n². A plane is a body of infinite mass.
/// Source: e.g. W. J. Stronge, "Impact Mechanics" (2000), §2.3.
struct Frictionless {
  static constexpr std::string_view kName = "frictionless";
  static constexpr bool kFriction = false;

  /// Returns the impulse on b, N s; a gets the opposite. @pre not both are immovable.
  template <int Dim>
  static Vec<Dim> between(World<Dim>& world, std::size_t a, std::size_t b, const Vec<Dim>& normal,
                          const Contact& surface) {
    const double inverse_mass = world.inverse_mass[a] + world.inverse_mass[b];
    const double v_n = normal.dot(world.velocity[b] - world.velocity[a]);
    Vec<Dim> impulse = (-(1.0 + surface.restitution) * v_n / inverse_mass) * normal;
    world.velocity.set(a, world.velocity[a] - world.inverse_mass[a] * impulse);
    world.velocity.set(b, world.velocity[b] + world.inverse_mass[b] * impulse);
    return impulse;
  }

  /// Returns the impulse on the ball, N s. @pre the ball is movable; the normal points away from the wall.
  template <int Dim>
  static Vec<Dim> on_wall(World<Dim>& world, std::size_t ball, const Vec<Dim>& normal,
                          const Contact& surface) {
    const double v_n = normal.dot(world.velocity[ball]);
    const Vec<Dim> change = (-(1.0 + surface.restitution) * v_n) * normal;
    world.velocity.set(ball, world.velocity[ball] + change);
    return change / world.inverse_mass[ball];
  }
};

}  // namespace carom
