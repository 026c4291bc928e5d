#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "scenario/scenario.h"

namespace carom::reference {

// What an adapter has to know about a scene before it sets an engine up: how small, how fast, how far.

/// The step every engine is given first: a frame's interval cut into the smallest whole number of equal steps
/// no longer than the scene's step.
inline double first_step_s(const Scenario& scene) {
  const double interval_s = scene.duration_s / static_cast<double>(scene.frames);
  return interval_s / std::ceil(interval_s / scene.step_s);
}

/// The radius of the smallest ball, m.
inline double smallest_radius_m(const Scenario& scene) {
  double radius_m = std::numeric_limits<double>::infinity();
  for (const Ball& ball : scene.balls) radius_m = std::min(radius_m, ball.radius);
  return std::isfinite(radius_m) ? radius_m : 1.0;
}

/// The speed of the fastest ball at t = 0, m/s.
inline double initial_speed_mps(const Scenario& scene) {
  double speed_mps = 0.0;
  for (const Ball& ball : scene.balls) speed_mps = std::max(speed_mps, ball.velocity.norm());
  return speed_mps;
}

/// The fastest rotation at t = 0, rad/s.
inline double initial_spin_radps(const Scenario& scene) {
  double spin_radps = 0.0;
  for (const Ball& ball : scene.balls) spin_radps = std::max(spin_radps, ball.spin.norm());
  return scene.effects.spin ? spin_radps : 0.0;
}

/// How far a ball can fall along gravity before a level wall or the box stops it, m; without them, as far as
/// the scene lasts: on a tilted wall it goes on down.
inline double fall_m(const Scenario& scene, const Ball& ball) {
  const Vec3& gravity_mps2 = *scene.effects.gravity;
  const Vec3 down = gravity_mps2.normalized();
  double fall_m =
      ball.velocity.norm() * scene.duration_s + 0.5 * gravity_mps2.norm() * std::pow(scene.duration_s, 2);
  constexpr double kLevel = 1.0 - 1e-9;  // a cosine: what is more level than rounding can tell
  for (const Wall& wall : scene.walls) {
    if (-wall.normal.dot(down) >= kLevel)
      fall_m = std::min(fall_m, wall.normal.dot(ball.position) - wall.offset);
  }
  if (scene.box) fall_m = std::min(fall_m, down.cwiseAbs().dot(scene.box->max - scene.box->min));
  return std::max(fall_m, 0.0);
}

/// A speed that balls of this scene are not expected to pass, m/s: an elastic hit by a much heavier ball at
/// most doubles the highest speed, and a fall from rest by H adds 2 g H to its square. Repeated hits between
/// very unequal masses can pass it; nothing but room for them rests on this number.
inline double expected_top_speed_mps(const Scenario& scene) {
  const double hit_mps = 2.0 * initial_speed_mps(scene);
  if (!scene.effects.gravity || scene.effects.gravity->isZero()) return hit_mps;
  double highest_m = 0.0;
  for (const Ball& ball : scene.balls) highest_m = std::max(highest_m, fall_m(scene, ball));
  return std::sqrt(hit_mps * hit_mps + 2.0 * scene.effects.gravity->norm() * highest_m);
}

/// Where the balls are, and how far from there they can get: walls of finite size must cover this.
struct Reach {
  Vec3 centre = Vec3::Zero();  ///< m
  double radius_m = 0.0;
};

inline Reach reach_of(const Scenario& scene) {
  if (scene.box) return {0.5 * (scene.box->min + scene.box->max), (scene.box->max - scene.box->min).norm()};
  Reach reach;
  for (const Ball& ball : scene.balls)
    reach.centre += ball.position / static_cast<double>(scene.balls.size());
  for (const Ball& ball : scene.balls) {
    reach.radius_m = std::max(reach.radius_m, (ball.position - reach.centre).norm() + ball.radius);
  }
  reach.radius_m += expected_top_speed_mps(scene) * scene.duration_s;
  return reach;
}

/// Why a fixed-step engine without continuous collision cannot be trusted with this scene: its fastest ball
/// can jump through the smallest one within a step. Empty where it cannot. Two balls overlap and still
/// approach until their centres pass, that is over r_a + r_b; a longer way in a step can leave that out.
inline std::string jumps_through_balls(const Scenario& scene) {
  if (!scene.effects.collisions || scene.balls.size() < 2) return {};
  const double smallest_m = smallest_radius_m(scene);
  for (const Ball& ball : scene.balls) {
    const double travel_m = ball.velocity.norm() * first_step_s(scene);
    if (travel_m <= ball.radius + smallest_m) continue;
    return fmt::format(
        "it has no continuous collision, and a ball that moves {:.3g} m in a step can jump through another "
        "of radius {:.3g} m",
        travel_m, smallest_m);
  }
  return {};
}

/// The power of two nearest below `factor`: multiplying by it and dividing by it rounds nothing.
inline double power_of_two_below(double factor) {
  return std::exp2(std::floor(std::log2(factor)));
}

}  // namespace carom::reference
