#include "reference/closed_form/scene_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace carom::closed_form {

bool has_drag(const Scenario& scenario) {
  return scenario.effects.drag && scenario.effects.drag->coefficient > 0.0;
}

bool has_magnus(const Scenario& scenario) {
  return scenario.effects.magnus.value_or(0.0) != 0.0;
}

bool is_immovable(const Ball& ball) {
  return std::isinf(ball.mass);
}

Vec3 acceleration_of(const Ball& ball, const Effects& effects) {
  return is_immovable(ball) ? Vec3::Zero() : effects.gravity.value_or(Vec3::Zero());
}

Twofold horizon_s(const Scenario& scenario) {
  return scenario.duration_s * (1.0 + 2.0 * kEpsilon);
}

double scale_m(const Scenario& scenario) {
  double scale = 0.0;
  for (const Ball& ball : scenario.balls) {
    scale = std::max(scale, ball.position.cwiseAbs().maxCoeff() + ball.radius);
  }
  for (const Wall& wall : scenario.walls) scale = std::max(scale, std::abs(wall.offset));
  return scale;
}

double touch_m(const Scenario& scenario) {
  constexpr double kRoundings = 4.0;
  return kRoundings * kEpsilon * scale_m(scenario);
}

double rounding_bound_m(const Scenario& scenario, double farthest_m) {
  return kEpsilon * farthest_m + touch_m(scenario);
}

double gap_m(const Wall& wall, double radius_m, const Vec3& centre) {
  const Vec3Twofold normal = widened(wall.normal);
  return (normal.dot(widened(centre)) - wall.offset - radius_m).hi;
}

std::string starts_outside(const Scenario& scenario) {
  const double touch = touch_m(scenario);
  for (std::size_t i = 0; i < scenario.balls.size(); ++i) {
    const Ball& ball = scenario.balls[i];
    for (const Wall& wall : scenario.walls) {
      if (gap_m(wall, ball.radius, ball.position) < -touch) {
        return fmt::format("ball {} starts outside a wall", i);
      }
    }
  }
  return {};
}

}  // namespace carom::closed_form
