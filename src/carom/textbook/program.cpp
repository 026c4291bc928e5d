#include "carom/textbook/program.h"

namespace carom::textbook {

Program::Program(const Scenario& scene)
    : collide_(scene.effects.collisions), gravity_(scene.effects.gravity.value_or(Vec3::Zero())) {
  balls_.reserve(scene.balls.size());
  for (const Ball& ball : scene.balls) {
    ProgramBall& own = balls_.emplace_back();
    own.mass = static_cast<float>(ball.mass);
    own.radius = static_cast<float>(ball.radius);
    own.x = ball.position.cast<float>();
    own.v = ball.velocity.cast<float>();
  }
  walls_.reserve(scene.walls.size());
  for (const Wall& wall : scene.walls) {
    walls_.push_back({wall.normal.cast<float>(), static_cast<float>(wall.offset)});
  }
  tally_.walls_known = true;
  tally_.energy.known = true;
  set_update(1.0);
}

void Program::set_update(double update_s) {
  fall_ = (gravity_ * update_s * update_s).cast<float>();
  if (update_s == update_s_) return;
  const auto longer = static_cast<float>(update_s / update_s_);
  for (ProgramBall& ball : balls_) ball.v *= longer;
  update_s_ = update_s;
}

void Program::update() {
  for (ProgramBall& ball : balls_) move(ball);
  for (ProgramBall& ball : balls_) meet_walls(ball);
  if (!collide_) return;
  for (ProgramBall& one : balls_) {
    for (ProgramBall& two : balls_) {
      if (&one != &two) meet(one, two);
    }
  }
}

void Program::move(ProgramBall& ball) const {
  ball.v += fall_;
  ball.x += ball.v;
  ball.angle_x += 0.1F * ball.v.x() / ball.radius;
  ball.angle_y += 0.1F * ball.v.y() / ball.radius;
}

void Program::meet_walls(ProgramBall& ball) {
  for (const ProgramWall& wall : walls_) {
    const float s = ball.v.dot(wall.normal);
    if (!(ball.x.dot(wall.normal) - wall.offset < ball.radius && s < 0.0F)) continue;
    const Vec3 before_mps = velocity_mps(ball);
    const double before_J = kinetic_energy(ball);
    ball.v -= 2.0F * s * wall.normal;
    const Vec3 normal = wall.normal.cast<double>();
    const Vec3 impulse_Ns = static_cast<double>(ball.mass) * (velocity_mps(ball) - before_mps);
    const Vec3 contact_m = ball.x.cast<double>() - static_cast<double>(ball.radius) * normal;
    ++tally_.impacts;
    ++tally_.wall_impacts;
    tally_.wall_push_Ns += impulse_Ns.dot(normal);
    tally_.external_impulse += impulse_Ns;
    tally_.external_angular_impulse += contact_m.cross(impulse_Ns);
    tally_.energy.wall_impacts_J += kinetic_energy(ball) - before_J;
  }
}

void Program::meet(ProgramBall& one, ProgramBall& two) {
  const float d = (one.x - two.x).norm();
  if (!(d < one.radius + two.radius)) return;
  exchange(one, two, d);
  push_apart(one, two, d);
}

void Program::exchange(ProgramBall& one, ProgramBall& two, float d) {
  const Vec3f n = (one.x - two.x) / d;
  const float s = (one.v - two.v).dot(n);
  if (!(s <= 0.0F)) return;
  const double before_J = kinetic_energy(one) + kinetic_energy(two);
  const float p = 2.0F * s / (one.mass + two.mass);
  one.v -= p * two.mass * n;
  two.v += p * one.mass * n;
  if (s < 0.0F) ++tally_.impacts;
  tally_.energy.ball_impacts_J += kinetic_energy(one) + kinetic_energy(two) - before_J;
}

void Program::push_apart(ProgramBall& one, ProgramBall& two, float d) {
  const float o = d - (one.radius + two.radius);
  const Vec3f first = -o * (one.x - two.x) / d;
  one.x += first;
  const Vec3f second = o * (one.x - two.x) / d;
  two.x += second;
  tally_.energy.correction_J -= static_cast<double>(one.mass) * gravity_.dot(first.cast<double>()) +
                                static_cast<double>(two.mass) * gravity_.dot(second.cast<double>());
}

double Program::kinetic_energy(const ProgramBall& ball) const {
  return 0.5 * static_cast<double>(ball.mass) * velocity_mps(ball).squaredNorm();
}

}  // namespace carom::textbook
