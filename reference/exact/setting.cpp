#include "reference/exact/setting.h"

#include <algorithm>
#include <cmath>

namespace carom::exact {

namespace {

Matter matter_of(const Ball& ball) {
  if (std::isinf(ball.mass)) return {ball.radius, 0, 0};
  const Real radius = ball.radius;
  const Real mass = ball.mass;
  return {radius, 1 / mass, 1 / (ball.inertia * mass * radius * radius)};
}

Plane plane_of(const Wall& wall) {
  const Vector normal(wall.normal);
  const Real shorter = 1 / length(normal);
  return {normal * shorter, wall.offset * shorter};
}

}  // namespace

Setting::Setting(const Scenario& scene)
    : wall_matter{0, 0, 0}, gravity_mps2(scene.effects.gravity.value_or(Vec3::Zero())) {
  gravity = scene.effects.gravity && !scene.effects.gravity->isZero(0.0);
  for (const Ball& ball : scene.balls) {
    matter.push_back(matter_of(ball));
    scale_m = std::max(scale_m, ball.position.cwiseAbs().maxCoeff() + ball.radius);
    speed_mps = std::max(speed_mps, ball.velocity.norm() + ball.spin.norm() * ball.radius);
  }
  for (const Wall& wall : scene.walls) {
    walls.push_back(plane_of(wall));
    scale_m = std::max(scale_m, std::abs(wall.offset));
  }
  if (gravity) speed_mps += scene.effects.gravity->norm() * scene.duration_s;
}

Vector Setting::position(std::size_t ball, const Body& body, const Real& time_s) const {
  const Real t = time_s - body.time_s;
  if (t == 0) return body.position_m;
  Vector place = body.position_m + body.velocity_mps * t;
  if (falls(ball)) place += gravity_mps2 * Real(t * t / 2);
  return place;
}

Vector Setting::velocity(std::size_t ball, const Body& body, const Real& time_s) const {
  if (!falls(ball)) return body.velocity_mps;
  return body.velocity_mps + gravity_mps2 * Real(time_s - body.time_s);
}

Body Setting::moved(std::size_t ball, const Body& body, const Real& time_s) const {
  return {time_s, position(ball, body, time_s), velocity(ball, body, time_s), body.spin_radps};
}

}  // namespace carom::exact
