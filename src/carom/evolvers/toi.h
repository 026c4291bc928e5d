#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <queue>
#include <stdexcept>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "carom/evolvers/resting_cluster.h"
#include "carom/flight.h"
#include "carom/time_of_impact.h"
#include "carom/world.h"
#include "engine/engine.h"

namespace carom {

/// The evolver `toi`: fixed steps, and within a step every impact at its time of impact and in order of time.
///
/// Flights are parabolas (FlightModel), so without drag a step of any length is exact but for rounding; drag
/// makes it second order. The result does not depend on the broad phase, bit for bit: contacts are carried
/// out in the order of (time, first ball, second ball or wall).
///
/// Resting. With e < 1 balls would collide infinitely often in finite time. A contact ends in rest instead
/// where its rebound would be over within kRestShare of the step (2 v_n'/|a_n|), where there is no rebound,
/// or where a ball has had so many impacts within the step that rounding is all that a chatter would leave of
/// its motion. With it rest the contacts around that are as slow: settle() takes out their closing velocities
/// and accelerations together, and they stay closed until the step ends or one of the balls is hit. What is
/// lost with a rebound left out is at most ½ m v_n'² = ⅛ m (kRestShare a_n h)². Elastic balls come to rest
/// only from rebounds a thousand times shorter (kElasticRestShare).
template <int Dim, template <int> class BroadPhase, class Law, class... Effects>
class ToiEvolver final : public Simulation {
 public:
  explicit ToiEvolver(const Scenario& scene, Effects... effects)
      : world_(scene.balls),
        model_(effects...),
        restitution_(scene.ball_contact.restitution),
        wall_restitution_(scene.wall_contact.restitution),
        most_flights_(most_flights(restitution_)),
        most_wall_flights_(most_flights(wall_restitution_)),
        start_(world_.size()),
        bound_(world_.size()),
        clock_(world_.size(), 0.0),
        stamp_(world_.size(), 0),
        mark_(world_.size(), 0) {
    for (const Wall& wall : scene.walls) walls_.push_back({flattened<Dim>(wall.normal), wall.offset});
    if constexpr (kAccelerates) {
      acceleration_ = VectorColumn<Dim>(world_.size());
      push_ = VectorColumn<Dim>(world_.size());
    }
  }

  void advance(double step_s, std::int64_t steps) override {
    for (std::int64_t k = 0; k < steps; ++k) step(step_s);
  }

  void snapshot(std::span<BallState> balls) const override { world_.snapshot(balls); }
  Tally tally() const override { return tally_; }

  Settings settings() const override {
    return {{"evolver", "toi"},
            {"law", std::string(Law::kName)},
            {"broad_phase", std::string(BroadPhase<Dim>::kName)},
            {"rest_share_of_step", kRestShare},
            {"elastic_rest_share_of_step", kElasticRestShare},
            {"chatter_share_of_fall", kChatterShare}};
  }

 private:
  static constexpr bool kAccelerates = FlightModel<Dim, Effects...>::kAccelerates;

  /// Of the step: a rebound that is over sooner is left out. A drop under g loses at most g (kRestShare h)²/8
  /// of height by it, 2e-11 m at h = 1/240 s.
  static constexpr double kRestShare = 1e-3;
  /// The same for e = 1, where every loss counts: at h = 1/240 s a rebound of 2e-17 m, below the rounding of
  /// heights.
  static constexpr double kElasticRestShare = 1e-6;
  /// Of the way ½ a h² that a step's fall closes: gaps that are held open around a ball that chatters, 8.5e-7
  /// m at h = 1/240 s. Below it each such gap would close at a moment of its own and set the others going
  /// again.
  static constexpr double kChatterShare = 0.01;

  /// Contacts resolved in a step after which something must be wrong: more than any count of elastic impacts
  /// asks for (Galperin's are 3.1 million at a mass ratio of 10¹²).
  static constexpr std::size_t kMostInAStep = 4'000'000;

  /// Impacts of a ball within a step after which its next contact rests: of a chatter with restitution e, e^k
  /// of the velocity is left, and that is below rounding for k = ln ε / ln e. Elastic balls lose nothing and
  /// never chatter.
  static std::uint32_t most_flights(double restitution) {
    constexpr double kAtLeast = 64.0;
    if (restitution == 1.0) return std::numeric_limits<std::uint32_t>::max();
    if (restitution == 0.0) return static_cast<std::uint32_t>(kAtLeast);
    return static_cast<std::uint32_t>(std::clamp(std::log(kEpsilon) / std::log(restitution), kAtLeast, 1e9));
  }

