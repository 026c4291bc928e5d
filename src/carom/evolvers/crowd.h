#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "carom/evolvers/cluster.h"
#include "carom/evolvers/flights.h"

namespace carom {

/// Balls that take the rest of a step in one piece (J. J. Moreau's time stepping, of first order): all that
/// would meet until the step ends have one common inelastic impact, so that no gap closes below zero, and fly
/// straight on.
///
/// A ball enters with the velocity that it would have at the end of the step. The impact is that of
/// contact_solver.h with u_min = -gap/(time left). Which contacts take part is found out with it: while few
/// sweeps still push balls against others, these are added; then the impact is solved, and it is the answer
/// if it pushes against nobody else.
template <int Dim, bool kAccelerates, bool kFriction>
class Crowd {
 public:
  using Balls = Flights<Dim, kAccelerates, kFriction>;
  using Solver = ContactSolver<Dim, kFriction>;
  using Kept = KeptContact<Dim>;
  using Place = Vec<Dim>;

  Crowd(Balls& flights, Neighbours<Dim, Balls>& neighbours, const std::vector<Plane<Dim>>& planes,
        const HeldContacts<Balls>& held, Cluster<Dim, Balls>& cluster, Solver& solver)
      : flights_(flights),
        neighbours_(neighbours),
        planes_(planes),
        held_(held),
        cluster_(cluster),
        solver_(solver) {}

  void begin_step() {
    ++steps_;
    bearing_.clear();
  }

  /// Whether a crowd has taken the ball in, in this step.
  bool has(std::size_t ball) const { return !crowd_.empty() && crowd_[ball] == steps_; }

  /// Calls f(contact, impulse) for each contact of the last impact: what this has added to what had acted
  /// before, N s, on its ball b, or on a from a plane.
  template <class F>
  void for_each_impulse(F f) const {
    for (std::size_t k = 0; k < solver_.contacts().size(); ++k) {
      f(solver_.contacts()[k], impulse_of(solver_.contacts()[k]) - acted_[k]);
    }
  }

  /// What the last impact changed of the members' kinetic energy, J: since each of them had the velocity with
  /// which it entered.
  double energy_change() const { return energy_change_J_; }

  /// Whether the last impact was more than what fields give in a step.
  bool had_impact() const { return impact_; }

  /// The seed's balls meet, and with them whoever they push until the step ends: these are the cluster's
  /// members then, the contacts that push or could are the solver's, and the velocities are the new ones.
  void join(const ContactSeed& seed, double time_s) {
    begin(seed, time_s);
    bool solved = false;
    for (int round = 0; round < kMostRounds; ++round) {
      if (add_contacts()) {
        guess();
        solved = false;
      } else if (!solved) {
        solve();
        look_again_where_it_leads_farther();
        solved = true;
      } else {
        break;
      }
    }
    if (!solved) solve();
    for (const std::uint32_t ball : cluster_.members()) energy_change_J_ += kinetic_energy(ball);
    for (const Kept& contact : solver_.contacts()) {
      const Bearing bearing = {side_of(contact) * impulse_of(contact), time_s};
      bearing_[contact_key(contact.a, contact.b, contact.wall)] = bearing;
    }
  }

 private:
  /// Rounds in which a crowd takes in balls that it pushes against others. One ring of a pile is one round.
  static constexpr int kMostRounds = 128;
  /// Of a gap: how far a crowd may close it. Gaps closed to the last bit would be met again by rounding.
  static constexpr double kCrowdShare = 1.0 - 1e-6;
  /// Sweeps that carry an impact one ring farther, and not yet to where it ends.
  static constexpr int kSweepsInARound = 8;

  /// Of the speed with which a gap is closed: what kCrowdShare has left of it by the next impact is no
  /// opening.
  static constexpr double kOpening = 1e-4;

  /// What a contact has pushed in the last impact that it took part in, on the ball with the higher number or
  /// from a plane, and when that was.
  struct Bearing {
    Place impulse;
    double time_s;
  };

  /// A contact that may come to push.
  struct Candidate {
    Kept contact;
    bool taken;
  };

  const World<Dim>& world() const { return flights_.world(); }

