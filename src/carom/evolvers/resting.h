#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "carom/evolvers/contact_solver.h"
#include "carom/evolvers/flights.h"
#include "carom/evolvers/neighbours.h"
#include "carom/laws/cluster_law.h"
#include "carom/plane.h"
#include "carom/time_of_impact.h"

namespace carom {

/// Two balls at one point have no normal; any fixed one keeps the laws.
template <int Dim>
Vec<Dim> normal_between(const Vec<Dim>& a, const Vec<Dim>& b) {
  const Vec<Dim> between = b - a;
  return between.isZero(0.0) ? Vec<Dim>(Vec<Dim>::UnitX()) : Vec<Dim>(between.normalized());
}

/// Contact becomes rest.
///
/// With e < 1 balls would collide infinitely often in finite time. A contact ends in rest instead where its
/// rebound would be over within kRestShare of the step (2 v_n'/|a_n|), or where there is no rebound. With it
/// rest the contacts around that are as slow: settle() takes out their closing velocities and accelerations
/// together, and they stay closed until the step ends or one of the balls is hit. What is lost with a rebound
/// left out is at most ½ m v_n'² = ⅛ m (kRestShare a_n h)². Elastic balls come to rest only from rebounds a
/// thousand times shorter (kElasticRestShare).
///
/// Friction in contacts that stay closed slides, Coulomb's μ N against the slip, until the slip ends, and
/// then holds. The moment at which a slip ends is part of the step like an impact (grips()).
///
/// Where balls still chatter after as many flights in a step as kMostFlights, the rest of the step is taken
/// in one piece: join_crowd() gives all balls that would meet until then one common inelastic impact, so that
/// no gap closes below zero (J. J. Moreau's time stepping, of first order), and whatever hits the crowd later
/// in the step joins it. That ends piles that form, and inelastic collapse.
template <int Dim, bool kAccelerates, bool kFriction>
class Resting {
 public:
  using Balls = Flights<Dim, kAccelerates, kFriction>;
  using Kept = KeptContact<Dim>;
  using Place = Vec<Dim>;

  /// A contact as it is met: ball a and ball b, or ball a and plane b.
  struct Seed {
    std::uint32_t a;
    std::uint32_t b;
    bool wall;
  };

  /// A moment at which a contact's slip ends, s from the start of the step.
  struct Grip {
    Seed contact;
    double time_s;
  };

  Resting(const Scenario& scene, Balls& flights, Neighbours<Dim, Balls>& neighbours,
          const std::vector<Plane<Dim>>& planes)
      : flights_(flights),
        neighbours_(neighbours),
        planes_(planes),
        friction_(scene.ball_contact.friction),
        wall_friction_(scene.wall_contact.friction),
        mark_(flights.size(), 0) {}

  void begin_step() {
    ++steps_;
    held_.clear();
    known_.swap(learned_);
    learned_.clear();
  }

  /// Whether a contact with this normal velocity and acceleration (both negative when closing) stays closed.
  /// @param place_m  the size of the balls' coordinates
  bool comes_to_rest(double v_n, double a_n, double restitution, double speeds, double place_m) const {
    const double rounding = velocity_rounding(speeds + flights_.field_speed());
    const double step_s = flights_.step_s();
    if (restitution < 1.0 && -v_n <= unseen(place_m)) return true;
    if (a_n * step_s >= -rounding) return false;
    // A rough impact without rebound still has a law for what it does along the surface.
    if (kFriction && -v_n > flights_.field_speed() + rounding) return false;
    const double rebound = std::max(-v_n - rounding, 0.0) * restitution;
    const double share = restitution < 1.0 ? kRestShare : kElasticRestShare;
    return rebound == 0.0 || 2.0 * rebound < share * step_s * -a_n;
  }

