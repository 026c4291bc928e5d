#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "carom/evolvers/cluster.h"
#include "carom/evolvers/contact_solver.h"
#include "carom/evolvers/crowd.h"
#include "carom/evolvers/flights.h"
#include "carom/evolvers/held_contacts.h"
#include "carom/evolvers/neighbours.h"
#include "carom/plane.h"

namespace carom {

/// Contact becomes rest.
///
/// With e < 1 balls would collide infinitely often in finite time. A contact ends in rest instead where its
/// rebound would be over within kRestShare of the step (2 v_n'/|a_n|), or where there is no rebound
/// (rest_rule.h). With it rest the contacts around that are as slow (cluster.h): settle() takes out their
/// closing velocities and accelerations together, and they stay closed until the step ends or one of the
/// balls is hit. What is lost with a rebound left out is at most ½ m v_n'² = ⅛ m (kRestShare a_n h)². Elastic
/// balls come to rest only from rebounds a thousand times shorter (kElasticRestShare).
///
/// Friction in contacts that stay closed slides, Coulomb's μ N against the slip, until the slip ends, and
/// then holds. The moment at which a slip ends is part of the step like an impact (grips()).
///
/// Where balls still chatter after as many flights in a step as kMostFlights, the rest of the step is taken
/// in one piece (crowd.h), and whatever hits the crowd later in the step joins it. That ends piles that form,
/// and inelastic collapse.
template <int Dim, bool kAccelerates, bool kFriction>
class Resting {
 public:
  using Balls = Flights<Dim, kAccelerates, kFriction>;
  using Kept = KeptContact<Dim>;
  using Rule = RestRule<Dim, Balls>;
  using Seed = ContactSeed;

  /// A moment at which a contact's slip ends, s from the start of the step.
  struct Grip {
    Seed contact;
    double time_s;
  };

  Resting(const Scenario& scene, Balls& flights, Neighbours<Dim, Balls>& neighbours,
          const std::vector<Plane<Dim>>& planes)
      : flights_(flights),
        held_(flights),
        cluster_(flights, neighbours, planes, held_,
                 {scene.ball_contact.friction, scene.wall_contact.friction}),
        crowd_(flights, neighbours, planes, held_, cluster_, solver_) {}

  void begin_step() {
    held_.begin_step();
    crowd_.begin_step();
  }

  /// Whether a contact with this normal velocity and acceleration (both negative when closing) stays closed.
  /// @param place_m  the size of the balls' coordinates
  bool comes_to_rest(double v_n, double a_n, double restitution, double speeds, double place_m) const {
    return rule().comes_to_rest(v_n, a_n, restitution, speeds, place_m, kFriction);
  }

  /// Closes the contact, and with it those around it that are as good as closed, for the rest of the step.
  /// The balls in it, members(), have new flights.
  void settle(const Seed& seed, double time_s) {
    grips_.clear();
    cluster_.gather(seed, time_s, solver_.contacts());
    if (std::any_of(members().begin(), members().end(), [this](auto ball) { return in_crowd(ball); })) {
      join_crowd(seed, time_s);
      return;
    }
    solve_velocities();
    // What opens does not push any more.
    std::erase_if(solver_.contacts(), [this](const Kept& contact) {
      return Solver::opening(contact, world().velocity) > rule().still();
    });
    begin_flights();
    if constexpr (kAccelerates) {
      if (!solve_accelerations()) {
        // Velocities always have a solution.
        begin_flights();
        const std::vector<std::uint32_t> settled = members();
        join_crowd(seed, time_s);
        // Who does not join flies freely, and may meet somebody yet.
        for (const std::uint32_t ball : settled) cluster_.take_in_hit(ball);
        return;
      }
    }
    for (const Kept& contact : solver_.contacts()) {
      if (stays_closed(contact)) held_.hold(contact.a, contact.b, contact.wall);
    }
    find_grips();
  }

  /// Takes the rest of the step in one piece for all balls that would meet until then: they are members(),
  /// and fly straight on.
  void join_crowd(const Seed& seed, double time_s) {
    grips_.clear();
    crowd_.join(seed, time_s);
    EnergyAccount& energy = flights_.account().tally.energy;
    (only_outside() ? energy.wall_impacts_J : energy.ball_impacts_J) += crowd_.energy_change();
    if (crowd_.had_impact()) ++flights_.account().tally.impacts;
    for (const std::uint32_t ball : members()) flights_.coast(ball);
    crowd_.for_each_impulse([this](const Kept& contact, const Vec<Dim>& impulse) {
      book(contact, impulse);
      held_.hold(contact.a, contact.b, contact.wall);
    });
  }

