#pragma once

#include <string_view>

#include "carom/world.h"
#include "scenario/scenario.h"

namespace carom {

/// Two rough spheres, or a rough sphere and a plane: the normal impulse of smooth ones, and along the surface
/// the smaller of sticking and sliding. Three parameters: restitution e, Coulomb's μ, and the tangential
/// restitution β0.
///
/// With n the unit normal from a to b and the contact point at r_a n from the centre of a and -r_b n from
/// that of b, the surfaces slip by
///   g = v_b - v_a - (r_a ω_a + r_b ω_b) × n,  g_t = g - (g·n) n.                      (1)
/// An impulse J_n n + J_t on b, and its opposite on a, changes the velocities by J/m and the spins by
/// -r (n × J_t)/I, on both balls alike. As (n × J_t) × n = J_t, the slip changes by
///   g_t' - g_t = J_t/m_t,  1/m_t = 1/m_a + 1/m_b + r_a²/I_a + r_b²/I_b,  I = κ m r²,  (2)
/// and n·g by J_n/m as for smooth spheres: the two do not mix. Then
///   J_n = -(1 + e) m v_n,  1/m = 1/m_a + 1/m_b,                                       (3)
///   sticking J_t = -(1 + β0) m_t g_t, so that g_t' = -β0 g_t, where that is at most μ J_n,
///   sliding  J_t = -μ J_n g_t/|g_t| otherwise.                                        (4)
/// Along the surface the pair loses ½ m_t (g_t² - g_t'²), which is not negative for -1 <= β0 <= 1. An
/// immovable ball has 1/m = 1/I = 0; a plane is one. Source: S. F. Foerster, M. Y. Louge, H. Chang, K. Allia,
/// "Measurements of the collision properties of small spheres", Phys. Fluids 6, 1108 (1994), for equal
/// homogeneous spheres; (2) holds for any two.
struct ThreeParameter {
  static constexpr std::string_view kName = "three-parameter";
  static constexpr bool kFriction = true;

  /// Returns the impulse on b, N s; a gets the opposite. @pre not both are immovable, and the world spins.
  template <int Dim>
  static Vec<Dim> between(World<Dim>& world, std::size_t a, std::size_t b, const Vec<Dim>& normal,
                          const Contact& surface) {
    const Vec<Dim> arm_a = world.radius[a] * normal;
    const Vec<Dim> arm_b = -world.radius[b] * normal;
    const Vec<Dim> slip = surface_velocity<Dim>(world, b, arm_b) - surface_velocity<Dim>(world, a, arm_a);
    const double inverse_mass = world.inverse_mass[a] + world.inverse_mass[b];
    const double inverse_turning = yield_to_turning(world, a) + yield_to_turning(world, b);
    const double v_n = normal.dot(world.velocity[b] - world.velocity[a]);
    Vec<Dim> impulse = impulse_of<Dim>(v_n, slip, normal, inverse_mass, inverse_turning, surface);
    push<Dim>(world, a, arm_a, -impulse);
    push<Dim>(world, b, arm_b, impulse);
    return impulse;
  }

  /// Returns the impulse on the ball, N s. @pre the ball is movable, the world spins; the normal points away
  /// from the wall.
  template <int Dim>
  static Vec<Dim> on_wall(World<Dim>& world, std::size_t ball, const Vec<Dim>& normal,
                          const Contact& surface) {
    const Vec<Dim> arm = -world.radius[ball] * normal;
    const double v_n = normal.dot(world.velocity[ball]);
    Vec<Dim> impulse = impulse_of<Dim>(v_n, surface_velocity<Dim>(world, ball, arm), normal,
                                       world.inverse_mass[ball], yield_to_turning(world, ball), surface);
    push<Dim>(world, ball, arm, impulse);
    return impulse;
  }

 private:
  /// Of the ball's point at `arm` from its centre.
  template <int Dim>
  static Vec<Dim> surface_velocity(const World<Dim>& world, std::size_t ball, const Vec<Dim>& arm) {
    return world.velocity[ball] + turned<Dim>(world.spin[ball], arm);
  }

  /// r²/I, 1/kg.
  template <int Dim>
  static double yield_to_turning(const World<Dim>& world, std::size_t ball) {
    return world.radius[ball] * world.radius[ball] * world.inverse_inertia[ball];
  }

  /// J_n n + J_t of (3) and (4).
  template <int Dim>
  static Vec<Dim> impulse_of(double v_n, const Vec<Dim>& slip, const Vec<Dim>& normal, double inverse_mass,
                             double inverse_turning, const Contact& surface) {
    const double along_normal = -(1.0 + surface.restitution) * v_n / inverse_mass;
    const Vec<Dim> tangential_slip = slip - normal.dot(slip) * normal;
    const double slip_speed = tangential_slip.norm();
    double per_slip = (1.0 + surface.tangential_restitution) / (inverse_mass + inverse_turning);
    const double most = surface.friction * along_normal;
    if (per_slip * slip_speed > most) per_slip = most / slip_speed;
    return along_normal * normal - per_slip * tangential_slip;
  }

  template <int Dim>
  static void push(World<Dim>& world, std::size_t ball, const Vec<Dim>& arm, const Vec<Dim>& impulse) {
    world.velocity.set(ball, world.velocity[ball] + world.inverse_mass[ball] * impulse);
    world.spin.set(ball, world.spin[ball] + world.inverse_inertia[ball] * moment<Dim>(arm, impulse));
  }
};

}  // namespace carom