  /// Closes the contact, and with it those around it that are as good as closed, for the rest of the step.
  /// The balls in it, members(), have new flights.
  void settle(const Seed& seed, double time_s) {
    gather(seed, time_s);
    if (std::any_of(members_.begin(), members_.end(), [this](auto ball) { return in_crowd(ball); })) {
      join_crowd(seed, time_s);
      return;
    }
    solve_velocities();
    // What opens does not push any more.
    std::erase_if(solver_.contacts(), [this](const Kept& contact) {
      return Solver::opening(contact, flights_.world().velocity) > still();
    });
    for (const std::uint32_t ball : members_) flights_.begin_flight(ball);
    if constexpr (kAccelerates) {
      if (!solve_accelerations()) {
        // Velocities always have a solution.
        for (const std::uint32_t ball : members_) flights_.begin_flight(ball);
        join_crowd(seed, time_s);
        return;
      }
    }
    for (const Kept& contact : solver_.contacts()) {
      if (stays_closed(contact)) hold(contact.a, contact.b, contact.wall);
    }
    find_grips();
  }

  /// Takes the rest of the step in one piece for all balls that would meet until then: they are members(),
  /// and fly straight on.
  void join_crowd(const Seed& seed, double time_s) {
    begin_gathering();
    met_in_crowd_.clear();
    impact_ = false;
    crowd_.resize(flights_.size(), 0);
    join(seed.a, time_s);
    if (!seed.wall) join(seed.b, time_s);
    World<Dim>& world = flights_.world();
    const auto response = [this](std::uint32_t ball) { return inverse_mass(ball); };
    for (std::size_t next = 0; next < members_.size(); ++next) enter_crowd(members_[next], time_s);
    for (int round = 0; round < kMostRounds && add_crowd_contacts(seed, time_s); ++round) {
      solver_.solve(world, world.velocity, world.spin, response, crowd_tolerance());
      for (const std::uint32_t ball : members_) neighbours_.widen(ball);
    }
    if (impact_) ++flights_.account().tally.impacts;
    for (const std::uint32_t ball : members_) flights_.coast(ball);
    for (const Kept& contact : solver_.contacts()) {
      book(contact);
      hold(contact.a, contact.b, contact.wall);
    }
  }

  /// Whether a crowd has taken the ball in, in this step.
  bool in_crowd(std::size_t ball) const { return !crowd_.empty() && crowd_[ball] == steps_; }

  /// The contacts that hang together with the seed's and are closed at its moment, whatever their velocities;
  /// their balls are members() then. By (ball, wall, other).
  void gather_touching(const Seed& seed, double time_s, std::vector<ClosedContact<Dim>>& contacts) {
    contacts.clear();
    begin_gathering();
    join(seed.a, time_s);
    if (!seed.wall) join(seed.b, time_s);
    for (std::size_t next = 0; next < members_.size(); ++next) {
      const std::uint32_t ball = members_[next];
      for (std::uint32_t plane = 0; plane < planes_.size(); ++plane) {
        const Place x = world().position[ball];
        const bool is_seed = seed.wall && ball == seed.a && plane == seed.b;
        if (!planes_[plane].faces(x)) continue;
        if (is_seed || planes_[plane].gap(x, world().radius[ball]) <= touch_rounding(x)) {
          contacts.push_back({ball, plane, true, planes_[plane].normal, 1.0});
        }
      }
      find_near_sorted(ball);
      for (const std::uint32_t other : near_) gather_touching_pair(next, other, seed, time_s, contacts);
    }
    std::sort(contacts.begin(), contacts.end(), [](const auto& x, const auto& y) {
      return std::tie(x.a, x.wall, x.b) < std::tie(y.a, y.wall, y.b);
    });
  }

  /// The balls that lean on those that were hit, and these themselves, get new flights: what bears them has
  /// changed. They are members() then.
  void begin_flights_around(std::span<const std::uint32_t> hit) {
    begin_gathering();
    for (const std::uint32_t ball : hit) {
      // An immovable ball flies on as it did, and what lies on it lies on.
      if (mark_[ball] == marks_ || inverse_mass(ball) == 0.0) continue;
      mark_[ball] = marks_;
      members_.push_back(ball);
    }
    const double time_s = flights_.clock(members_.front());
    for (std::size_t next = 0; !held_.empty() && next < members_.size(); ++next) {
      neighbours_.find_near(members_[next], near_);
      for (const std::uint32_t other : near_) {
        if (is_held(members_[next], other, false)) join(other, time_s);
      }
    }
    for (const std::uint32_t ball : members_) flights_.begin_flight(ball);
  }