  /// Whether a crowd has taken the ball in, in this step.
  bool in_crowd(std::size_t ball) const { return crowd_.has(ball); }

  /// The contacts that hang together with the seed's and are closed at its moment, whatever their velocities;
  /// their balls are members() then. By (ball, wall, other).
  void gather_touching(const Seed& seed, double time_s, std::vector<ClosedContact<Dim>>& contacts) {
    grips_.clear();
    cluster_.gather_touching(seed, time_s, contacts);
  }

  /// The balls that lean on those that were hit, and these themselves, get new flights: what bears them has
  /// changed. They are members() then.
  void begin_flights_around(std::span<const std::uint32_t> hit) {
    grips_.clear();
    cluster_.begin();
    for (const std::uint32_t ball : hit) cluster_.take_in_hit(ball);
    cluster_.join_leaning(flights_.clock(members().front()));
    begin_flights();
  }

  const std::vector<std::uint32_t>& members() const { return cluster_.members(); }
  const std::vector<Grip>& grips() const { return grips_; }

  /// A held contact is not met again while neither ball begins a new flight.
  bool is_held(std::size_t a, std::size_t b, bool wall) const { return held_.has(a, b, wall); }

  static Settings settings() {
    return {{"rest_share_of_step", Rule::kRestShare},
            {"elastic_rest_share_of_step", Rule::kElasticRestShare},
            {"most_flights_in_step", static_cast<double>(kMostFlights)}};
  }

  /// Flights of a ball within a step after which what comes to rest does so in a crowd. A ball that comes to
  /// rest on the floor begins two or three, one in a corner some more.
  static constexpr std::uint32_t kMostFlights = 6;

 private:
  using Solver = ContactSolver<Dim, kFriction>;

  const World<Dim>& world() const { return flights_.world(); }
  const Rule& rule() const { return cluster_.rule(); }
  double inverse_mass(std::uint32_t ball) const { return world().inverse_mass[ball]; }

  void begin_flights() {
    for (const std::uint32_t ball : members()) flights_.begin_flight(ball);
  }

  // --- impact and statics of what is closed

  void solve_velocities() {
    World<Dim>& world = flights_.world();
    const auto response = [this](std::uint32_t ball) { return inverse_mass(ball); };
    bool impact = false;
    for (const Kept& contact : solver_.contacts()) {
      impact = impact || Solver::opening(contact, world.velocity) < -rule().slow() - rule().rounding();
    }
    if (impact) ++flights_.account().tally.impacts;
    before_.clear();
    for (const Kept& contact : solver_.contacts()) before_.push_back(parting(contact));
    // Friction that is not found to rounding may differ; what closes may not.
    if (!solver_.solve(world, world.velocity, world.spin, response, rule().tolerance())) {
      solver_.solve_openings(world, world.velocity, world.spin, response, rule().tolerance());
    }
    for (std::size_t k = 0; k < before_.size(); ++k) {
      const Kept& contact = solver_.contacts()[k];
      book(contact, contact.push * contact.normal + contact.drag);
      book_work(contact, before_[k]);
    }
  }

  /// How the surfaces of a contact move against each other, m/s, an immovable one counting as at rest.
  struct Parting {
    double opening;
    Vec<Dim> slip;
  };

  Parting parting(const Kept& contact) const {
    const bool alone = contact.wall || inverse_mass(contact.b) == 0.0;
    const double sign = contact.wall ? 1.0 : -1.0;
    Parting parting{sign * contact.normal.dot(world().velocity[contact.a]), Vec<Dim>::Zero()};
    if (!alone) parting.opening += contact.normal.dot(world().velocity[contact.b]);
    if constexpr (kFriction) {
      parting.slip = sign * velocity_at<Dim>(world(), contact.a, arm_of(contact));
      if (!alone) {
        const Vec<Dim> arm = -world().radius[contact.b] * contact.normal;
        parting.slip += velocity_at<Dim>(world(), contact.b, arm);
      }
    }
    return parting;
  }

  /// (1) of EnergyAccount for pushes that acted at many contacts at once.
  void book_work(const Kept& contact, const Parting& before) {
    const Parting after = parting(contact);
    EnergyAccount& energy = flights_.account().tally.energy;
    const bool outside = contact.wall || inverse_mass(contact.b) == 0.0;
    (outside ? energy.wall_impacts_J : energy.ball_impacts_J) +=
        0.5 * contact.push * (before.opening + after.opening);
    if constexpr (kFriction) energy.friction_J += 0.5 * contact.drag.dot(before.slip + after.slip);
  }

