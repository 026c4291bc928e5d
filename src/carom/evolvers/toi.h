#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <queue>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

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
/// Resting. Under gravity a ball with e < 1 would bounce infinitely often in finite time. An impact whose
/// rebound would be over within kRestShare of the step (2 v_n'/|a_n|) ends in contact instead: the normal
/// velocity is taken out, and for the rest of the step the surface bears the ball (bear()). What is lost with
/// it is at most ½ m v_n'² = ⅛ m (kRestShare a_n h)² an impact. With e = 1 only a velocity that is zero up to
/// rounding comes to rest.
template <int Dim, template <int> class BroadPhase, class Law, class... Effects>
class ToiEvolver final : public Simulation {
 public:
  explicit ToiEvolver(const Scenario& scene, Effects... effects)
      : world_(scene.balls),
        model_(effects...),
        restitution_(scene.ball_contact.restitution),
        wall_restitution_(scene.wall_contact.restitution),
        start_(world_.size()),
        bound_(world_.size()),
        clock_(world_.size(), 0.0),
        stamp_(world_.size(), 0) {
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
            {"rest_share_of_step", kRestShare}};
  }

 private:
  static constexpr bool kAccelerates = FlightModel<Dim, Effects...>::kAccelerates;
  static constexpr double kRestShare = 1e-3;

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
    // Far above what any scene of separate impacts needs; a collapse that rounding does not end stops here.
    std::size_t left = 1'000'000 + 1'000 * world_.size();
    while (!contacts_.empty()) {
      const Contact next = contacts_.top();
      contacts_.pop();
      if (stale(next)) continue;
      if (left-- == 0) {
        throw std::runtime_error(fmt::format("more than {} impacts in one step", 1'000'000));
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

  // --- flights ---------------------------------------------------------------------------------------------

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

  /// After an impact: a new flight from here to the end of the step, and what it runs into.
  void begin_flight(std::size_t ball) {
    const double left_s = step_s_ - clock_[ball];
    if constexpr (kAccelerates) {
      acceleration_.set(ball, model_.acceleration(world_, ball, world_.velocity[ball], left_s));
      push_.set(ball, Vec<Dim>::Zero());
    }
    const double moved = (world_.position[ball] - start_[ball]).norm();
    const double bound = world_.radius[ball] + moved + path_bound(ball, left_s);
    if (bound > bound_[ball]) {
      bound_[ball] = bound;
      broad_phase_.bound_grew(ball);
    }
  }

  // --- contacts to come ------------------------------------------------------------------------------------

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
      const double wait = time_to_close(gap, normal.dot(now.v), normal.dot(now.a), rounding);
      expect(clock_[ball] + wait, ball, wall, true);
    }
  }

  void expect(double time_s, std::size_t a, std::size_t b, bool wall) {
    if (!(time_s <= step_s_)) return;
    contacts_.push({time_s, static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), wall, stamp_[a],
                    wall ? 0 : stamp_[b]});
  }

  void expect_all(std::size_t ball) {
    ++stamp_[ball];
    expect_walls(ball);
    broad_phase_.for_each_near(ball, [&](std::size_t other) { expect_pair(ball, other); });
  }

  // --- impacts ---------------------------------------------------------------------------------------------
  // A contact is expected only where balls approach by more than rounding, and resolved whatever little
  // approach is left when its time comes: between the two thresholds nothing can be expected again and again.

  void resolve_pair(const Contact& contact) {
    const std::size_t a = contact.a;
    const std::size_t b = contact.b;
    fly_to(a, contact.time);
    fly_to(b, contact.time);
    const Vec<Dim> between = world_.position[b] - world_.position[a];
    // Two balls at one point have no normal; any fixed one keeps the laws.
    const Vec<Dim> normal =
        between.isZero(0.0) ? Vec<Dim>(Vec<Dim>::UnitX()) : Vec<Dim>(between.normalized());
    const double v_n = normal.dot(world_.velocity[b] - world_.velocity[a]);
    double a_n = 0.0;
    if constexpr (kAccelerates) a_n = normal.dot(acceleration_[b] - acceleration_[a]);
    const double rounding =
        velocity_rounding(world_.velocity[a].norm() + world_.velocity[b].norm() + field_speed_);
    const bool rests = comes_to_rest(v_n, a_n, restitution_, rounding);
    if (v_n >= 0.0 && !rests) return;
    if (v_n < 0.0) {
      const Vec<Dim> impulse = Law::template between<Dim>(world_, a, b, normal, rests ? 0.0 : restitution_);
      if (world_.inverse_mass[a] == 0.0) book_impulse(b, impulse);
      if (world_.inverse_mass[b] == 0.0) book_impulse(a, -impulse);
    }
    if (v_n < -rounding) {
      ++tally_.impacts;
      begin_flight(a);
      begin_flight(b);
    }
    if constexpr (kAccelerates) {
      if (rests) bear_pair(a, b, normal);
    }
    expect_all(a);
    expect_all(b);
  }

  void resolve_wall(const Contact& contact) {
    const std::size_t ball = contact.a;
    const Vec<Dim>& normal = walls_[contact.b].normal;
    fly_to(ball, contact.time);
    const double v_n = normal.dot(world_.velocity[ball]);
    double a_n = 0.0;
    if constexpr (kAccelerates) a_n = normal.dot(acceleration_[ball]);
    const double rounding = velocity_rounding(world_.velocity[ball].norm() + field_speed_);
    const bool rests = comes_to_rest(v_n, a_n, wall_restitution_, rounding);
    if (v_n >= 0.0 && !rests) return;
    if (v_n < 0.0) {
      book_impulse(ball, Law::template on_wall<Dim>(world_, ball, normal, rests ? 0.0 : wall_restitution_));
    }
    if (v_n < -rounding) {
      ++tally_.impacts;
      begin_flight(ball);
    }
    if constexpr (kAccelerates) {
      if (rests) bear(ball, normal);
    }
    expect_all(ball);
  }

  /// Whether a contact with this normal velocity and acceleration (both negative when closing) stays closed.
  bool comes_to_rest(double v_n, double a_n, double restitution, double rounding) const {
    if (a_n >= 0.0) return false;
    const double rebound = std::max(-v_n - rounding, 0.0) * restitution;
    if (rebound == 0.0) return true;
    return restitution < 1.0 && 2.0 * rebound < kRestShare * step_s_ * -a_n;
  }

  /// A wall bears a ball for the rest of the step: it takes away the acceleration into the wall.
  void bear(std::size_t ball, const Vec<Dim>& normal) {
    const double a_n = normal.dot(acceleration_[ball]);
    if (a_n >= 0.0) return;
    acceleration_.set(ball, acceleration_[ball] - a_n * normal);
    push_.set(ball, push_[ball] - a_n * normal);
  }

  /// Two balls bear each other: the acceleration towards each other is taken away, momentum is kept.
  void bear_pair(std::size_t a, std::size_t b, const Vec<Dim>& normal) {
    const double a_n = normal.dot(acceleration_[b] - acceleration_[a]);
    if (a_n >= 0.0) return;
    const double inverse_mass = world_.inverse_mass[a] + world_.inverse_mass[b];
    const double share_a = world_.inverse_mass[a] / inverse_mass;
    const double share_b = world_.inverse_mass[b] / inverse_mass;
    acceleration_.set(a, acceleration_[a] + share_a * a_n * normal);
    acceleration_.set(b, acceleration_[b] - share_b * a_n * normal);
    if (share_a == 0.0) push_.set(b, push_[b] - a_n * normal);
    if (share_b == 0.0) push_.set(a, push_[a] + a_n * normal);
  }

  // --- the account of walls and immovable balls
  // ------------------------------------------------------------- A frictionless push goes through the
  // centre, so its moment about the origin is x × J.

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
  Tally tally_;

  // The step at hand. A ball's position, velocity and acceleration stand at its clock.
  double step_s_ = 0.0;
  double field_speed_ = 0.0;          ///< m/s, what the strongest acceleration gives in a step
  VectorColumn<Dim> start_;           ///< positions when the step began
  std::vector<double> bound_;         ///< m, see the broad phases
  std::vector<double> clock_;         ///< s, from the start of the step
  std::vector<std::uint32_t> stamp_;  ///< counts the flights of a ball
  VectorColumn<Dim> acceleration_;    ///< m/s², empty without effects
  VectorColumn<Dim> push_;            ///< m/s², by what bears the ball; empty without effects
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
  std::priority_queue<Contact, std::vector<Contact>, std::greater<>> contacts_;
};

}  // namespace carom