  const std::vector<std::uint32_t>& members() const { return members_; }
  const std::vector<Grip>& grips() const { return grips_; }

  /// A held contact is not met again while neither ball begins a new flight.
  bool is_held(std::size_t a, std::size_t b, bool wall) const {
    if (held_.empty()) return false;
    const auto found = held_.find(key(a, b, wall));
    return found != held_.end() && found->second == stamps(a, b, wall);
  }

  static Settings settings() {
    return {{"rest_share_of_step", kRestShare},
            {"elastic_rest_share_of_step", kElasticRestShare},
            {"most_flights_in_step", static_cast<double>(kMostFlights)}};
  }

  /// Flights of a ball within a step after which what comes to rest does so in a crowd. A ball that comes to
  /// rest on the floor begins two or three, one in a corner some more.
  static constexpr std::uint32_t kMostFlights = 6;

 private:
  /// Of the step: a rebound that is over sooner is left out. A drop under g loses at most g (kRestShare h)²/8
  /// of height by it, 2e-11 m at h = 1/240 s.
  static constexpr double kRestShare = 1e-3;
  /// The same for e = 1, where every loss counts: at h = 1/240 s a rebound of 2e-17 m, below the rounding of
  /// heights.
  static constexpr double kElasticRestShare = 1e-6;
  /// Of what the fields give: what statics may leave.
  static constexpr double kStaticsShare = 1e-14;
  /// The same of a crowd: at h = 1/240 s a closing speed of 4e-12 m/s, an overlap of 2e-14 m.
  static constexpr double kCrowdLeaves = 1e-10;
  /// Of a gap: how far a crowd may close it. Gaps closed to the last bit would be met again by rounding.
  static constexpr double kCrowdShare = 1.0 - 1e-6;
  /// Rounds in which a crowd takes in balls that it pushes against others. One ring of a pile is one round.
  static constexpr int kMostRounds = 64;

  const World<Dim>& world() const { return flights_.world(); }

  /// What moves a ball in a step by less than its place is rounded, m/s. Balls that have lost all but this in
  /// a collapse would go on losing it forever.
  double unseen(double place_m) const { return kEpsilon * place_m / flights_.step_s(); }

  /// How slowly balls close whose rebound is left out, m/s.
  double slow() const { return kRestShare * flights_.field_speed() + unseen(place_m_); }

  /// How slowly a contact that is held may open, m/s: what the sweeps leave of a large pile is not worth
  /// another impact.
  double still() const { return std::max(rounding_, kRestShare * slow()); }

  // --- which contacts

  void begin_gathering() {
    solver_.clear();
    members_.clear();
    grips_.clear();
    ++marks_;
    rounding_ = velocity_rounding(flights_.field_speed());
    place_m_ = 0.0;
  }

  /// Floods from the balls of the seed through all closed contacts; moves the balls it meets to the seed's
  /// time.
  void gather(const Seed& seed, double time_s) {
    begin_gathering();
    join(seed.a, time_s);
    if (!seed.wall) join(seed.b, time_s);
    for (std::size_t next = 0; next < members_.size(); ++next) {
      const std::uint32_t ball = members_[next];
      for (std::uint32_t plane = 0; plane < planes_.size(); ++plane) {
        if (!planes_[plane].faces(world().position[ball])) continue;
        const bool is_seed = seed.wall && ball == seed.a && plane == seed.b;
        const Vec<Dim>& normal = planes_[plane].normal;
        const double gap = planes_[plane].gap(world().position[ball], world().radius[ball]);
        const double v_n = normal.dot(world().velocity[ball]);
        if (is_seed || is_held(ball, plane, true) || closed(gap, v_n, world().position[ball])) {
          solver_.add({ball, plane, true, normal, friction_of(planes_[plane])});
        }
      }
      find_near_sorted(ball);
      for (const std::uint32_t other : near_) gather_pair(next, other, seed, time_s);
    }
  }