  struct Plane {
    Vec<Dim> normal;
    double offset;
  };

  /// An impact to come: ball a meets ball b, or wall b. It is stale once either ball has a later stamp.
  struct Contact {
    double time;  ///< s, from the start of the step
    std::uint32_t a;
    std::uint32_t b;
    bool wall;
    std::uint32_t stamp_a;
    std::uint32_t stamp_b;

    bool operator>(const Contact& other) const {
      return std::tie(time, a, wall, b) > std::tie(other.time, other.a, other.wall, other.b);
    }
  };

  void step(double step_s) {
    step_s_ = step_s;
    begin_flights();
    find_pairs();
    find_contacts();
    resolve_impacts();
    finish_flights();
  }

  void begin_flights() {
    start_ = world_.position;
    field_speed_ = 0.0;
    held_.clear();
    std::fill(stamp_.begin(), stamp_.end(), 0);
    for (std::size_t i = 0; i < world_.size(); ++i) {
      if constexpr (kAccelerates) {
        acceleration_.set(i, model_.acceleration(world_, i, world_.velocity[i], step_s_));
        field_speed_ = std::max(field_speed_, step_s_ * acceleration_[i].norm());
      }
      bound_[i] = world_.radius[i] + path_bound(i, step_s_);
    }
  }

  void find_pairs() {
    pairs_.clear();
    broad_phase_.build(start_, bound_);
    broad_phase_.for_each_pair([this](std::size_t i, std::size_t j) { pairs_.emplace_back(i, j); });
  }

  void find_contacts() {
    contacts_ = {};
    for (const auto& [i, j] : pairs_) expect_pair(i, j);
    for (std::size_t i = 0; i < world_.size(); ++i) expect_walls(i);
  }

  void resolve_impacts() {
    for (std::size_t resolved = 0; !contacts_.empty();) {
      const Contact next = contacts_.top();
      contacts_.pop();
      if (stale(next)) continue;
      if (++resolved > kMostInAStep) {
        throw std::runtime_error(
            fmt::format("more than {} impacts in one step, {} s into it, of balls {} and {}", kMostInAStep,
                        next.time, next.a, next.wall ? next.a : next.b));
      }
      if (next.wall) {
        resolve_wall(next);
      } else {
        resolve_pair(next);
      }
    }
  }

  void finish_flights() {
    for (std::size_t i = 0; i < world_.size(); ++i) {
      fly_to(i, step_s_);
      clock_[i] = 0.0;
      if constexpr (kAccelerates) push_.set(i, Vec<Dim>::Zero());
    }
  }

  // --- flights

  Motion<Dim> motion(std::size_t ball) const {
    if constexpr (kAccelerates) {
      return {world_.position[ball], world_.velocity[ball], acceleration_[ball]};
    } else {
      return {world_.position[ball], world_.velocity[ball], Vec<Dim>::Zero()};
    }
  }

  /// How far the ball can get in `duration_s`, m.
  double path_bound(std::size_t ball, double duration_s) const {
    double speed = world_.velocity[ball].norm();
    if constexpr (kAccelerates) speed += 0.5 * duration_s * acceleration_[ball].norm();
    return speed * duration_s;
  }

  /// Moves the ball along its flight to a time of the step, and books what bears it on the way.
  void fly_to(std::size_t ball, double time_s) {
    const double tau = time_s - clock_[ball];
    if constexpr (kAccelerates) {
      if (!push_[ball].isZero(0.0)) book_push(ball, tau);
      const Motion<Dim> then = motion(ball).after(tau);
      world_.position.set(ball, then.x);
      world_.velocity.set(ball, then.v);
    } else {
      world_.position.set(ball, world_.position[ball] + tau * world_.velocity[ball]);
    }
    clock_[ball] = time_s;
  }

  /// After an impact: a new flight from here to the end of the step.
  void begin_flight(std::size_t ball) {
    if constexpr (kAccelerates) {
      const double left_s = step_s_ - clock_[ball];
      acceleration_.set(ball, model_.acceleration(world_, ball, world_.velocity[ball], left_s));
      push_.set(ball, Vec<Dim>::Zero());
    }
    ++stamp_[ball];
  }

