#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "engine/engine.h"
#include "engine/modules.h"

namespace carom::reference_test {

// Scenes and measurements that the tests of every reference adapter share. A measurement returns an error;
// the test says how large it may be.

inline Engine& engine(const std::string& name) {
  return open_engine_module(std::filesystem::path(CAROM_ENGINE_DIR_PATH) / (name + ".so"));
}

/// The machine epsilon of the engine's precision.
inline double epsilon(const Engine& engine) {
  return engine.info().precision == "float32" ? std::numeric_limits<float>::epsilon()
                                              : std::numeric_limits<double>::epsilon();
}

inline Scenario scene_of(int dimension, double step_s, std::int64_t steps) {
  Scenario scene;
  scene.dimension = dimension;
  scene.step_s = step_s;
  scene.duration_s = step_s * static_cast<double>(steps);
  scene.frames = steps;
  return scene;
}

inline Ball ball(double mass, double radius, const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  Ball ball;
  ball.mass = mass;
  ball.radius = radius;
  ball.position = position;
  ball.velocity = velocity;
  return ball;
}

/// Closed walls from 0 to size along every axis of the scene.
inline void add_box(Scenario& scene, double size) {
  scene.box = Box{Vec3::Zero(), scene.dimension == 2 ? Vec3(size, size, 0) : Vec3(size, size, size)};
  for (int axis = 0; axis < scene.dimension; ++axis) {
    scene.walls.push_back({Vec3::Unit(axis), 0.0});
    scene.walls.push_back({-Vec3::Unit(axis), -size});
  }
}

/// A gas in a box: side^dimension balls of mass 1 kg on a lattice of 1 m, packing 0.1, root-mean-square speed
/// 1 m/s, total momentum zero.
inline Scenario gas(int dimension, int side, double step_s, std::int64_t steps) {
  Scenario scene = scene_of(dimension, step_s, steps);
  constexpr double kPacking = 0.1;
  const double pi = std::acos(-1.0);
  const double radius = dimension == 2 ? std::sqrt(kPacking / pi) : std::cbrt(0.75 * kPacking / pi);
  add_box(scene, side);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const int count = dimension == 2 ? side * side : side * side * side;
  Vec3 mean = Vec3::Zero();
  for (int i = 0; i < count; ++i) {
    const int layer = i / (side * side);
    const int row = i / side % side;
    Vec3 cell(i % side + 0.5, row + 0.5, layer + 0.5);
    Vec3 velocity(normal(random), normal(random), normal(random));
    if (dimension == 2) cell.z() = velocity.z() = 0.0;
    scene.balls.push_back(ball(1.0, radius, cell, velocity));
    mean += velocity / count;
  }
  double square = 0.0;
  for (Ball& b : scene.balls) square += (b.velocity -= mean).squaredNorm() / count;
  for (Ball& b : scene.balls) b.velocity /= std::sqrt(square);
  return scene;
}

/// A scene set up in one engine and profile, and what a test reads from it.
class Probe {
 public:
  Probe(const Engine& engine, const Scenario& scene, std::string_view profile = "faithful")
      : scene_(scene), simulation_(engine.create(scene, profile)), balls_(scene.balls.size()) {
    simulation_->snapshot(balls_);
  }

  void advance(std::int64_t steps) {
    simulation_->advance(scene_.step_s, steps);
    simulation_->snapshot(balls_);
  }

  const BallState& operator[](std::size_t i) const { return balls_[i]; }
  Tally tally() const { return simulation_->tally(); }
  Settings settings() const { return simulation_->settings(); }

  double kinetic_energy() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      if (std::isinf(scene_.balls[i].mass)) continue;
      sum += 0.5 * scene_.balls[i].mass * balls_[i].velocity.squaredNorm() +
             0.5 * moment(i) * balls_[i].spin.squaredNorm();
    }
    return sum;
  }

  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      if (std::isfinite(scene_.balls[i].mass)) sum += scene_.balls[i].mass * balls_[i].velocity;
    }
    return sum;
  }

  Vec3 angular_momentum() const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      if (std::isinf(scene_.balls[i].mass)) continue;
      sum += scene_.balls[i].mass * balls_[i].position.cross(balls_[i].velocity) + moment(i) * balls_[i].spin;
    }
    return sum;
  }

 private:
  double moment(std::size_t i) const {
    const Ball& b = scene_.balls[i];
    return b.inertia * b.mass * b.radius * b.radius;
  }

  const Scenario& scene_;
  std::unique_ptr<Simulation> simulation_;
  std::vector<BallState> balls_;
};