  /// Adds the contact of a member with another ball, if it is closed and was not met from the other side
  /// before.
  void gather_pair(std::size_t member, std::uint32_t other, const Seed& seed, double time_s) {
    const std::uint32_t ball = members_[member];
    if (met_before(member, other)) return;
    const Motion<Dim> then = flights_.motion_at(other, time_s);
    const Vec<Dim> normal = normal_between<Dim>(world().position[ball], then.x);
    const double gap =
        (then.x - world().position[ball]).norm() - world().radius[ball] - world().radius[other];
    const bool is_seed = !seed.wall && std::minmax(ball, other) == std::minmax(seed.a, seed.b);
    const double v_n = normal.dot(then.v - world().velocity[ball]);
    if (!is_seed && !is_held(ball, other, false) && !closed(gap, v_n, then.x)) return;
    if (!join(other, time_s)) flights_.fly_to(other, time_s);
    solver_.add({ball, other, false, normal, friction_});
  }

  void gather_touching_pair(std::size_t member, std::uint32_t other, const Seed& seed, double time_s,
                            std::vector<ClosedContact<Dim>>& contacts) {
    const std::uint32_t ball = members_[member];
    if (met_before(member, other)) return;
    const Place x = flights_.motion_at(other, time_s).x;
    const double gap = (x - world().position[ball]).norm() - world().radius[ball] - world().radius[other];
    const bool is_seed = !seed.wall && std::minmax(ball, other) == std::minmax(seed.a, seed.b);
    if (!is_seed && gap > touch_rounding(x)) return;
    if (!join(other, time_s)) flights_.fly_to(other, time_s);
    const auto [a, b] = std::minmax(ball, other);
    contacts.push_back({a, b, false, normal_between<Dim>(world().position[a], world().position[b]), 1.0});
  }

  /// A gap below this, m, is rounding: of the coordinates, and of the times at which they were computed.
  static double touch_rounding(const Place& x) { return 64.0 * kEpsilon * x.cwiseAbs().maxCoeff(); }

  /// The face of a barrier is smooth.
  double friction_of(const Plane<Dim>& plane) const { return plane.barrier == kSolid ? wall_friction_ : 0.0; }

  /// The order of a broad phase is its own; the order of the contacts decides the last bits.
  void find_near_sorted(std::uint32_t ball) {
    neighbours_.find_near(ball, near_);
    std::sort(near_.begin(), near_.end());
  }

  bool met_before(std::size_t member, std::uint32_t other) const {
    const auto before = members_.begin() + static_cast<std::ptrdiff_t>(member);
    return mark_[other] == marks_ && std::find(members_.begin(), before, other) != before;
  }

  /// Returns false for an immovable ball, which is no member.
  bool join(std::uint32_t ball, double time_s) {
    if (world().inverse_mass[ball] == 0.0) return false;
    if (mark_[ball] == marks_) return true;
    mark_[ball] = marks_;
    flights_.fly_to(ball, time_s);
    members_.push_back(ball);
    const double speed = world().velocity[ball].norm();
    place_m_ = std::max(place_m_, world().position[ball].cwiseAbs().maxCoeff());
    rounding_ = std::max(rounding_, velocity_rounding(2.0 * speed + flights_.field_speed()));
    return true;
  }

  /// As good as closed: the gap is one that a rebound left out could have, and the balls close as slowly, if
  /// at all.
  bool closed(double gap, double v_n, const Vec<Dim>& place) const {
    const double rounding = 16.0 * kEpsilon * place.cwiseAbs().maxCoeff();
    if (gap > kRestShare * slow() * flights_.step_s() + rounding || v_n > still()) return false;
    return v_n >= -slow() - rounding_;
  }

  // --- impact and statics of what is closed

  /// How much of a closing velocity may be left, m/s: rounding, or as little of what the fields give in a
  /// step as leaves a step's overlap, tolerance × h, below the rounding of places.
  double tolerance() const {
    return std::max({rounding_, kStaticsShare * flights_.field_speed(), kRestShare * unseen(place_m_)});
  }

