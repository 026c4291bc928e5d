#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "carom/flight.h"
#include "carom/permute.h"
#include "carom/work.h"
#include "carom/world.h"
#include "engine/engine.h"

namespace carom {

/// The balls of the event-driven evolver, each on a flight of its own that began at its own clock: straight,
/// or the parabola under gravity. Nothing is done to a ball until its flight ends.
///
/// What a prediction reads of a ball is one struct, in space without spin one cache line: predictions reach
/// for balls as they lie near each other, not by number, so that columns would cost a line for each
/// component. What only an impact reads stands in columns.
///
/// Balls are numbered anew now and then (renumber()), so that those that are near in space are near in
/// memory; in what is ordered, and in what is told, each goes by its name, its number in the scene.
///
/// Clocks count from a moment that moves on with the run (rebase()), so that they stay short and keep their
/// digits.
template <int Dim, bool kGravity>
class EventFlights {
 public:
  explicit EventFlights(const Scenario& scene) : pair_(std::vector<Ball>(2), scene.effects.spin) {
    const World<Dim> world(scene.balls, scene.effects.spin);
    bodies_.reserve(world.size());
    for (std::size_t i = 0; i < world.size(); ++i) {
      bodies_.push_back({world.position[i], world.velocity[i], 0.0, world.radius[i]});
    }
    name_.resize(world.size());
    std::iota(name_.begin(), name_.end(), 0U);
    inverse_mass_ = world.inverse_mass.each();
    inverse_inertia_ = world.inverse_inertia;
    spin_ = world.spin;
    if constexpr (kGravity) prepare_gravity(scene);
  }

  std::size_t size() const { return bodies_.size(); }
  /// The ball's number in the scene.
  std::uint32_t name(std::uint32_t ball) const { return name_[ball]; }
  bool movable(std::uint32_t ball) const { return inverse_mass_[ball] > 0.0; }
  double radius(std::uint32_t ball) const { return bodies_[ball].radius; }
  double clock(std::uint32_t ball) const { return bodies_[ball].clock; }
  const Vec<Dim>& velocity(std::uint32_t ball) const { return bodies_[ball].v; }

  Vec<Dim> acceleration(std::uint32_t ball) const {
    if constexpr (kGravity) return accelerations_[way_[ball]];
    return Vec<Dim>::Zero();
  }

  /// How its flight began, at its clock.
  Motion<Dim> start(std::uint32_t ball) const {
    return {bodies_[ball].x, bodies_[ball].v, acceleration(ball)};
  }

  /// Where the ball is at a time of its flight.
  Motion<Dim> motion(std::uint32_t ball, double time_s) const {
    return {place(ball, time_s), velocity(ball, time_s), acceleration(ball)};
  }
  Vec<Dim> place(std::uint32_t ball, double time_s) const {
    const double tau = time_s - bodies_[ball].clock;
    if constexpr (kGravity) return start(ball).after(tau).x;
    return bodies_[ball].x + tau * bodies_[ball].v;
  }
  Vec<Dim> velocity(std::uint32_t ball, double time_s) const {
    if constexpr (kGravity) return start(ball).after(time_s - bodies_[ball].clock).v;
    return bodies_[ball].v;
  }

  /// Begins a new flight where the old one has led. What bore the ball bears it no longer.
  void begin_flight(std::uint32_t ball, double time_s) {
    const Motion<Dim> now = motion(ball, time_s);
    Body& body = bodies_[ball];
    body.x = now.x;
    body.v = now.v;
    body.clock = time_s;
    if constexpr (kGravity) {
      way_[ball] = std::min(way_[ball], kFalls);
    }
  }

  /// Carries out an impact law, between the two balls as a world of two. Returns the impulse on b, N s.
  template <class Law>
  Vec<Dim> collide(std::uint32_t a, std::uint32_t b, const Vec<Dim>& normal, const Contact& surface) {
    load(0, a);
    load(1, b);
    Vec<Dim> impulse = Law::template between<Dim>(pair_, 0, 1, normal, surface);
    if (movable(a)) store(0, a);
    if (movable(b)) store(1, b);
    return impulse;
  }

  /// The same with a wall. Returns the impulse on the ball.
  template <class Law>
  Vec<Dim> bounce(std::uint32_t ball, const Vec<Dim>& normal, const Contact& surface) {
    load(0, ball);
    Vec<Dim> impulse = Law::template on_wall<Dim>(pair_, 0, normal, surface);
    store(0, ball);
    return impulse;
  }

  /// The work of the impulse that collide() or bounce() has just returned.
  template <class Law>
  void add_work_of_collision(const Vec<Dim>& normal, const Vec<Dim>& impulse, EnergyAccount& energy) const {
    add_work_between<Law::kFriction, Dim>(pair_, 0, 1, normal, impulse, energy);
  }
  template <class Law>
  void add_work_of_bounce(const Vec<Dim>& normal, const Vec<Dim>& impulse, EnergyAccount& energy) const {
    add_work_of_wall<Law::kFriction, Dim>(pair_, 0, normal, impulse, energy);
  }

  /// Counts all clocks from a moment `shift_s` later.
  void rebase(double shift_s) {
    for (Body& body : bodies_) body.clock -= shift_s;
  }