/// The scene at its end.
inline Probe after(const Engine& engine, const Scenario& scene, std::string_view profile = "faithful") {
  Probe run(engine, scene, profile);
  run.advance(scene.frames);
  return run;
}

/// The worst error of the velocities after a frictionless, elastic head-on hit, relative to `speed_mps`, over
/// 16 places of the impact within a step of a tenth of the radius, against (momentum and energy conserved)
///   v_a = (m_a - m_b)/(m_a + m_b) v,   v_b = 2 m_a/(m_a + m_b) v.
inline double head_on_error(const Engine& engine, int dimension, double speed_mps, double mass_a,
                            double mass_b, double radius = 0.5) {
  constexpr int kPhases = 16;
  constexpr std::int64_t kSteps = 8;  // the gap closes in two to three
  const Vec3 exact_a = (mass_a - mass_b) / (mass_a + mass_b) * speed_mps * Vec3::UnitX();
  const Vec3 exact_b = 2.0 * mass_a / (mass_a + mass_b) * speed_mps * Vec3::UnitX();
  double worst = 0.0;
  for (int k = 0; k < kPhases; ++k) {
    Scenario scene = scene_of(dimension, 0.1 * radius / speed_mps, kSteps);
    const double gap = radius * (0.2 + 0.1 * (k + 0.5) / kPhases);
    scene.balls = {ball(mass_a, radius, Vec3(-radius, 0, 0), Vec3(speed_mps, 0, 0)),
                   ball(mass_b, radius, Vec3(radius + gap, 0, 0))};
    const Probe run = after(engine, scene);
    worst = std::max({worst, (run[0].velocity - exact_a).norm(), (run[1].velocity - exact_b).norm()});
  }
  return worst / speed_mps;
}

/// The worst of head_on_error from 0.1 to 100 m/s, for equal masses and for 1 to 100 both ways round.
inline double head_on_sweep_error(const Engine& engine, int dimension) {
  double worst = 0.0;
  for (const double speed_mps : {0.1, 1.0, 10.0, 100.0}) {
    for (const auto& [a, b] : {std::pair{1.0, 1.0}, {1.0, 100.0}, {100.0, 1.0}}) {
      worst = std::max(worst, head_on_error(engine, dimension, speed_mps, a, b));
    }
  }
  return worst;
}

/// The error of a frictionless bounce off a wall of this normal, relative to the speed, with restitution e:
///   v' = v - (1 + e)(v·n) n.
inline double wall_error(const Engine& engine, int dimension, const Vec3& normal, double restitution) {
  constexpr std::int64_t kSteps = 60;
  Scenario scene = scene_of(dimension, 0.01, kSteps);
  scene.walls = {{normal, 0.3}};
  scene.wall_contact.restitution = restitution;
  const Vec3 along(-normal.y(), normal.x(), 0.0);
  scene.balls = {ball(1.0, 0.5, 1.05 * normal + along, -normal + 0.5 * along)};
  const Vec3& before = scene.balls[0].velocity;
  const Vec3 exact = before - (1.0 + restitution) * before.dot(normal) * normal;
  const Probe run = after(engine, scene);
  return (run[0].velocity - exact).norm() / before.norm();
}

/// What a sliding hit shows of a pair's coefficients.
struct Measured {
  double restitution;
  double friction;
};

// The hit is first seen with a known overlap, whatever the engine: two steps after the start.
constexpr double kHitSpeed_mps = 10.0;
constexpr double kHitStep_s = 0.01;
constexpr double kHitOverlap_m = 0.01;
constexpr double kHitGap_m = 2.0 * kHitSpeed_mps * kHitStep_s - kHitOverlap_m;