  void begin(const ContactSeed& seed, double time_s) {
    crowd_.resize(flights_.size(), 0);
    solver_.contacts().clear();
    acted_.clear();
    candidates_.clear();
    met_.clear();
    impact_ = false;
    energy_change_J_ = 0.0;
    entered_ = 0;
    looked_at_ = 0;
    seed_ = seed;
    time_s_ = time_s;
    cluster_.begin();
    cluster_.join(seed, time_s);
    // Entering may make members of those that lean on a member.
    for (std::size_t next = 0; next < cluster_.members().size(); ++next) enter(cluster_.members()[next]);
  }

  static auto response_in(const World<Dim>& world) {
    return [&world](std::uint32_t ball) { return world.inverse_mass[ball]; };
  }

  double kinetic_energy(std::uint32_t ball) const {
    double energy_J = 0.5 * world().velocity[ball].squaredNorm() / world().inverse_mass[ball];
    if constexpr (kFriction) {
      energy_J += 0.5 * world().spin[ball].squaredNorm() / world().inverse_inertia[ball];
    }
    return energy_J;
  }

  /// Until they are pushed, new members have the velocity with which they enter.
  void note_energy_of_new_members() {
    while (entered_ < cluster_.members().size()) {
      energy_change_J_ -= kinetic_energy(cluster_.members()[entered_++]);
    }
  }

  void guess() {
    note_energy_of_new_members();
    World<Dim>& world = flights_.world();
    solver_.guess(world, world.velocity, world.spin, response_in(world), cluster_.rule().crowd_tolerance(),
                  kSweepsInARound);
  }

  void solve() {
    note_energy_of_new_members();
    World<Dim>& world = flights_.world();
    solver_.solve_openings(world, world.velocity, world.spin, response_in(world),
                           cluster_.rule().crowd_tolerance());
  }

  /// Adds the contacts of members that the rest of the step would close below zero, and those that bear and
  /// would open. Returns whether there were any.
  bool add_contacts() {
    const std::size_t before = solver_.contacts().size();
    std::size_t next = 0;
    while (looked_at_ < cluster_.members().size() || next < candidates_.size()) {
      while (looked_at_ < cluster_.members().size()) find_candidates(cluster_.members()[looked_at_++]);
      for (; next < candidates_.size(); ++next) add_if_it_closes_or_lets_go(next);
    }
    return solver_.contacts().size() > before;
  }

  void look_again_where_it_leads_farther() {
    for (const std::uint32_t ball : cluster_.members()) {
      if (neighbours_.widen(ball)) find_candidates(ball);
    }
  }

  void find_candidates(std::uint32_t ball) {
    for (std::uint32_t plane = 0; plane < planes_.size(); ++plane) {
      const Place x = world().position[ball];
      if (!planes_[plane].faces(x)) continue;
      consider(cluster_.with_plane(ball, plane), planes_[plane].gap(x, world().radius[ball]));
    }
    for (const std::uint32_t other : cluster_.near_sorted(ball)) {
      if (!met_.insert(contact_key(ball, other, false)).second) continue;
      const Place x = flights_.motion_at(other, time_s_).x;
      consider(cluster_.between(ball, other, x), cluster_.gap_between(ball, other, x));
    }
  }

  void consider(Kept contact, double gap) {
    if (contact.wall && !met_.insert(contact_key(contact.a, contact.b, true)).second) return;
    contact.least = gap > 0.0 ? -kCrowdShare * gap / (flights_.step_s() - time_s_) : 0.0;
    candidates_.push_back({contact, false});
  }

  void add_if_it_closes_or_lets_go(std::size_t number) {
    if (candidates_[number].taken) return;
    Kept contact = candidates_[number].contact;
    const double u_n = contact.normal.dot(velocity_of_b(contact) - world().velocity[contact.a]) *
                       (contact.wall ? -1.0 : 1.0);
    const double rounding = cluster_.rule().rounding();
    const bool closes = u_n < contact.least - rounding || is_seed(contact);
    const double still = rounding + 2.0 * cluster_.rule().crowd_tolerance() - kOpening * contact.least;
    if (!closes && u_n <= contact.least + still) return;
    take_over_what_is_not_spent(contact);
    if (!closes && contact.push == 0.0) return;
    candidates_[number].taken = true;
    solver_.contacts().push_back(contact);
    acted_.push_back(impulse_of(contact));
    impact_ = impact_ || u_n < contact.least - flights_.field_speed() - rounding;
    if (!contact.wall && !cluster_.has(contact.b) && cluster_.join(contact.b, time_s_)) enter(contact.b);
  }