  /// Numbers the balls anew: ball `order[k]` becomes ball k, and keeps its name. Columns that a scene has not
  /// are empty.
  void renumber(const std::vector<std::uint32_t>& order) {
    permute(bodies_, order);
    permute(name_, order);
    permute(inverse_mass_, order);
    if constexpr (kGravity) permute(way_, order);
    if (inverse_inertia_.empty()) return;
    permute(inverse_inertia_, order);
    VectorColumn<kSpinAxes<Dim>> spin(size());
    for (std::uint32_t k = 0; k < size(); ++k) spin.set(k, spin_[order[k]]);
    spin_ = std::move(spin);
  }

  void snapshot(double time_s, std::span<BallState> balls) const {
    for (std::uint32_t i = 0; i < size(); ++i) {
      const Motion<Dim> now = motion(i, time_s);
      balls[name_[i]] = {widened<Dim>(now.x), widened<Dim>(now.v), Vec3::Zero()};
    }
    if (inverse_inertia_.empty()) return;
    for (std::uint32_t i = 0; i < size(); ++i) balls[name_[i]].spin = widened_spin<Dim>(spin_[i]);
  }

  // --- balls at rest on a wall, under gravity

  static constexpr std::uint32_t kNoWall = ~0U;

  /// From here on the wall bears the ball, which slides along it, until a new flight begins. Returns what is
  /// left of its fall, and lost, J (below 0).
  double lay_on(std::uint32_t ball, std::uint32_t wall, const Vec<Dim>& normal) {
    Body& body = bodies_[ball];
    const double v_n = normal.dot(body.v);
    body.v -= v_n * normal;
    way_[ball] = kFirstWall + wall;
    return -0.5 * v_n * v_n / inverse_mass_[ball];
  }

  /// The wall that bears the ball, or kNoWall.
  std::uint32_t bearer(std::uint32_t ball) const {
    if constexpr (kGravity) return way_[ball] >= kFirstWall ? way_[ball] - kFirstWall : kNoWall;
    return kNoWall;
  }

  /// The same of all balls, in the scene's order.
  void add_pushes(double time_s, Tally& tally) const {
    std::vector<std::uint32_t> by_name(size());
    for (std::uint32_t ball = 0; ball < size(); ++ball) by_name[name_[ball]] = ball;
    for (const std::uint32_t ball : by_name) add_push(ball, time_s, tally);
  }

  /// Adds to the tally what the ball's bearer gives it until a time of its flight: with the constant force F
  /// the impulse F τ and, with ∫x dt over the parabola, the moment ∫x dt × F.
  void add_push(std::uint32_t ball, double time_s, Tally& tally) const {
    if (bearer(ball) == kNoWall) return;
    const Body& body = bodies_[ball];
    const Vec<Dim>& a = accelerations_[way_[ball]];
    const double tau = time_s - body.clock;
    const Vec3 force = widened<Dim>(a - accelerations_[kFalls]) / inverse_mass_[ball];
    const Vec<Dim> path_integral = tau * (body.x + (0.5 * tau) * (body.v + (tau / 3.0) * a));
    tally.external_impulse += tau * force;
    tally.external_angular_impulse += widened<Dim>(path_integral).cross(force);
  }

 private:
  struct Body {
    Vec<Dim> x;     ///< m, at the clock
    Vec<Dim> v;     ///< m/s, at the clock
    double clock;   ///< s
    double radius;  ///< m
  };

  // Ways to fly, as places in the list of accelerations.
  static constexpr std::uint32_t kStays = 0;  ///< an immovable ball does not fall
  static constexpr std::uint32_t kFalls = 1;
  static constexpr std::uint32_t kFirstWall = 2;  ///< borne by the first wall, and so on

  void prepare_gravity(const Scenario& scene) {
    const Vec<Dim> g = flattened<Dim>(*scene.effects.gravity);
    accelerations_ = {Vec<Dim>::Zero(), g};
    for (const Wall& wall : scene.walls) {
      const Vec<Dim> normal = flattened<Dim>(wall.normal);
      accelerations_.push_back(g - normal.dot(g) * normal);
    }
    for (const double inverse_mass : inverse_mass_) way_.push_back(inverse_mass > 0.0 ? kFalls : kStays);
  }

  void load(std::size_t slot, std::uint32_t ball) {
    pair_.velocity.set(slot, bodies_[ball].v);
    pair_.inverse_mass.set(slot, inverse_mass_[ball]);
    if (!pair_.spins()) return;
    pair_.radius.set(slot, bodies_[ball].radius);
    pair_.spin.set(slot, spin_[ball]);
    pair_.inverse_inertia[slot] = inverse_inertia_[ball];
  }

  void store(std::size_t slot, std::uint32_t ball) {
    bodies_[ball].v = pair_.velocity[slot];
    if (pair_.spins()) spin_.set(ball, pair_.spin[slot]);
  }

  std::vector<Body> bodies_;
  std::vector<std::uint32_t> name_;      ///< numbers in the scene
  Column<double> inverse_mass_;          ///< 1/kg
  VectorColumn<kSpinAxes<Dim>> spin_;    ///< rad/s, empty without spin
  Column<double> inverse_inertia_;       ///< 1/(kg m²), empty without spin
  std::vector<Vec<Dim>> accelerations_;  ///< m/s², empty without gravity
  std::vector<std::uint32_t> way_;       ///< which of them a ball has, empty without gravity
  World<Dim> pair_;                      ///< the balls of the impact at hand, as a law takes them
};

}  // namespace carom
