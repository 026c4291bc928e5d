#include "comparison/conserved.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

bool movable(const Ball& ball) {
  return std::isfinite(ball.mass);
}

/// How far gravity pulls the ball down until a wall is in the way; 0 where there is none.
double fall_depth(const Scenario& scenario, const Ball& ball) {
  if (!scenario.effects.gravity || scenario.effects.gravity->isZero(0.0)) return 0.0;
  const Vec3 down = scenario.effects.gravity->normalized();
  double depth = std::numeric_limits<double>::infinity();
  for (const Wall& wall : scenario.walls) {
    const double closing = -wall.normal.dot(down);
    if (closing <= 0.0) continue;
    const double gap = wall.normal.dot(ball.position) - wall.offset - ball.radius;
    depth = std::min(depth, std::max(gap, 0.0) / closing);
  }
  return std::isfinite(depth) ? depth : 0.0;
}

/// The farthest that any ball's surface is from the origin, m; the box's size where there is one.
double scene_size(const Scenario& scenario, const Vec3& origin) {
  if (scenario.box) return (scenario.box->max - scenario.box->min).norm();
  double size = 0.0;
  for (const Ball& ball : scenario.balls)
    size = std::max(size, (ball.position - origin).norm() + ball.radius);
  return size;
}

/// What events bring in, from the file alone: the velocities that they set, and the balls that they add.
struct Given {
  std::vector<Ball> added;
  double momentum_Ns = 0.0;  ///< Σ m|v|
  double energy_J = 0.0;     ///< Σ ½ m v²
};

Given given_by_events(const Scenario& scene) {
  Given given;
  Cast cast(scene);
  while (cast.next() != nullptr) {
    for (const BallChange& change : cast.take_next()) {
      if (!change.before) given.added.push_back(*change.after);
      const bool set = change.after && (!change.before || change.before->velocity != change.after->velocity);
      if (!set || !movable(*change.after)) continue;
      given.momentum_Ns += change.after->mass * change.after->velocity.norm();
      given.energy_J += 0.5 * change.after->mass * change.after->velocity.squaredNorm();
    }
  }
  return given;
}

}  // namespace

Reference::Reference(const Scenario& s)
    : scenario(&s), gravity_(s.effects.gravity.value_or(Vec3::Zero())), strength_mps2_(gravity_.norm()) {
  const Cast cast(s);
  std::vector<BallState> states;
  double momentum_sum = 0.0;
  for (const Ball& ball : s.balls) {
    states.push_back({ball.position, ball.velocity, ball.spin});
    begin(ball);
    if (!movable(ball)) continue;
    mass_kg += ball.mass;
    origin += ball.mass * ball.position;
    origin_velocity += ball.mass * ball.velocity;
    momentum_sum += ball.mass * ball.velocity.norm();
  }
  if (mass_kg > 0.0) {
    origin /= mass_kg;
    origin_velocity /= mass_kg;
  }
  const Given given = given_by_events(s);
  for (const Ball& added : given.added) begin(added);
  states.resize(cast.size());
  start = of(states, cast);
  const double gravity_impulse = s.effects.gravity ? mass_kg * s.effects.gravity->norm() * s.duration_s : 0.0;
  momentum_scale_Ns = momentum_sum > 0.0 ? momentum_sum : gravity_impulse;
  if (momentum_scale_Ns == 0.0) momentum_scale_Ns = given.momentum_Ns;
  energy_scale_J = start.energy_J;
  if (energy_scale_J == 0.0 && mass_kg > 0.0) {
    energy_scale_J = 0.5 * gravity_impulse * gravity_impulse / mass_kg;
  }
  if (energy_scale_J == 0.0) energy_scale_J = given.energy_J;
  angular_momentum_scale_Nms = momentum_scale_Ns * scene_size(s, origin);
}

void Reference::begin(const Ball& ball) {
  fall_m.push_back(fall_depth(*scenario, ball));
  home.push_back(ball.position);
}

Conserved Reference::of(std::span<const BallState> balls, const Cast& cast) const {
  Conserved sum;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    if (!cast[i] || !movable(*cast[i])) continue;
    add(*cast[i], balls[i], i, sum);
  }
  return sum;
}

Conserved Reference::of(const Ball& ball, std::size_t number) const {
  Conserved one;
  if (movable(ball)) add(ball, {ball.position, ball.velocity, ball.spin}, number, one);
  return one;
}

/// @pre the ball is movable
void Reference::add(const Ball& ball, const BallState& state, std::size_t number, Conserved& sum) const {
  const double moment = ball.inertia * ball.mass * ball.radius * ball.radius;
  sum.energy_J += 0.5 * ball.mass * state.velocity.squaredNorm() + 0.5 * moment * state.spin.squaredNorm() +
                  ball.mass * (strength_mps2_ * fall_m[number] - gravity_.dot(state.position - home[number]));
  sum.momentum_Ns += ball.mass * state.velocity;
  sum.angular_momentum_Nms +=
      ball.mass * (state.position - origin).cross(state.velocity) + moment * state.spin;
}

}  // namespace carom