  /// The same for a crowd, which is of first order anyway.
  double crowd_tolerance() const { return std::max(tolerance(), kCrowdLeaves * flights_.field_speed()); }

  double inverse_mass(std::uint32_t ball) const { return world().inverse_mass[ball]; }

  void solve_velocities() {
    World<Dim>& world = flights_.world();
    const auto response = [this](std::uint32_t ball) { return inverse_mass(ball); };
    bool impact = false;
    for (const Kept& contact : solver_.contacts()) {
      impact = impact || Solver::opening(contact, world.velocity) < -slow() - rounding_;
    }
    if (impact) ++flights_.account().tally.impacts;
    solver_.solve(world, world.velocity, world.spin, response, tolerance());
    for (const Kept& contact : solver_.contacts()) book(contact);
  }

  void book(const Kept& contact) {
    const std::optional<double> sign = external(contact);
    if (!sign) return;
    const Vec<Dim> impulse = *sign * (contact.push * contact.normal + contact.drag);
    flights_.account().book(world().position[contact.a] + arm_of(contact), impulse);
  }

  /// Statics for the rest of the step, or until a slip ends. Returns false where there is none.
  bool solve_accelerations() {
    const World<Dim>& world = flights_.world();
    const auto response = [this](std::uint32_t ball) { return flights_.response(ball); };
    for (Kept& contact : solver_.contacts()) {
      contact.push = known_push(key(contact.a, contact.b, contact.wall));
      contact.drag.setZero();
      if constexpr (kFriction) {
        contact.slip = sliding_direction(contact);
        contact.drag = -(contact.friction * contact.push) * contact.slip;
      }
    }
    solver_.start(world, flights_.accelerations(), flights_.spin_accelerations(), response);
    if (!solver_.solve(world, flights_.accelerations(), flights_.spin_accelerations(), response,
                       tolerance() / flights_.step_s())) {
      return false;
    }
    for (const Kept& contact : solver_.contacts()) {
      learned_[key(contact.a, contact.b, contact.wall)] = contact.push;
      const std::optional<double> sign = external(contact);
      if (!sign) continue;
      flights_.bear(contact.a, *sign * (contact.push * contact.normal + contact.drag), arm_of(contact));
    }
    return true;
  }

