#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "reference/closed_form/motion.h"
#include "reference/closed_form/scene_facts.h"

namespace carom::closed_form {

namespace {

/// The flight of one ball; x the centre, t the time since the start.
class Flight {
 public:
  explicit Flight(const Ball& ball) : start_m_(ball.position) {}
  Flight(const Flight&) = delete;
  Flight& operator=(const Flight&) = delete;
  virtual ~Flight() = default;

  Vec3 position(double t_s) const { return start_m_ + moved(t_s); }
  virtual Vec3 moved(double t_s) const = 0;
  virtual Vec3 velocity(double t_s) const = 0;
  /// When the velocity along a direction changes sign, if ever.
  virtual std::optional<double> turn_s(const Vec3& direction) const = 0;
  /// What rounding is proportional to: no shorter than the path up to then.
  virtual double path_m(double t_s) const = 0;

 private:
  Vec3 start_m_;
};

/// (1 - e^-z) / z
double decay_mean(double z) {
  return z == 0.0 ? 1.0 : -std::expm1(-z) / z;
}

/// (z - 1 + e^-z) / z² = Σ (-z)^k / (k+2)!. From z = 1 on at most 1 - 1/e of the 1 cancels; below, the sum.
double decay_mean_of_mean(double z) {
  if (z >= 1.0) return (1.0 - decay_mean(z)) / z;
  constexpr int kTerms = 18;  // the first one left out is below 1/20! = 4e-19 of a sum above 1/3
  double sum = 0.0;
  for (int k = kTerms - 1; k >= 0; --k) sum = (1.0 - z * sum) / (k + 2);
  return sum;
}

/// Linear drag, m dv/dt = m a - c v, with k = c/m and z = k t:
///
///   v = v₀ e^-z + a t φ₁(z)               φ₁(z) = (1 - e^-z) / z           (1)
///   x = x₀ + v₀ t φ₁(z) + a t² φ₂(z)      φ₂(z) = (z - 1 + e^-z) / z²      (2)
///
/// which hold for k = 0 as well. The integral of (1) is (2); any textbook of mechanics.
class LinearDragFlight final : public Flight {
 public:
  LinearDragFlight(const Ball& ball, const Vec3& acceleration, double coefficient)
      : Flight(ball), v_(ball.velocity), a_(acceleration), k_(coefficient / ball.mass) {}

  Vec3 moved(double t) const override {
    return v_ * (t * decay_mean(k_ * t)) + a_ * (t * t * decay_mean_of_mean(k_ * t));
  }
  Vec3 velocity(double t) const override { return v_ * std::exp(-k_ * t) + a_ * (t * decay_mean(k_ * t)); }
  /// (1) is 0 along n where e^z - 1 = -k v_n / a_n.
  std::optional<double> turn_s(const Vec3& n) const override {
    const double v = n.dot(v_);
    const double a = n.dot(a_);
    if (v * a >= 0.0) return std::nullopt;
    return k_ == 0.0 ? -v / a : std::log1p(-k_ * v / a) / k_;
  }
  double path_m(double t) const override {
    return v_.norm() * t * decay_mean(k_ * t) + a_.norm() * t * t * decay_mean_of_mean(k_ * t);
  }

 private:
  Vec3 v_;
  Vec3 a_;
  double k_;  // 1/s
};

/// Quadratic drag alone, m dv/dt = -c |v| v, with q = c/m and w = q |v₀| t:
///
///   v = v₀ / (1 + w),    x = x₀ + v₀ t ln(1 + w) / w                        (3)
class CoastingFlight final : public Flight {
 public:
  CoastingFlight(const Ball& ball, double coefficient)
      : Flight(ball), v_(ball.velocity), rate_(coefficient / ball.mass * ball.velocity.norm()) {}

  Vec3 moved(double t) const override {
    const double w = rate_ * t;
    return v_ * (w == 0.0 ? t : t * (std::log1p(w) / w));
  }
  Vec3 velocity(double t) const override { return v_ / (1.0 + rate_ * t); }
  std::optional<double> turn_s(const Vec3&) const override { return std::nullopt; }
  double path_m(double t) const override { return moved(t).norm(); }

 private:
  Vec3 v_;
  double rate_;  // 1/s
};

/// Quadratic drag along the vertical, m dw/dt = m g - c |w| w, w the speed downwards, y the way down. With
/// q = c/m, v_t = √(g/q) the terminal speed, τ = 1/√(g q), θ = t/τ and β = w₀/v_t:
///
///   β >= 0:  w = v_t (β + tanh θ) / (1 + β tanh θ),     y = ln(cosh θ + β sinh θ) / q     (4)
///   β <  0:  up to the apex at θ = arctan |β|
///            w = -v_t tan(arctan |β| - θ),              y = -ln(cos θ + |β| sin θ) / q    (5)
///            and from there a fall from rest
class VerticalFlight final : public Flight {
 public:
  VerticalFlight(const Ball& ball, const Vec3& gravity, double coefficient)
      : Flight(ball), down_(gravity.normalized()), q_(coefficient / ball.mass) {
    const double g = gravity.norm();
    terminal_mps_ = std::sqrt(g / q_);
    tau_s_ = 1.0 / std::sqrt(g * q_);
    beta_ = ball.velocity.dot(down_) / terminal_mps_;
    apex_s_ = beta_ < 0.0 ? tau_s_ * std::atan(-beta_) : 0.0;
  }

