#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "reference/closed_form/motion.h"
#include "reference/closed_form/scene_facts.h"

namespace carom::closed_form {

namespace {

/// sin θ / θ
double sinc(double theta) {
  return theta == 0.0 ? 1.0 : std::sin(theta) / theta;
}

/// (1 - cos θ) / θ² = 2 sin²(θ/2) / θ², without the cancellation of the first form.
double versine_quotient(double theta) {
  const double s = sinc(0.5 * theta);
  return 0.5 * s * s;
}

/// (θ - sin θ) / θ² = θ/6 (1 - θ²/20 (1 - θ²/42 (1 - …))). From θ = 1 on at most sin 1 of the 1 cancels;
/// below, the sum.
double lag_quotient(double theta) {
  if (theta >= 1.0) return (1.0 - sinc(theta)) / theta;
  constexpr int kTerms = 8;  // the first one left out is below 6/19! = 5e-17 of the sum
  double sum = 0.0;
  for (int k = kTerms; k >= 1; --k) sum = 1.0 - theta * theta / ((2 * k + 2) * (2 * k + 3)) * sum;
  return theta / 6.0 * sum;
}

/// A ball under gravity and the Magnus force of a spin that nothing changes, m dv/dt = m g + s ω × v. With
/// the axis u = ω/|ω|, the rate Ω = s |ω| / m, θ = Ω t, and ∥ and ⊥ the parts along u and across it,
///
///   v = v∥ + v⊥ cos θ + u × v sin θ + g∥ t + g⊥ t (sin θ)/θ + u × g t (1 - cos θ)/θ                  (1)
///   x = x₀ + v∥ t + v⊥ t (sin θ)/θ + u × v t (1 - cos θ)/θ
///          + ½ g∥ t² + g⊥ t² (1 - cos θ)/θ² + u × g t² (θ - sin θ)/θ²                                (2)
///
/// v and g on the right being those at the start: a free fall along the axis and, across it, a circle of
/// radius |v⊥ - d|/Ω about a point that drifts at d = -u × g/Ω, where the two forces balance. (1) by putting
/// it into the equation of motion, (2) by integrating it; it is the motion of a charge in crossed fields.
class MagnusFlight {
 public:
  MagnusFlight(const Ball& ball, const Effects& effects)
      : x_(ball.position), v_(ball.velocity), g_(acceleration_of(ball, effects)) {
    const Vec3 turning = ball.spin * (*effects.magnus / ball.mass);
    rate_ = turning.norm();
    if (rate_ > 0.0) axis_ = turning / rate_;
  }

  Vec3 position(double t) const {
    const double theta = rate_ * t;
    const double versine = versine_quotient(theta);
    const double lag = lag_quotient(theta);
    const Vec3 by_velocity = along(v_) + across(v_) * sinc(theta) + axis_.cross(v_) * (theta * versine);
    const Vec3 by_gravity = along(g_) * 0.5 + across(g_) * versine + axis_.cross(g_) * lag;
    return x_ + (by_velocity + by_gravity * t) * t;
  }

  Vec3 velocity(double t) const {
    const double theta = rate_ * t;
    const double versine = theta * versine_quotient(theta);
    const Vec3 turned = along(v_) + across(v_) * std::cos(theta) + axis_.cross(v_) * std::sin(theta);
    return turned + (along(g_) + across(g_) * sinc(theta) + axis_.cross(g_) * versine) * t;
  }

  /// No shorter than the path, as the Magnus force does no work and gravity adds at most g t to the speed.
  double path_m(double t) const { return (v_.norm() + 0.5 * g_.norm() * t) * t; }

  /// No shorter than the way from the start to any place up to then: the circle, the drift and the fall.
  double reach_m(double t) const {
    if (rate_ == 0.0) return path_m(t);
    const Vec3 drift = axis_.cross(g_) / -rate_;
    const double circle = 2.0 * (across(v_) - drift).norm() / rate_;
    const double fall = (along(v_).norm() + 0.5 * along(g_).norm() * t) * t;
    return std::min(path_m(t), circle + drift.norm() * t + fall);
  }

 private:
  Vec3 along(const Vec3& v) const { return axis_ * axis_.dot(v); }
  Vec3 across(const Vec3& v) const { return v - along(v); }

  Vec3 x_;
  Vec3 v_;
  Vec3 g_;
  Vec3 axis_ = Vec3::Zero();
  double rate_ = 0.0;  // rad/s
};

class MagnusMotion final : public Motion {
 public:
  MagnusMotion(const Scenario& scenario, std::vector<MagnusFlight> flights)
      : scenario_(scenario), flights_(std::move(flights)) {}

  std::string_view family() const override { return "Magnus flight"; }

  void evaluate(const Twofold& time_s, std::span<BallState> balls) const override {
    for (std::size_t i = 0; i < balls.size(); ++i) {
      balls[i].position = flights_[i].position(time_s.hi);
      balls[i].velocity = flights_[i].velocity(time_s.hi);
    }
  }

  Tally tally(const Twofold&) const override { return {}; }

  /// In ε of the path, along (2): the axis is off by 2 ε of 1 (the product, the norm, the quotient) and Ω by
  /// as much, θ by 3. v∥ then by 6 (the axis twice, and the scalar and the last product), v⊥ by 7, u × v
  /// by 4. The coefficients move by no more than θ's relative error, 3, and have 2 roundings of their own: 5
  /// each; three sums, and the products with t, 4. In all 6 + (7 + 5) + (4 + 5) + 4 = 31 for velocity, and
  /// for gravity no more. And ε of the place for the last sum.
  double uncertainty_m() const override {
    constexpr double kRoundings = 32.0;
    double path = 0.0;
    for (const MagnusFlight& flight : flights_) path = std::max(path, flight.path_m(scenario_.duration_s));
    return kRoundings * kEpsilon * path + rounding_bound_m(scenario_, scale_m(scenario_) + path);
  }

 private:
  const Scenario& scenario_;
  std::vector<MagnusFlight> flights_;
};

}  // namespace

Attempt try_magnus(const Scenario& scenario) {
  if (!has_magnus(scenario)) return {};
  if (has_drag(scenario)) return {nullptr, "the Magnus force and drag"};
  if (scenario.effects.collisions && scenario.balls.size() > 1) {
    return {nullptr, "the Magnus force, and several balls that can meet"};
  }
  std::vector<MagnusFlight> flights;
  for (std::size_t i = 0; i < scenario.balls.size(); ++i) {
    const Ball& ball = scenario.balls[i];
    const MagnusFlight& flight = flights.emplace_back(ball, scenario.effects);
    const double reach = flight.reach_m(scenario.duration_s);
    for (const Wall& wall : scenario.walls) {
      if (gap_m(wall, ball.radius, ball.position) < reach - touch_m(scenario)) {
        return {nullptr, fmt::format("the Magnus force, and ball {} can reach a wall", i)};
      }
    }
  }
  return {std::make_unique<MagnusMotion>(scenario, std::move(flights)), {}};
}

}  // namespace carom::closed_form
