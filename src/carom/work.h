#pragma once

#include <cstddef>

#include "carom/world.h"
#include "engine/engine.h"

namespace carom {

// The work of impulses, (1) of EnergyAccount, from what is known after them: an impulse J that changes the
// relative velocity by J/m from g to g' does the work J (g + g')/2 = J (g' - J/(2m)), so that nothing has to
// be kept from before. Only movable balls have energy: where one of a pair is immovable, g is the velocity of
// the other.

/// How fast ball b moves along the normal, less how fast ball a does; an immovable one counts as at rest. m/s
template <int Dim>
double opening_of_movable(const World<Dim>& world, std::size_t a, std::size_t b, const Vec<Dim>& normal) {
  double opening = 0.0;
  if (world.inverse_mass[a] > 0.0) opening -= normal.dot(world.velocity[a]);
  if (world.inverse_mass[b] > 0.0) opening += normal.dot(world.velocity[b]);
  return opening;
}

/// The velocity of the ball's point at `arm` from its centre, m/s. @pre the world spins
template <int Dim>
Vec<Dim> velocity_at(const World<Dim>& world, std::size_t ball, const Vec<Dim>& arm) {
  return world.velocity[ball] + turned<Dim>(world.spin[ball], arm);
}

/// How much the surface of a ball yields to an impulse along it, 1/kg. @pre the world spins
template <int Dim>
double yield_along_surface(const World<Dim>& world, std::size_t ball) {
  return world.inverse_mass[ball] + world.radius[ball] * world.radius[ball] * world.inverse_inertia[ball];
}

/// The work of an impulse on ball b, and its opposite on ball a, that has just acted at their contact with
/// this unit normal from a to b.
template <bool kFriction, int Dim>
void add_work_between(const World<Dim>& world, std::size_t a, std::size_t b, const Vec<Dim>& normal,
                      const Vec<Dim>& impulse, EnergyAccount& energy) {
  const double push = normal.dot(impulse);
  const double inverse_mass = world.inverse_mass[a] + world.inverse_mass[b];
  const double work_J = push * (opening_of_movable<Dim>(world, a, b, normal) - 0.5 * push * inverse_mass);
  const bool both_movable = world.inverse_mass[a] > 0.0 && world.inverse_mass[b] > 0.0;
  (both_movable ? energy.ball_impacts_J : energy.wall_impacts_J) += work_J;
  if constexpr (kFriction) {
    const Vec<Dim> drag = impulse - push * normal;
    Vec<Dim> slip = Vec<Dim>::Zero();
    if (world.inverse_mass[a] > 0.0) slip -= velocity_at<Dim>(world, a, world.radius[a] * normal);
    if (world.inverse_mass[b] > 0.0) slip += velocity_at<Dim>(world, b, -world.radius[b] * normal);
    const double yields = yield_along_surface<Dim>(world, a) + yield_along_surface<Dim>(world, b);
    energy.friction_J += drag.dot(slip) - 0.5 * yields * drag.squaredNorm();
  }
}

/// The same of an impulse that a wall with this normal has just given to a ball.
template <bool kFriction, int Dim>
void add_work_of_wall(const World<Dim>& world, std::size_t ball, const Vec<Dim>& normal,
                      const Vec<Dim>& impulse, EnergyAccount& energy) {
  const double push = normal.dot(impulse);
  energy.wall_impacts_J += push * (normal.dot(world.velocity[ball]) - 0.5 * push * world.inverse_mass[ball]);
  if constexpr (kFriction) {
    const Vec<Dim> drag = impulse - push * normal;
    const Vec<Dim> slip = velocity_at<Dim>(world, ball, -world.radius[ball] * normal);
    energy.friction_J += drag.dot(slip) - 0.5 * yield_along_surface<Dim>(world, ball) * drag.squaredNorm();
  }
}

}  // namespace carom