  /// Tells the broad phase where the flight may lead.
  void widen_bound(std::size_t ball) {
    const double moved = (world_.position[ball] - start_[ball]).norm();
    const double bound = world_.radius[ball] + moved + path_bound(ball, step_s_ - clock_[ball]);
    if (bound <= bound_[ball]) return;
    bound_[ball] = bound;
    broad_phase_.bound_grew(ball);
  }

  // --- contacts to come

  bool stale(const Contact& contact) const {
    return contact.stamp_a != stamp_[contact.a] || (!contact.wall && contact.stamp_b != stamp_[contact.b]);
  }

  void expect_pair(std::size_t i, std::size_t j) {
    if (world_.inverse_mass[i] == 0.0 && world_.inverse_mass[j] == 0.0) return;  // nothing can give way
    const double now = std::max(clock_[i], clock_[j]);
    const Motion<Dim> a = motion(i).after(now - clock_[i]);
    const Motion<Dim> b = motion(j).after(now - clock_[j]);
    const Vec<Dim> d = b.x - a.x;
    const Vec<Dim> w = b.v - a.v;
    const double sigma = world_.radius[i] + world_.radius[j];
    const double rounding = velocity_rounding(a.v.norm() + b.v.norm() + field_speed_);
    double wait = kNever;
    if constexpr (kAccelerates) {
      const Vec<Dim> relative = b.a - a.a;
      const double left_s = step_s_ - now;
      // What moves them by less than rounding does is no relative acceleration.
      const bool uniform = 0.5 * left_s * left_s * relative.norm() <= kEpsilon * sigma;
      wait = uniform ? time_to_touch<Dim>(d, w, sigma, rounding)
                     : time_to_touch<Dim>(d, w, relative, sigma, rounding, left_s);
    } else {
      wait = time_to_touch<Dim>(d, w, sigma, rounding);
    }
    expect(now + wait, std::min(i, j), std::max(i, j), false);
  }

  void expect_walls(std::size_t ball) {
    if (world_.inverse_mass[ball] == 0.0) return;
    const Motion<Dim> now = motion(ball);
    const double rounding = velocity_rounding(now.v.norm() + field_speed_);
    for (std::size_t wall = 0; wall < walls_.size(); ++wall) {
      const Vec<Dim>& normal = walls_[wall].normal;
      const double gap = normal.dot(now.x) - walls_[wall].offset - world_.radius[ball];
      const double wait =
          time_to_close(gap, normal.dot(now.v), normal.dot(now.a), rounding, step_s_ - clock_[ball]);
      expect(clock_[ball] + wait, ball, wall, true);
    }
  }

  void expect(double time_s, std::size_t a, std::size_t b, bool wall) {
    if (!(time_s <= step_s_) || is_held(a, b, wall)) return;
    contacts_.push({time_s, static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), wall, stamp_[a],
                    wall ? 0 : stamp_[b]});
  }

  void expect_all(std::size_t ball) {
    widen_bound(ball);
    expect_walls(ball);
    broad_phase_.for_each_near(ball, [&](std::size_t other) { expect_pair(ball, other); });
  }

  // --- impacts
  // A contact is expected only where balls approach by more than rounding, and resolved whatever little
  // approach is left when its time comes: between the two thresholds nothing can be expected again and again.