  Vec3 moved(double t) const override {
    return down_ * (t < apex_s_ ? -risen(t) : fallen(t - apex_s_) - risen(apex_s_));
  }
  Vec3 velocity(double t) const override {
    if (t < apex_s_) return down_ * (-terminal_mps_ * std::tan((apex_s_ - t) / tau_s_));
    const double beta = std::max(beta_, 0.0);
    const double tangent = std::tanh((t - apex_s_) / tau_s_);
    return down_ * (terminal_mps_ * (beta + tangent) / (1.0 + beta * tangent));
  }
  std::optional<double> turn_s(const Vec3&) const override { return apex_s_; }
  double path_m(double t) const override {
    return t < apex_s_ ? risen(t) : fallen(t - apex_s_) + risen(apex_s_);
  }

 private:
  /// (5). With cos θ = 1 - 2 sin²(θ/2) nothing is lost where the way is short.
  double risen(double t) const {
    const double theta = t / tau_s_;
    const double s = std::sin(theta / 2.0);
    return std::max(0.0, std::log1p(-beta_ * std::sin(theta) - 2.0 * s * s)) / q_;
  }
  /// (4), with cosh θ = 1 + 2 sinh²(θ/2); beyond θ = 1, where that would overflow at last,
  /// ln(cosh θ + β sinh θ) = θ + ln(½ ((1 + β) + (1 - β) e^-2θ)).
  double fallen(double t) const {
    const double theta = t / tau_s_;
    const double beta = std::max(beta_, 0.0);
    if (theta > 1.0) {
      return (theta + std::log(0.5 * ((1.0 + beta) + (1.0 - beta) * std::exp(-2.0 * theta)))) / q_;
    }
    const double s = std::sinh(theta / 2.0);
    return std::log1p(2.0 * s * s + beta * std::sinh(theta)) / q_;
  }

  Vec3 down_;
  double q_;  // 1/m
  double terminal_mps_ = 0.0;
  double tau_s_ = 0.0;
  double beta_ = 0.0;
  double apex_s_ = 0.0;
};

using Flights = std::vector<std::unique_ptr<Flight>>;

class DragMotion final : public Motion {
 public:
  DragMotion(const Scenario& scenario, Flights flights) : scenario_(scenario), flights_(std::move(flights)) {}

  std::string_view family() const override { return "flight with drag"; }

  void evaluate(const Twofold& time_s, std::span<BallState> balls) const override {
    for (std::size_t i = 0; i < balls.size(); ++i) {
      balls[i].position = flights_[i]->position(time_s.hi);
      balls[i].velocity = flights_[i]->velocity(time_s.hi);
    }
  }

  Tally tally(const Twofold&) const override { return {}; }

  /// Relative errors in ε, along (2): t 1/2; z = k t 3/2; φ₁ 3 (its relative slope is below 1: 3/2 from z,
  /// expm1 1, the quotient 1/2); φ₂ 8 (φ₁'s against 1 - φ₁ >= 1/e, and two quotients); times t, t, a or v 5/2
  /// more; the sum 1: 12. Along (4) and (5): θ 3; y 6 from it (its relative slope is at most 2), 3 from β, 2
  /// from sinh and log1p, 1 from 1/q, 2 from the direction: 14. Hence 16 ε of the path, and ε of the place
  /// for the last sum.
  double uncertainty_m() const override {
    constexpr double kRoundings = 16.0;
    double path = 0.0;
    for (const auto& flight : flights_) path = std::max(path, flight->path_m(scenario_.duration_s));
    return kRoundings * kEpsilon * path + rounding_bound_m(scenario_, scale_m(scenario_) + path);
  }

 private:
  const Scenario& scenario_;
  Flights flights_;
};

/// None where there is no closed form: quadratic drag and gravity off the vertical.
std::unique_ptr<Flight> make_flight(const Ball& ball, const Effects& effects) {
  const double coefficient = effects.drag->coefficient;
  const Vec3 a = acceleration_of(ball, effects);
  if (effects.drag->kind == Drag::Kind::linear || is_immovable(ball)) {
    return std::make_unique<LinearDragFlight>(ball, a, coefficient);
  }
  if (a.isZero(0.0)) return std::make_unique<CoastingFlight>(ball, coefficient);
  if (a.cross(ball.velocity).isZero(0.0)) return std::make_unique<VerticalFlight>(ball, a, coefficient);
  return nullptr;
}

/// Between the start, the turning point and the end the way along the normal is monotone.
bool reaches(const Wall& wall, const Ball& ball, const Flight& flight, double end_s, double touch) {
  const double turn_s = flight.turn_s(wall.normal).value_or(end_s);
  const std::array moments = {0.0, std::min(turn_s, end_s), end_s};
  return std::any_of(moments.begin(), moments.end(),
                     [&](double t) { return gap_m(wall, ball.radius, flight.position(t)) < -touch; });
}

}  // namespace

Attempt try_drag(const Scenario& scenario) {
  if (!has_drag(scenario) || has_magnus(scenario)) return {};
  if (scenario.effects.collisions && scenario.balls.size() > 1) {
    return {nullptr, "drag, and several balls that can meet"};
  }
  const double touch = touch_m(scenario);
  Flights flights;
  for (std::size_t i = 0; i < scenario.balls.size(); ++i) {
    const Ball& ball = scenario.balls[i];
    flights.push_back(make_flight(ball, scenario.effects));
    if (!flights.back()) return {nullptr, "quadratic drag and gravity, off the vertical"};
    for (const Wall& wall : scenario.walls) {
      if (reaches(wall, ball, *flights.back(), scenario.duration_s, touch)) {
        return {nullptr, fmt::format("drag, and ball {} reaches a wall", i)};
      }
    }
  }
  return {std::make_unique<DragMotion>(scenario, std::move(flights)), {}};
}

}  // namespace carom::closed_form
