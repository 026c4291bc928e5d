#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "carom/evolvers/contact_solver.h"
#include "carom/evolvers/held_contacts.h"
#include "carom/evolvers/neighbours.h"
#include "carom/evolvers/rest_rule.h"
#include "carom/laws/cluster_law.h"
#include "carom/plane.h"

namespace carom {

/// Two balls at one point have no normal; any fixed one keeps the laws.
template <int Dim>
Vec<Dim> normal_between(const Vec<Dim>& a, const Vec<Dim>& b) {
  const Vec<Dim> between = b - a;
  return between.isZero(0.0) ? Vec<Dim>(Vec<Dim>::UnitX()) : Vec<Dim>(between.normalized());
}

/// Friction of ball against ball and against walls, μ.
struct Frictions {
  double ball;
  double wall;
};

/// The movable balls that hang together at a moment of the step, and which contacts they hang together by.
/// `Balls` are Flights (flights.h).
template <int Dim, class Balls>
class Cluster {
 public:
  using Place = Vec<Dim>;
  using Kept = KeptContact<Dim>;

  Cluster(Balls& flights, Neighbours<Dim, Balls>& neighbours, const std::vector<Plane<Dim>>& planes,
          const HeldContacts<Balls>& held, Frictions frictions)
      : flights_(flights),
        neighbours_(neighbours),
        planes_(planes),
        held_(held),
        frictions_(frictions),
        rule_(flights),
        number_(flights.size(), 0) {}

  const std::vector<std::uint32_t>& members() const { return members_; }
  bool has(std::uint32_t ball) const {
    return number_[ball] < members_.size() && members_[number_[ball]] == ball;
  }
  const RestRule<Dim, Balls>& rule() const { return rule_; }

  void begin() {
    members_.clear();
    rule_.begin_cluster();
  }

  /// Moves the ball to the time and makes it a member. Returns false for an immovable ball, which is none.
  bool join(std::uint32_t ball, double time_s) {
    if (is_immovable(ball)) return false;
    if (has(ball)) return true;
    flights_.fly_to(ball, time_s);
    append(ball);
    rule_.take_in(ball);
    return true;
  }

  void join(const ContactSeed& seed, double time_s) {
    join(seed.a, time_s);
    if (!seed.wall) join(seed.b, time_s);
  }

  /// A ball that was just hit is a member as it is.
  void take_in_hit(std::uint32_t ball) {
    // An immovable ball flies on as it did, and what lies on it lies on.
    if (has(ball) || is_immovable(ball)) return;
    append(ball);
  }

  /// With the members all balls that lean on them, over held contacts.
  void join_leaning(double time_s) {
    for (std::size_t next = 0; !held_.empty() && next < members_.size(); ++next) {
      neighbours_.find_near(members_[next], near_);
      for (const std::uint32_t other : near_) {
        if (held_.has(members_[next], other, false)) join(other, time_s);
      }
    }
  }

  /// Floods from the balls of the seed through all closed contacts; moves the balls it meets to the seed's
  /// time.
  void gather(const ContactSeed& seed, double time_s, std::vector<Kept>& contacts) {
    begin();
    contacts.clear();
    join(seed, time_s);
    for (std::size_t next = 0; next < members_.size(); ++next) {
      const std::uint32_t ball = members_[next];
      const Place x = world().position[ball];
      for (std::uint32_t plane = 0; plane < planes_.size(); ++plane) {
        if (!planes_[plane].faces(x)) continue;
        const bool is_seed = seed.wall && ball == seed.a && plane == seed.b;
        const double v_n = planes_[plane].normal.dot(world().velocity[ball]);
        if (is_seed || held_.has(ball, plane, true) ||
            rule_.closed(planes_[plane].gap(x, world().radius[ball]), v_n, x)) {
          contacts.push_back(with_plane(ball, plane));
        }
      }
      for (const std::uint32_t other : near_sorted(ball)) gather_pair(next, other, seed, time_s, contacts);
    }
  }

  /// The contacts that hang together with the seed's and are closed at its moment, whatever their velocities.
  /// By (ball, wall, other).
  void gather_touching(const ContactSeed& seed, double time_s, std::vector<ClosedContact<Dim>>& contacts) {
    begin();
    contacts.clear();
    join(seed, time_s);
    for (std::size_t next = 0; next < members_.size(); ++next) {
      const std::uint32_t ball = members_[next];
      const Place x = world().position[ball];
      for (std::uint32_t plane = 0; plane < planes_.size(); ++plane) {
        const bool is_seed = seed.wall && ball == seed.a && plane == seed.b;
        if (!planes_[plane].faces(x)) continue;
        if (is_seed || planes_[plane].gap(x, world().radius[ball]) <= touch_rounding(x)) {
          contacts.push_back({ball, plane, true, planes_[plane].normal, 1.0});
        }
      }
      for (const std::uint32_t other : near_sorted(ball)) {
        gather_touching_pair(next, other, seed, time_s, contacts);
      }
    }
    const auto rank = [this](const ClosedContact<Dim>& contact) {
      const std::uint32_t b = contact.wall ? contact.b : world().number_of(contact.b);
      return std::tuple(world().number_of(contact.a), contact.wall, b);
    };
    std::sort(contacts.begin(), contacts.end(),
              [&](const auto& x, const auto& y) { return rank(x) < rank(y); });
  }