  double known_push(std::uint64_t contact) const {
    if (const auto found = learned_.find(contact); found != learned_.end()) return found->second;
    const auto found = known_.find(contact);
    return found == known_.end() ? 0.0 : found->second;
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
    if (Solver::opening(contact, flights_.world().velocity) > still()) return false;
    if constexpr (kAccelerates) {
      return Solver::opening(contact, flights_.accelerations()) * flights_.step_s() <= still();
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

  // --- a crowd

  /// Adds the contacts of members that the rest of the step would close below zero. Returns whether there
  /// were any.
  bool add_crowd_contacts(const Seed& seed, double time_s) {
    bool added = false;
    for (std::size_t next = 0; next < members_.size(); ++next) {
      const std::uint32_t ball = members_[next];
      for (std::uint32_t plane = 0; plane < planes_.size(); ++plane) {
        if (!planes_[plane].faces(world().position[ball])) continue;
        const double gap = planes_[plane].gap(world().position[ball], world().radius[ball]);
        const Kept contact = {ball, plane, true, planes_[plane].normal, friction_of(planes_[plane])};
        added = add_to_crowd(seed, contact, gap, contact.normal.dot(world().velocity[ball]), time_s) || added;
      }
      find_near_sorted(ball);
      for (const std::uint32_t other : near_) added = add_crowd_pair(seed, ball, other, time_s) || added;
    }
    return added;
  }

  bool add_crowd_pair(const Seed& seed, std::uint32_t ball, std::uint32_t other, double time_s) {
    const Vec<Dim> x = flights_.motion_at(other, time_s).x;
    const bool entered = mark_[other] == marks_;
    const Vec<Dim> end = entered ? world().velocity[other] : flights_.motion_at(other, flights_.step_s()).v;
    const Kept contact = {ball, other, false, normal_between<Dim>(world().position[ball], x), friction_};
    const double gap = (x - world().position[ball]).norm() - world().radius[ball] - world().radius[other];
    if (!add_to_crowd(seed, contact, gap, contact.normal.dot(end - world().velocity[ball]), time_s))
      return false;
    if (!entered && join(other, time_s)) enter_crowd(other, time_s);
    return true;
  }

  bool add_to_crowd(const Seed& seed, Kept contact, double gap, double u_n, double time_s) {
    contact.least = gap > 0.0 ? -kCrowdShare * gap / (flights_.step_s() - time_s) : 0.0;
    // What set the crowd off is in it, however slowly it closes: else it would be met again at once.
    const std::uint64_t name = key(contact.a, contact.b, contact.wall);
    if (u_n >= contact.least - rounding_ && name != key(seed.a, seed.b, seed.wall)) return false;
    if (!met_in_crowd_.insert(name).second) return false;
    solver_.add(contact);
    impact_ = impact_ || u_n < contact.least - flights_.field_speed() - rounding_;
    return true;
  }

  /// From now on the ball has the velocity that it would have when the step ends, and with it those that lean
  /// on it: what bears them has changed.
  void enter_crowd(std::uint32_t ball, double time_s) {
    if (in_crowd(ball)) return;
    crowd_[ball] = steps_;
    entering_.assign(1, ball);
    for (std::size_t next = 0; !held_.empty() && next < entering_.size(); ++next) {
      neighbours_.find_near(entering_[next], leaning_);
      std::sort(leaning_.begin(), leaning_.end());
      for (const std::uint32_t other : leaning_) {
        if (in_crowd(other) || !is_held(entering_[next], other, false) || !join(other, time_s)) continue;
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

  // --- what is held

  static std::uint64_t key(std::size_t a, std::size_t b, bool wall) {
    if (!wall && b < a) std::swap(a, b);
    return (static_cast<std::uint64_t>(a) << 32U) | (static_cast<std::uint64_t>(b) << 1U) | (wall ? 1U : 0U);
  }

  std::pair<std::uint32_t, std::uint32_t> stamps(std::size_t a, std::size_t b, bool wall) const {
    if (wall) return {flights_.stamp(a), 0};
    return {flights_.stamp(std::min(a, b)), flights_.stamp(std::max(a, b))};
  }

  void hold(std::size_t a, std::size_t b, bool wall) { held_[key(a, b, wall)] = stamps(a, b, wall); }

  using Solver = ContactSolver<Dim, kFriction>;

  Balls& flights_;
  Neighbours<Dim, Balls>& neighbours_;
  const std::vector<Plane<Dim>>& planes_;
  double friction_;
  double wall_friction_;
  Solver solver_;
  std::vector<std::uint32_t> members_;  ///< movable balls of the cluster at hand
  std::vector<std::uint32_t> near_;
  std::vector<std::uint32_t> entering_;
  std::vector<std::uint32_t> leaning_;
  std::vector<Grip> grips_;
  std::unordered_set<std::uint64_t> met_in_crowd_;
  std::vector<std::uint64_t>
      crowd_;  ///< the last step in which a ball was in a crowd; empty before the first
  std::uint64_t steps_ = 0;
  bool impact_ = false;    ///< whether the crowd at hand began with more than what fields give in a step
  double rounding_ = 0.0;  ///< m/s, of the members' velocities
  double place_m_ = 0.0;   ///< the largest coordinate of a member
  std::vector<std::uint32_t> mark_;  ///< the last cluster that a ball was in
  std::uint32_t marks_ = 0;
  std::unordered_map<std::uint64_t, std::pair<std::uint32_t, std::uint32_t>> held_;  ///< contact -> stamps
  /// Pushes, N, of the step before and of this one: where the sweeps start.
  std::unordered_map<std::uint64_t, double> known_;
  std::unordered_map<std::uint64_t, double> learned_;
};

}  // namespace carom