/// A fast ball grazes a wall while sliding: Δv_t = μ (1 + e) v_n.
inline Measured ball_on_wall(const Engine& engine, std::string_view profile, int dimension,
                             const Contact& balls, const Contact& walls) {
  Scenario scene = scene_of(dimension, kHitStep_s, 5);
  scene.effects.spin = true;
  scene.ball_contact = balls;
  scene.wall_contact = walls;
  scene.walls = {{Vec3::UnitY(), 0.0}};
  const Vec3 velocity(5.0 * kHitSpeed_mps, -kHitSpeed_mps, 0);
  scene.balls = {ball(1.0, 0.5, Vec3(0, 0.5 + kHitGap_m, 0), velocity)};
  const Probe run = after(engine, scene, profile);
  const double restitution = run[0].velocity.y() / kHitSpeed_mps;
  const double slowed_mps = velocity.x() - run[0].velocity.x();
  return {restitution, slowed_mps / ((1.0 + restitution) * kHitSpeed_mps)};
}

/// A fast spinning ball hits an equal one head-on while sliding: J_n = m (1 + e) v/2, J_t = μ J_n.
inline Measured ball_on_ball(const Engine& engine, std::string_view profile, int dimension,
                             const Contact& balls, const Contact& walls) {
  Scenario scene = scene_of(dimension, kHitStep_s, 5);
  scene.effects.spin = true;
  scene.ball_contact = balls;
  scene.wall_contact = walls;
  scene.balls = {ball(1.0, 0.5, Vec3(-0.5, 0, 0), Vec3(kHitSpeed_mps, 0, 0)),
                 ball(1.0, 0.5, Vec3(0.5 + kHitGap_m, 0, 0))};
  scene.balls[0].spin = Vec3(0, 0, 100);  // the surface moves at 50 m/s, so the contact slides throughout
  const Probe run = after(engine, scene, profile);
  const double restitution = (run[1].velocity.x() - run[0].velocity.x()) / kHitSpeed_mps;
  return {restitution, std::abs(run[1].velocity.y()) / run[1].velocity.x()};
}

/// What is left unexplained of a scene's momentum and angular momentum after `steps`:
///   P(t) - P(0) - M g t - J_external,   L(t) - L(0) - L_external.
struct Unexplained {
  double momentum_Ns;
  double angular_momentum_Nms;
  Tally tally;
  double energy_change;  ///< relative, kinetic
};

inline Unexplained unexplained(const Engine& engine, const Scenario& scene,
                               std::string_view profile = "faithful") {
  Probe run(engine, scene, profile);
  const Vec3 momentum = run.momentum();
  const Vec3 angular_momentum = run.angular_momentum();
  const double energy = run.kinetic_energy();
  run.advance(scene.frames);
  double mass = 0.0;
  for (const Ball& b : scene.balls) mass += std::isfinite(b.mass) ? b.mass : 0.0;
  const Vec3 weight = mass * scene.duration_s * scene.effects.gravity.value_or(Vec3::Zero());
  const Tally tally = run.tally();
  return {(run.momentum() - momentum - weight - tally.external_impulse).norm(),
          (run.angular_momentum() - angular_momentum - tally.external_angular_impulse).norm(), tally,
          std::abs(run.kinetic_energy() / energy - 1.0)};
}

/// The bound of momentum_Ns, by roundings of velocities: each impact rounds two velocities of about v by ε,
/// and gravity rounds every velocity in every step; all of one sign at worst.
inline double momentum_rounding(const Engine& engine, const Scenario& scene, const Tally& tally) {
  const double speed_mps = 4.0;  // no ball of a gas of a thousand at 1 m/s is faster for long
  double roundings = 4.0 * static_cast<double>(tally.impacts);
  if (scene.effects.gravity)
    roundings += static_cast<double>(scene.frames) * static_cast<double>(scene.balls.size());
  return epsilon(engine) * speed_mps * roundings;
}

/// The bound of angular_momentum_Nms, by roundings of positions: each step rounds each ball's place x by ε x,
/// which changes m x v; their signs are as good as random, so they add up as a square root. Four standard
/// deviations, with both factors 2.
inline double angular_momentum_rounding(const Engine& engine, const Scenario& scene) {
  const double size_m = (scene.box->max - scene.box->min).norm();
  const double roundings = static_cast<double>(scene.frames) * static_cast<double>(scene.balls.size());
  return 4.0 * epsilon(engine) * size_m * std::sqrt(roundings);
}

}  // namespace carom::reference_test
