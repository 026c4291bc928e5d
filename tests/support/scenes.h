#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/random.h"
#include "engine/engine.h"
#include "scenario/parse.h"

namespace carom::test {

inline ScenarioPtr scene_of(const std::string& toml) {
  return parse_scene(toml, "test.toml");
}

/// Balls without walls or effects, for a duration; the rest as in a scene file that leaves it out.
inline Scenario free_scene(int dimension, std::vector<Ball> balls, double duration_s, double step_s) {
  Scenario scene;
  scene.dimension = dimension;
  scene.balls = std::move(balls);
  scene.duration_s = duration_s;
  scene.step_s = step_s;
  return scene;
}

/// A gas in a box of sides `side` m, radii mixed 1 : 2.
inline ScenarioPtr gas(int dimension, int count, double packing, double side, std::uint64_t seed,
                       const std::string& more = "") {
  const std::string low = dimension == 2 ? "[0, 0]" : "[0, 0, 0]";
  std::string high = "[" + std::to_string(side);
  for (int axis = 1; axis < dimension; ++axis) high += ", " + std::to_string(side);
  return scene_of(
      "title = \"gas\"\ndimension = " + std::to_string(dimension) +
      "\nduration = 1.0\nstep = 0.005\nframes = 10\n" + more + "\n[box]\nmin = " + low + "\nmax = " + high +
      "]\n[[balls]]\nkind = \"gas\"\ncount = " + std::to_string(count) + "\nseed = " + std::to_string(seed) +
      "\nradius = [0.5, 1.0]\npacking = " + std::to_string(packing) + "\nmass = 1.0\nspeed = 1.0\n");
}

inline std::vector<BallState> states_of(const Scenario& scene) {
  std::vector<BallState> states;
  for (const Ball& ball : scene.balls) states.push_back({ball.position, ball.velocity, ball.spin});
  return states;
}

inline std::vector<BallState> states_of(const Simulation& simulation, std::size_t balls) {
  std::vector<BallState> states(balls);
  simulation.snapshot(states);
  return states;
}

/// The states after `steps` equal steps over the scene's duration.
inline std::vector<BallState> run(Simulation& simulation, const Scenario& scene, std::int64_t steps) {
  simulation.advance(scene.duration_s / static_cast<double>(steps), steps);
  return states_of(simulation, scene.balls.size());
}

inline Vec3 momentum_of(const Scenario& scene, const std::vector<BallState>& states) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < states.size(); ++i) sum += scene.balls[i].mass * states[i].velocity;
  return sum;
}

inline double kinetic_energy_of(const Scenario& scene, const std::vector<BallState>& states) {
  double sum = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    sum += 0.5 * scene.balls[i].mass * states[i].velocity.squaredNorm();
  }
  return sum;
}

/// Σ m |x| |v| at the start: what the moments of momenta about the origin are rounded against.
inline double angular_momentum_scale(const Scenario& scene) {
  double sum = 0.0;
  for (const Ball& b : scene.balls) sum += b.mass * b.position.norm() * b.velocity.norm();
  return sum;
}

/// About the origin, with spin.
inline Vec3 angular_momentum_of(const Scenario& scene, const std::vector<BallState>& states) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Ball& b = scene.balls[i];
    sum += b.mass * states[i].position.cross(states[i].velocity);
    sum += b.mass * b.inertia * b.radius * b.radius * states[i].spin;
  }
  return sum;
}

inline Vec3 random_vector(Random& random, int dimension, double size) {
  Vec3 v = Vec3::Zero();
  for (int axis = 0; axis < dimension; ++axis) v[axis] = random.uniform(-size, size);
  return v;
}

}  // namespace carom::test