  /// Whether every contact at hand is with a plane or an immovable ball. A crowd meets balls and walls at
  /// once, and again and again: where balls are among them, all of what it changes is booked to impacts of
  /// balls.
  bool only_outside() const {
    const auto& contacts = solver_.contacts();
    return std::all_of(contacts.begin(), contacts.end(),
                       [this](const Kept& contact) { return external(contact).has_value(); });
  }

  void book(const Kept& contact, const Vec<Dim>& impulse) {
    const std::optional<double> sign = external(contact);
    if (!sign) return;
    if (contact.wall) flights_.account().tally.wall_push_Ns += contact.normal.dot(impulse);
    flights_.account().book(world().position[contact.a] + arm_of(contact), *sign * impulse);
  }

  /// Statics for the rest of the step, or until a slip ends. Returns false where there is none.
  bool solve_accelerations() {
    const auto response = [this](std::uint32_t ball) { return flights_.response(ball); };
    for (Kept& contact : solver_.contacts()) {
      contact.push = held_.known_push(contact.a, contact.b, contact.wall);
      contact.drag.setZero();
      if constexpr (kFriction) {
        contact.slip = sliding_direction(contact);
        contact.drag = -(contact.friction * contact.push) * contact.slip;
      }
    }
    solver_.start(world(), flights_.accelerations(), flights_.spin_accelerations(), response);
    if (!solver_.solve(world(), flights_.accelerations(), flights_.spin_accelerations(), response,
                       rule().tolerance() / flights_.step_s())) {
      return false;
    }
    for (const Kept& contact : solver_.contacts()) {
      held_.learn_push(contact.a, contact.b, contact.wall, contact.push);
      const std::optional<double> sign = external(contact);
      if (!sign) continue;
      flights_.bear(contact.a, *sign * (contact.push * contact.normal + contact.drag), arm_of(contact));
    }
    return true;
  }

  /// +1 or -1, the sign with which the contact's push acts on its ball a, where it comes from outside: from a
  /// plane or an immovable ball.
  std::optional<double> external(const Kept& contact) const {
    if (contact.wall) return 1.0;
    if (inverse_mass(contact.b) == 0.0) return -1.0;
    return std::nullopt;
  }

  /// From the centre of ball a to the contact.
  Vec<Dim> arm_of(const Kept& contact) const {
    return ((contact.wall ? -1.0 : 1.0) * world().radius[contact.a]) * contact.normal;
  }

  /// Whether the solution leaves the contact closed: some are opened by what the others push.
  bool stays_closed(const Kept& contact) {
    if (Solver::opening(contact, world().velocity) > rule().still()) return false;
    if constexpr (kAccelerates) {
      return Solver::opening(contact, flights_.accelerations()) * flights_.step_s() <= rule().still();
    }
    return true;
  }

  // --- friction that lasts

  double slip_rounding(const Kept& contact) const {
    double speeds = flights_.field_speed() + surface_speed(contact.a);
    if (!contact.wall) speeds += surface_speed(contact.b);
    return velocity_rounding(speeds);
  }

  double surface_speed(std::uint32_t ball) const {
    return world().velocity[ball].norm() + world().radius[ball] * world().spin[ball].norm();
  }

  Vec<Dim> sliding_direction(const Kept& contact) const {
    if (contact.friction == 0.0) return Vec<Dim>::Zero();
    const Vec<Dim> slip = Solver::slip(world(), contact, world().velocity, world().spin);
    const double speed = slip.norm();
    return speed <= slip_rounding(contact) ? Vec<Dim>(Vec<Dim>::Zero()) : Vec<Dim>(slip / speed);
  }

  /// When do the contacts that slide stop doing so? The slip changes at a constant rate ġ, so it is least
  /// after -g·ġ/ġ².
  void find_grips() {
    if constexpr (kAccelerates && kFriction) {
      for (const Kept& contact : solver_.contacts()) {
        if (contact.slip.isZero(0.0) || contact.push == 0.0) continue;
        const Vec<Dim> g = Solver::slip(world(), contact, world().velocity, world().spin);
        const Vec<Dim> rate =
            Solver::slip(world(), contact, flights_.accelerations(), flights_.spin_accelerations());
        if (!(g.dot(rate) < 0.0)) continue;
        const double time_s = flights_.clock(contact.a) - g.dot(rate) / rate.squaredNorm();
        grips_.push_back({{contact.a, contact.b, contact.wall}, time_s});
      }
    }
  }

  Balls& flights_;
  HeldContacts<Balls> held_;
  Cluster<Dim, Balls> cluster_;
  Solver solver_;
  Crowd<Dim, kAccelerates, kFriction> crowd_;
  std::vector<Parting> before_;  ///< of the contacts at hand, before their impact
  std::vector<Grip> grips_;
};

}  // namespace carom
