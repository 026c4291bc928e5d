#include "carom/evolvers/event_start.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

#include "carom/evolvers/event.h"
#include "carom/world.h"

namespace carom {

namespace {

bool movable(const Ball& ball) {
  return std::isfinite(ball.mass);
}

/// Whether two bodies, or a body and a wall, begin in contact and stay so: the contact is pressed, and what
/// it closes with is no more than a fall from the height of rounding gives (EventEvolver's own question,
/// asked of the start).
/// @param gap_m, v_n_mps, a_n_mps2  negative ones close
bool lies(double gap_m, double v_n_mps, double a_n_mps2, const Ball& ball) {
  const double height = kRestEpsilons * kEpsilon * (ball.position.cwiseAbs().maxCoeff() + ball.radius);
  return gap_m <= height && a_n_mps2 < 0.0 && v_n_mps * v_n_mps <= -2.0 * a_n_mps2 * height;
}

bool lies_on(const Ball& ball, const Wall& wall, const Vec3& acceleration) {
  const double gap = wall.normal.dot(ball.position) - wall.offset - ball.radius;
  return lies(gap, wall.normal.dot(ball.velocity), wall.normal.dot(acceleration), ball);
}

/// What a wall leaves of gravity.
Vec3 along(const Wall& wall, const Vec3& gravity) {
  return gravity - wall.normal.dot(gravity) * wall.normal;
}

bool lies_on(const Ball& upper, const Vec3& a_upper, const Ball& lower, const Vec3& a_lower) {
  const Vec3 between = upper.position - lower.position;
  if (between.isZero(0.0)) return false;
  const Vec3 normal = between.normalized();
  return lies(between.norm() - upper.radius - lower.radius, normal.dot(upper.velocity - lower.velocity),
              normal.dot(a_upper - a_lower), upper);
}

}  // namespace

std::string lies_at_start(const Scenario& scene) {
  if (!scene.effects.gravity || scene.effects.gravity->isZero(0.0)) return {};
  const Vec3& gravity = *scene.effects.gravity;
  std::vector<Vec3> accelerations;
  std::vector<std::size_t> bearing;  // balls that do not fall freely, so that others can lie on them
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    const Ball& ball = scene.balls[i];
    accelerations.push_back(movable(ball) ? gravity : Vec3(Vec3::Zero()));
    const Wall* bearer = nullptr;
    for (const Wall& wall : scene.walls) {
      if (!movable(ball) || !lies_on(ball, wall, accelerations[i])) continue;
      if (bearer)
        return fmt::format("ball {} lies in a corner at the start: it lays balls on one wall only", i);
      if (scene.wall_contact.friction > 0.0) {
        return fmt::format("ball {} lies on a wall with friction at the start: it lets balls only slide", i);
      }
      bearer = &wall;
      accelerations[i] = along(wall, gravity);
    }
    if (bearer || !movable(ball)) bearing.push_back(i);
  }
  if (!scene.effects.collisions) return {};
  for (const std::size_t lower : bearing) {
    for (std::size_t upper = 0; upper < scene.balls.size(); ++upper) {
      if (upper == lower || !(movable(scene.balls[upper]) || movable(scene.balls[lower]))) continue;
      if (lies_on(scene.balls[upper], accelerations[upper], scene.balls[lower], accelerations[lower])) {
        return fmt::format("ball {} lies on ball {} at the start: it lays balls on walls only", upper, lower);
      }
    }
  }
  return {};
}

}  // namespace carom