  void take_over_what_is_not_spent(Kept& contact) const {
    if (bearing_.empty()) return;
    const auto found = bearing_.find(contact_key(contact.a, contact.b, contact.wall));
    if (found == bearing_.end()) return;
    const double share = (flights_.step_s() - time_s_) / (flights_.step_s() - found->second.time_s);
    const Place unspent = (share * side_of(contact)) * found->second.impulse;
    contact.push = std::max(0.0, contact.normal.dot(unspent));
    if constexpr (kFriction) {
      contact.drag = unspent - contact.normal.dot(unspent) * contact.normal;
      const double most = contact.friction * contact.push;
      if (const double size = contact.drag.norm(); size > most) contact.drag *= most / size;
    }
  }

  /// Which of a contact's balls is a, and which b, is as it was met: -1 where b has the lower number.
  double side_of(const Kept& contact) const {
    return contact.wall || world().before(contact.a, contact.b) ? 1.0 : -1.0;
  }

  static Place impulse_of(const Kept& contact) { return contact.push * contact.normal + contact.drag; }

  /// At the end of the step; of a plane none.
  Place velocity_of_b(const Kept& contact) const {
    if (contact.wall) return Place::Zero();
    if (cluster_.has(contact.b)) return world().velocity[contact.b];
    return flights_.motion_at(contact.b, flights_.step_s()).v;
  }

  /// What set the crowd off is in it, however slowly it closes: else it would be met again at once.
  bool is_seed(const Kept& contact) const {
    return contact_key(contact.a, contact.b, contact.wall) == contact_key(seed_.a, seed_.b, seed_.wall);
  }

  /// From now on the ball has the velocity that it would have when the step ends, and with it those that lean
  /// on it: what bears them has changed.
  void enter(std::uint32_t ball) {
    if (has(ball)) return;
    crowd_[ball] = steps_;
    entering_.assign(1, ball);
    for (std::size_t next = 0; !held_.empty() && next < entering_.size(); ++next) {
      neighbours_.find_near(entering_[next], leaning_);
      std::sort(leaning_.begin(), leaning_.end(),
                [this](std::uint32_t a, std::uint32_t b) { return world().before(a, b); });
      for (const std::uint32_t other : leaning_) {
        if (has(other) || !held_.has(entering_[next], other, false) || !cluster_.join(other, time_s_))
          continue;
        crowd_[other] = steps_;
        entering_.push_back(other);
      }
    }
    for (const std::uint32_t member : entering_) {
      flights_.begin_flight(member);
      if constexpr (kAccelerates) {
        World<Dim>& world = flights_.world();
        const Place gained = flights_.left_s(member) * flights_.acceleration(member);
        world.velocity.set(member, world.velocity[member] + gained);
      }
    }
  }

  Balls& flights_;
  Neighbours<Dim, Balls>& neighbours_;
  const std::vector<Plane<Dim>>& planes_;
  const HeldContacts<Balls>& held_;
  Cluster<Dim, Balls>& cluster_;
  Solver& solver_;
  ContactSeed seed_{};
  double time_s_ = 0.0;
  std::vector<Place> acted_;  ///< N s, of each of the solver's contacts: what it began with
  std::unordered_map<std::uint64_t, Bearing> bearing_;  ///< in this step
  std::vector<Candidate> candidates_;
  std::unordered_set<std::uint64_t> met_;  ///< what candidates_ has
  std::size_t looked_at_ = 0;              ///< members whose candidates have been found
  std::vector<std::uint32_t> entering_;
  std::vector<std::uint32_t> leaning_;
  /// The last step in which a ball was in a crowd; empty before the first.
  std::vector<std::uint64_t> crowd_;
  std::uint64_t steps_ = 0;
  bool impact_ = false;
  double energy_change_J_ = 0.0;
  std::size_t entered_ = 0;  ///< members whose energy before the impact is in energy_change_J_
};

}  // namespace carom