  /// By their numbers: the order of a broad phase is its own, and that of the contacts decides the last bits.
  const std::vector<std::uint32_t>& near_sorted(std::uint32_t ball) {
    neighbours_.find_near(ball, near_);
    std::sort(near_.begin(), near_.end(),
              [this](std::uint32_t a, std::uint32_t b) { return world().before(a, b); });
    return near_;
  }

  Kept with_plane(std::uint32_t ball, std::uint32_t plane) const {
    // The face of a barrier is smooth.
    const double friction = planes_[plane].barrier == kSolid ? frictions_.wall : 0.0;
    return {ball, plane, true, planes_[plane].normal, friction};
  }

  /// @param x  where b is then
  Kept between(std::uint32_t a, std::uint32_t b, const Place& x) const {
    return {a, b, false, normal_between<Dim>(world().position[a], x), frictions_.ball};
  }

  double gap_between(std::uint32_t a, std::uint32_t b, const Place& x) const {
    return (x - world().position[a]).norm() - world().radius[a] - world().radius[b];
  }

 private:
  const World<Dim>& world() const { return flights_.world(); }
  bool is_immovable(std::uint32_t ball) const { return world().inverse_mass[ball] == 0.0; }

  void append(std::uint32_t ball) {
    number_[ball] = static_cast<std::uint32_t>(members_.size());
    members_.push_back(ball);
  }

  /// Adds the contact of a member with another ball, if it is closed and was not met from the other side
  /// before.
  void gather_pair(std::size_t member, std::uint32_t other, const ContactSeed& seed, double time_s,
                   std::vector<Kept>& contacts) {
    const std::uint32_t ball = members_[member];
    if (met_before(member, other)) return;
    const Motion<Dim> then = flights_.motion_at(other, time_s);
    const Kept contact = between(ball, other, then.x);
    const bool is_seed = !seed.wall && std::minmax(ball, other) == std::minmax(seed.a, seed.b);
    const double v_n = contact.normal.dot(then.v - world().velocity[ball]);
    if (!is_seed && !held_.has(ball, other, false) &&
        !rule_.closed(gap_between(ball, other, then.x), v_n, then.x)) {
      return;
    }
    if (!join(other, time_s)) flights_.fly_to(other, time_s);
    contacts.push_back(contact);
  }

  void gather_touching_pair(std::size_t member, std::uint32_t other, const ContactSeed& seed, double time_s,
                            std::vector<ClosedContact<Dim>>& contacts) {
    const std::uint32_t ball = members_[member];
    if (met_before(member, other)) return;
    const Place x = flights_.motion_at(other, time_s).x;
    const bool is_seed = !seed.wall && std::minmax(ball, other) == std::minmax(seed.a, seed.b);
    if (!is_seed && gap_between(ball, other, x) > touch_rounding(x)) return;
    if (!join(other, time_s)) flights_.fly_to(other, time_s);
    const bool first = world().before(ball, other);
    const std::uint32_t a = first ? ball : other;
    const std::uint32_t b = first ? other : ball;
    contacts.push_back({a, b, false, normal_between<Dim>(world().position[a], world().position[b]), 1.0});
  }

  /// A gap below this, m, is rounding: of the coordinates, and of the times at which they were computed.
  static double touch_rounding(const Place& x) { return 64.0 * kEpsilon * x.cwiseAbs().maxCoeff(); }

  /// Whether the other is a member that stands before this one.
  bool met_before(std::size_t member, std::uint32_t other) const {
    return has(other) && number_[other] < member;
  }

  Balls& flights_;
  Neighbours<Dim, Balls>& neighbours_;
  const std::vector<Plane<Dim>>& planes_;
  const HeldContacts<Balls>& held_;
  Frictions frictions_;
  RestRule<Dim, Balls> rule_;
  std::vector<std::uint32_t> members_;
  std::vector<std::uint32_t> near_;
  /// Of a member, its number among the members; of another, any: it is not the one there.
  Column<std::uint32_t> number_;
};

}  // namespace carom