  void resolve_pair(const Contact& contact) {
    const std::size_t a = contact.a;
    const std::size_t b = contact.b;
    fly_to(a, contact.time);
    fly_to(b, contact.time);
    const Vec<Dim> normal = normal_between(world_.position[a], world_.position[b]);
    const double v_n = normal.dot(world_.velocity[b] - world_.velocity[a]);
    const double speeds = world_.velocity[a].norm() + world_.velocity[b].norm();
    double a_n = 0.0;
    if constexpr (kAccelerates) a_n = normal.dot(acceleration_[b] - acceleration_[a]);
    const bool chatters = std::max(stamp_[a], stamp_[b]) >= most_flights_;
    if (chatters || comes_to_rest(v_n, a_n, restitution_, speeds)) {
      settle(contact, v_n, chatters);
    } else if (v_n < 0.0) {
      ++tally_.impacts;
      const Vec<Dim> impulse = Law::template between<Dim>(world_, a, b, normal, restitution_);
      if (world_.inverse_mass[a] == 0.0) book_impulse(b, impulse);
      if (world_.inverse_mass[b] == 0.0) book_impulse(a, -impulse);
      begin_flights_after_impact({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
    }
  }

  void resolve_wall(const Contact& contact) {
    const std::size_t ball = contact.a;
    const Vec<Dim>& normal = walls_[contact.b].normal;
    fly_to(ball, contact.time);
    const double v_n = normal.dot(world_.velocity[ball]);
    const double speed = world_.velocity[ball].norm();
    double a_n = 0.0;
    if constexpr (kAccelerates) a_n = normal.dot(acceleration_[ball]);
    const bool chatters = stamp_[ball] >= most_wall_flights_;
    if (chatters || comes_to_rest(v_n, a_n, wall_restitution_, speed)) {
      settle(contact, v_n, chatters);
    } else if (v_n < 0.0) {
      ++tally_.impacts;
      book_impulse(ball, Law::template on_wall<Dim>(world_, ball, normal, wall_restitution_));
      begin_flights_after_impact({static_cast<std::uint32_t>(ball)});
    }
  }

  /// New flights for the balls that were hit, and for all that lean on them: what bears those has changed.
  void begin_flights_after_impact(std::initializer_list<std::uint32_t> hit) {
    members_.assign(hit);
    ++marks_;
    for (const std::uint32_t ball : members_) mark_[ball] = marks_;
    const double time_s = clock_[members_.front()];
    for (std::size_t next = 0; !held_.empty() && next < members_.size(); ++next) {
      broad_phase_.for_each_near(members_[next], [&](std::size_t other) {
        if (is_held(members_[next], other, false)) join(other, time_s);
      });
    }
    for (const std::uint32_t ball : members_) begin_flight(ball);
    for (const std::uint32_t ball : members_) expect_all(ball);
  }

  /// Two balls at one point have no normal; any fixed one keeps the laws.
  static Vec<Dim> normal_between(const Vec<Dim>& a, const Vec<Dim>& b) {
    const Vec<Dim> between = b - a;
    return between.isZero(0.0) ? Vec<Dim>(Vec<Dim>::UnitX()) : Vec<Dim>(between.normalized());
  }

  /// Whether a contact with this normal velocity and acceleration (both negative when closing) stays closed.
  bool comes_to_rest(double v_n, double a_n, double restitution, double speeds) const {
    const double rounding = velocity_rounding(speeds + field_speed_);
    if (a_n * step_s_ >= -rounding) return false;
    const double rebound = std::max(-v_n - rounding, 0.0) * restitution;
    const double share = restitution < 1.0 ? kRestShare : kElasticRestShare;
    return rebound == 0.0 || 2.0 * rebound < share * step_s_ * -a_n;
  }

  // --- rest

  /// How slowly balls close whose rebound is left out, m/s.
  double slow() const { return kRestShare * field_speed_; }

  /// Closes the contact, and with it those around it that are as good as closed, for the rest of the step.
  /// Where a ball chatters these are all that touch and close, however fast.
  void settle(const Contact& seed, double v_n, bool chatters) {
    gather_cluster(seed, chatters);
    if (v_n < -slow() - rounding_of_members_) ++tally_.impacts;
    const auto inverse_mass = [this](std::size_t ball) { return world_.inverse_mass[ball]; };
    cluster_.solve(world_.velocity, inverse_mass, rounding_of_members_);
    for (const auto& contact : cluster_.contacts()) book_cluster_impulse(contact);
    for (const std::uint32_t ball : members_) begin_flight(ball);
    if constexpr (kAccelerates) {
      const auto yielding = [&](std::size_t ball) {
        return world_.inverse_mass[ball] *
               model_.yield(world_, ball, world_.velocity[ball], step_s_ - clock_[ball]);
      };
      cluster_.solve(acceleration_, yielding, rounding_of_members_ / step_s_);
      for (const auto& contact : cluster_.contacts()) bear(contact);
    }
    // What the sweeps leave of a large pile is not worth another impact.
    rounding_of_members_ = std::max(rounding_of_members_, kRestShare * slow());
    for (const auto& contact : cluster_.contacts()) {
      if (chatters || stays_closed(contact)) hold(contact.a, contact.b, contact.wall);
    }
    for (const std::uint32_t ball : members_) expect_all(ball);
  }

  /// Floods from the balls of the seed through all closed contacts; moves the balls it meets to the seed's
  /// time.
  void gather_cluster(const Contact& seed, bool chatters) {
    cluster_.clear();
    members_.clear();
    ++marks_;
    rounding_of_members_ = velocity_rounding(field_speed_);
    join(seed.a, seed.time);
    if (!seed.wall) join(seed.b, seed.time);
    for (std::size_t next = 0; next < members_.size(); ++next) {
      const std::size_t ball = members_[next];
      for (std::size_t wall = 0; wall < walls_.size(); ++wall) {
        const Vec<Dim>& normal = walls_[wall].normal;
        const double gap = normal.dot(world_.position[ball]) - walls_[wall].offset - world_.radius[ball];
        const bool is_seed = seed.wall && ball == seed.a && wall == seed.b;
        if (is_seed || is_held(ball, wall, true) ||
            closed(gap, normal.dot(world_.velocity[ball]), world_.position[ball], chatters)) {
          cluster_.add({members_[next], static_cast<std::uint32_t>(wall), true, normal});
        }
      }
      broad_phase_.for_each_near(ball, [&](std::size_t other) { gather_pair(next, other, seed, chatters); });
    }
  }

  /// Adds the contact of a member with another ball, if it is closed and was not met from the other side
  /// before.
  void gather_pair(std::size_t member, std::size_t other, const Contact& seed, bool chatters) {
    const std::size_t ball = members_[member];
    const auto before = members_.begin() + static_cast<std::ptrdiff_t>(member);
    if (mark_[other] == marks_ && std::find(members_.begin(), before, other) != before) return;
    const Motion<Dim> then = motion(other).after(seed.time - clock_[other]);
    const Vec<Dim> normal = normal_between(world_.position[ball], then.x);
    const double gap = (then.x - world_.position[ball]).norm() - world_.radius[ball] - world_.radius[other];
    const bool is_seed = !seed.wall && std::min(ball, other) == seed.a && std::max(ball, other) == seed.b;
    const double v_n = normal.dot(then.v - world_.velocity[ball]);
    if (!is_seed && !is_held(ball, other, false) && !closed(gap, v_n, then.x, chatters)) return;
    if (world_.inverse_mass[other] > 0.0) {
      join(other, seed.time);
    } else {
      fly_to(other, seed.time);
    }
    cluster_.add({static_cast<std::uint32_t>(ball), static_cast<std::uint32_t>(other), false, normal});
  }

  void join(std::size_t ball, double time_s) {
    if (mark_[ball] == marks_ || world_.inverse_mass[ball] == 0.0) return;
    mark_[ball] = marks_;
    fly_to(ball, time_s);
    members_.push_back(static_cast<std::uint32_t>(ball));
    const double rounding = velocity_rounding(2.0 * world_.velocity[ball].norm() + field_speed_);
    rounding_of_members_ = std::max(rounding_of_members_, rounding);
  }

  /// As good as closed: the gap is one that a rebound left out could have, and the balls close as slowly, if
  /// at all. Around a ball that chatters, as wide as a hundredth of what the step's fall would close, and
  /// however fast.
  bool closed(double gap, double v_n, const Vec<Dim>& place, bool chatters) const {
    const double rounding = 16.0 * kEpsilon * place.cwiseAbs().maxCoeff();
    if (chatters) return gap <= kChatterShare * 0.5 * field_speed_ * step_s_ + rounding && v_n <= slow();
    if (gap > kRestShare * slow() * step_s_ + rounding || v_n > rounding_of_members_) return false;
    return v_n >= -slow() - rounding_of_members_;
  }

  /// Whether the solution leaves the contact closed: some are opened by what the others push.
  bool stays_closed(const typename RestingCluster<Dim>::Contact& contact) const {
    const auto opening = [&](const VectorColumn<Dim>& u) {
      return contact.normal.dot(contact.wall ? u[contact.a] : Vec<Dim>(u[contact.b] - u[contact.a]));
    };
    if (opening(world_.velocity) > rounding_of_members_) return false;
    if constexpr (kAccelerates) return opening(acceleration_) * step_s_ <= rounding_of_members_;
    return true;
  }

  void book_cluster_impulse(const typename RestingCluster<Dim>::Contact& contact) {
    if (contact.wall) {
      book_impulse(contact.a, contact.push * contact.normal);
    } else if (world_.inverse_mass[contact.b] == 0.0) {
      book_impulse(contact.a, -contact.push * contact.normal);
    }
  }

  /// Notes what walls and immovable balls bear, for the account.
  void bear(const typename RestingCluster<Dim>::Contact& contact) {
    if (!contact.wall && world_.inverse_mass[contact.b] > 0.0) return;
    const double sign = contact.wall ? 1.0 : -1.0;
    const double a_n = sign * contact.push * world_.inverse_mass[contact.a];
    push_.set(contact.a, push_[contact.a] + a_n * contact.normal);
  }

  // A held contact is not expected again while neither ball begins a new flight.

  static std::uint64_t key(std::size_t a, std::size_t b, bool wall) {
    const auto [low, high] = wall ? std::pair(a, b) : std::pair(std::min(a, b), std::max(a, b));
    return (static_cast<std::uint64_t>(low) << 32U) | (static_cast<std::uint64_t>(high) << 1U) |
           (wall ? 1U : 0U);
  }

  std::pair<std::uint32_t, std::uint32_t> stamps(std::size_t a, std::size_t b, bool wall) const {
    if (wall) return {stamp_[a], 0};
    return {stamp_[std::min(a, b)], stamp_[std::max(a, b)]};
  }

  void hold(std::size_t a, std::size_t b, bool wall) { held_[key(a, b, wall)] = stamps(a, b, wall); }

  bool is_held(std::size_t a, std::size_t b, bool wall) const {
    if (held_.empty()) return false;
    const auto found = held_.find(key(a, b, wall));
    return found != held_.end() && found->second == stamps(a, b, wall);
  }

  // --- the account of walls and immovable balls
  //
  // A frictionless push goes through the centre, so its moment about the origin is x × J.

  void book_impulse(std::size_t ball, const Vec<Dim>& impulse) {
    const Vec3 wide = widened<Dim>(impulse);
    tally_.external_impulse += wide;
    tally_.external_angular_impulse += widened<Dim>(world_.position[ball]).cross(wide);
  }

  /// What bears the ball pushes with m·push during the stretch tau; ∫x dt over the parabola gives the moment.
  void book_push(std::size_t ball, double tau) {
    const Motion<Dim> m = motion(ball);
    const Vec3 force = widened<Dim>(push_[ball]) / world_.inverse_mass[ball];
    const Vec<Dim> path_integral = tau * (m.x + (0.5 * tau) * m.v + (tau * tau / 6.0) * m.a);
    tally_.external_impulse += tau * force;
    tally_.external_angular_impulse += widened<Dim>(path_integral).cross(force);
  }

  World<Dim> world_;
  FlightModel<Dim, Effects...> model_;
  BroadPhase<Dim> broad_phase_;
  std::vector<Plane> walls_;
  double restitution_;
  double wall_restitution_;
  std::uint32_t most_flights_;
  std::uint32_t most_wall_flights_;
  Tally tally_;

  // The step at hand. A ball's position, velocity and acceleration stand at its clock.
  double step_s_ = 0.0;
  double field_speed_ = 0.0;          ///< m/s, what the strongest acceleration gives in a step
  VectorColumn<Dim> start_;           ///< positions when the step began
  std::vector<double> bound_;         ///< m, see the broad phases
  std::vector<double> clock_;         ///< s, from the start of the step
  std::vector<std::uint32_t> stamp_;  ///< counts the flights of a ball in this step
  VectorColumn<Dim> acceleration_;    ///< m/s², empty without effects
  VectorColumn<Dim> push_;            ///< m/s², by what bears the ball; empty without effects
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;

  // What rests in this step.
  RestingCluster<Dim> cluster_;
  std::vector<std::uint32_t> members_;  ///< movable balls of the cluster at hand
  double rounding_of_members_ = 0.0;    ///< m/s, of their velocities
  std::vector<std::uint32_t> mark_;     ///< the last cluster that a ball was in
  std::uint32_t marks_ = 0;
  std::unordered_map<std::uint64_t, std::pair<std::uint32_t, std::uint32_t>> held_;  ///< contact -> stamps

  std::priority_queue<Contact, std::vector<Contact>, std::greater<>> contacts_;
};

}  // namespace carom
