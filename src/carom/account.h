#pragma once

#include <span>

#include "carom/laws/cluster_law.h"
#include "carom/world.h"
#include "engine/engine.h"

namespace carom {

/// The account of a simulation: impacts, and what walls and immovable balls push, about the origin.
template <int Dim>
struct Account {
  Tally tally = {.walls_known = true};

  /// An impulse on a movable ball, N s, that acts at `place`.
  void book(const Vec<Dim>& place, const Vec<Dim>& impulse) {
    const Vec3 wide = widened<Dim>(impulse);
    tally.external_impulse += wide;
    tally.external_angular_impulse += widened<Dim>(place).cross(wide);
  }

  /// An impulse of a wall or slab with this normal, which points at the ball.
  void book_wall(const Vec<Dim>& place, const Vec<Dim>& normal, const Vec<Dim>& impulse) {
    tally.wall_push_Ns += normal.dot(impulse);
    book(place, impulse);
  }

  /// An impulse on ball b and its opposite on ball a, at a contact with this normal from a to b: what an
  /// immovable one of them bears comes from outside.
  void book_pair(const World<Dim>& world, std::size_t a, std::size_t b, const Vec<Dim>& normal,
                 const Vec<Dim>& impulse) {
    if (world.inverse_mass[a] == 0.0) book(world.position[b] - world.radius[b] * normal, impulse);
    if (world.inverse_mass[b] == 0.0) book(world.position[a] + world.radius[a] * normal, -impulse);
  }

  /// What a law has done at contacts that were closed together, along their normals.
  void book_contacts(const World<Dim>& world, std::span<const ClosedContact<Dim>> contacts) {
    for (const ClosedContact<Dim>& contact : contacts) {
      const Vec<Dim> impulse = contact.impulse * contact.normal;
      if (contact.wall) {
        book_wall(world.position[contact.a], contact.normal, impulse);
      } else {
        book_pair(world, contact.a, contact.b, contact.normal, impulse);
      }
    }
  }

  /// Only a moment, arm × impulse: a ball was put somewhere else with the momentum that it has; or an impulse
  /// and its opposite act at points that lie apart by the arm.
  void book_moment(const Vec<Dim>& arm, const Vec<Dim>& impulse) {
    tally.external_angular_impulse += widened<Dim>(arm).cross(widened<Dim>(impulse));
  }
};

}  // namespace carom
