#pragma once

#include <span>
#include <vector>

#include "carom/laws/cluster_law.h"
#include "carom/work.h"
#include "carom/world.h"
#include "engine/engine.h"

namespace carom {

/// The account of a simulation: impacts, what walls and immovable balls push, about the origin, and what
/// pushes did to the energy.
template <int Dim>
struct Account {
  Tally tally = {.walls_known = true};

  Account() { tally.energy.known = true; }

  /// What happened after this.
  void add(const Account& later) {
    tally.impacts += later.tally.impacts;
    tally.wall_impacts += later.tally.wall_impacts;
    tally.wall_push_Ns += later.tally.wall_push_Ns;
    tally.external_impulse += later.tally.external_impulse;
    tally.external_angular_impulse += later.tally.external_angular_impulse;
    tally.energy.ball_impacts_J += later.tally.energy.ball_impacts_J;
    tally.energy.wall_impacts_J += later.tally.energy.wall_impacts_J;
    tally.energy.friction_J += later.tally.energy.friction_J;
    tally.energy.correction_J += later.tally.energy.correction_J;
  }

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
  /// immovable one of them bears comes from outside. The impulse has just acted.
  template <bool kFriction>
  void book_pair(const World<Dim>& world, std::size_t a, std::size_t b, const Vec<Dim>& normal,
                 const Vec<Dim>& impulse) {
    book_outside(world, a, b, normal, impulse);
    add_work_between<kFriction, Dim>(world, a, b, normal, impulse, tally.energy);
  }

  /// An impulse that a plane with this normal has just given to a ball.
  template <bool kFriction>
  void book_plane(const World<Dim>& world, std::size_t ball, const Vec<Dim>& normal,
                  const Vec<Dim>& impulse) {
    book_wall(world.position[ball] - world.radius[ball] * normal, normal, impulse);
    add_work_of_wall<kFriction, Dim>(world, ball, normal, impulse, tally.energy);
  }

  /// The part of book_pair() that has to do with momentum.
  void book_outside(const World<Dim>& world, std::size_t a, std::size_t b, const Vec<Dim>& normal,
                    const Vec<Dim>& impulse) {
    if (world.inverse_mass[a] == 0.0) book(world.position[b] - world.radius[b] * normal, impulse);
    if (world.inverse_mass[b] == 0.0) book(world.position[a] + world.radius[a] * normal, -impulse);
  }

  /// Contacts that are about to be closed together by a law.
  void open_contacts(const World<Dim>& world, std::span<const ClosedContact<Dim>> contacts) {
    openings_.clear();
    for (const ClosedContact<Dim>& contact : contacts) openings_.push_back(opening_of(world, contact));
  }

  /// What the law has done at them, along their normals. @pre open_contacts() of the same
  void book_contacts(const World<Dim>& world, std::span<const ClosedContact<Dim>> contacts) {
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const ClosedContact<Dim>& contact = contacts[k];
      const Vec<Dim> impulse = contact.impulse * contact.normal;
      const double work_J = 0.5 * contact.impulse * (openings_[k] + opening_of(world, contact));
      if (contact.wall) {
        book_wall(world.position[contact.a], contact.normal, impulse);
        tally.energy.wall_impacts_J += work_J;
      } else {
        book_outside(world, contact.a, contact.b, contact.normal, impulse);
        const bool both_movable = world.inverse_mass[contact.a] > 0.0 && world.inverse_mass[contact.b] > 0.0;
        (both_movable ? tally.energy.ball_impacts_J : tally.energy.wall_impacts_J) += work_J;
      }
    }
  }

  /// Only a moment, arm × impulse: a ball was put somewhere else with the momentum that it has; or an impulse
  /// and its opposite act at points that lie apart by the arm.
  void book_moment(const Vec<Dim>& arm, const Vec<Dim>& impulse) {
    tally.external_angular_impulse += widened<Dim>(arm).cross(widened<Dim>(impulse));
  }

 private:
  static double opening_of(const World<Dim>& world, const ClosedContact<Dim>& contact) {
    return contact.wall ? contact.normal.dot(world.velocity[contact.a])
                        : opening_of_movable<Dim>(world, contact.a, contact.b, contact.normal);
  }

  std::vector<double> openings_;  ///< m/s, of the contacts that are being closed
};

}  // namespace carom
