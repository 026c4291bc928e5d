#include "comparison/statistics/cooling.h"

#include <fmt/format.h>

#include <cmath>

namespace carom {

namespace {

constexpr double kFirstCollisions = 5.0;
constexpr double kColdest = 0.1;

double kinetic_energy(const Scenario& scene, std::span<const BallState> balls) {
  double sum = 0.0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    sum += 0.5 * scene.balls[i].mass * balls[i].velocity.squaredNorm();
  }
  return sum;
}

}  // namespace

double sonine_coefficient(int d, double e) {
  const double denominator = 9.0 + 24.0 * d + (8.0 * d - 41.0) * e + 30.0 * e * e * (1.0 - e);
  return 16.0 * (1.0 - e) * (1.0 - 2.0 * e * e) / denominator;
}

double cooling_rate_per_s(int d, double e, double collisions_per_ball_per_s) {
  const double correction = 1.0 + 3.0 / 16.0 * sonine_coefficient(d, e);
  return collisions_per_ball_per_s * (1.0 - e * e) / (2.0 * d) * correction;
}

void measure_cooling(const Gas& gas, const Trajectory& trajectory, RunStatistics& statistics) {
  if (!is_asked(gas, StatisticKind::cooling)) return;
  const double e = gas.scene->ball_contact.restitution;
  const double rate = gas.collisions_per_ball_per_s();
  const double cooling = cooling_rate_per_s(gas.dimension, e, rate);
  const double theory = gas.boxed->virial_error + 3.0 / 16.0 * std::abs(sonine_coefficient(gas.dimension, e));
  Statistic worst;
  worst.kind = StatisticKind::cooling;
  bool any = false;
  for (std::size_t k = 1; k < trajectory.frames(); ++k) {
    const double t = trajectory.time(k);
    // Γ falls with √T.
    const double collisions_per_ball = rate / cooling * std::log1p(cooling * t);
    const double expected = 1.0 / ((1.0 + cooling * t) * (1.0 + cooling * t));
    if (collisions_per_ball < kFirstCollisions) continue;
    if (expected < kColdest) break;
    const double value = kinetic_energy(*gas.scene, trajectory.frame(k)) / gas.energy_J;
    const double collisions = 0.5 * static_cast<double>(gas.balls) * collisions_per_ball;
    const double lost = -std::log(expected);
    const double allowance = expected * lost * std::hypot(std::sqrt(2.0 / collisions), theory);
    const double deviations = std::abs(value - expected) / allowance;
    if (any && deviations <= worst.deviations) continue;
    any = true;
    worst = {StatisticKind::cooling,
             value,
             expected,
             allowance,
             deviations,
             fmt::format("T/T0 at t = {:.3g} s, after {:.0f} collisions of a ball", t, collisions_per_ball)};
  }
  if (any) {
    statistics.all.push_back(worst);
  } else {
    statistics.not_asked.push_back({StatisticKind::cooling, "too short to cool"});
  }
}

}  // namespace carom
