#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "carom/carom_engine.h"
#include "reference/exact/exact.h"

// Inelastic collapse of three equal balls in a line, at its threshold from both sides.
//
// Let p be the speed at which the first ball approaches the second and q that of the second and the third,
// b = (1 + e)/2. An impact of the first two makes of (p, q)
//   (-e p, q + b p),                                                                                     (1)
// and one of the last two, likewise, (p + b q, -e q). One after the other they are the map
//   M = ((b² - e, b), (-e b, -e)),  tr M = b² - 2e,  det M = e². (2)
// Its eigenvalues are real where (tr M)² >= 4 det M, b² >= 4e, e² - 14 e + 1 >= 0: e <= 7 - 4√3. Then the
// larger, λ, has a direction (p, q) with p > 0 that the map keeps, so that impacts never end. Above, M is a
// rotation by φ, cos φ = tr M/(2e), but for a factor e and the choice of axes, and p > 0 lasts for less than
// half a turn:
//   at most 2 ⌈π/φ⌉ + 1 impacts. (3)
// Along that direction, with the gap g at the last two when the first two meet, the last two meet after
// t₁ = g/(q + b p). The first two are then e p t₁ apart and approach at λ p: they meet t₁ e/λ later, and so
// on,
//   t_n = t₀ + t₁ (1 - rⁿ)/(1 - r),  r = e/λ < 1,  t_∞ = t₀ + t₁/(1 - r). (4)
// The threshold: S. McNamara, W. R. Young, Phys. Fluids A 4, 496 (1992).

namespace carom {
namespace {

const double kThreshold = 7.0 - 4.0 * std::numbers::sqrt3;
constexpr double kFirst_s = 0.25;  // t₀, with p = 1
constexpr double kGap_m = 1.0;     // g

/// Three balls of which the first two meet at t₀ at speed 1, when the others are g apart; q < 0.
Scenario three(double restitution, double q_mps, double duration_s) {
  Scenario scene;
  scene.dimension = 2;
  scene.duration_s = duration_s;
  scene.step_s = duration_s;
  scene.frames = 1;
  scene.ball_contact.restitution = scene.wall_contact.restitution = restitution;
  scene.balls.resize(3);
  for (Ball& ball : scene.balls) ball.radius = 0.125;
  scene.balls[0].position.x() = -0.25 - kFirst_s;
  scene.balls[0].velocity.x() = 1.0;
  scene.balls[2].position.x() = 0.25 + kGap_m + q_mps * kFirst_s;
  scene.balls[2].velocity.x() = -q_mps;
  return scene;
}

Solution solved(const Scenario& scene) {
  const auto exact = make_exact_truth();
  const std::vector<Moment> moments = {{scene.duration_s, 0}, {scene.duration_s, 1}};
  return exact->solve(scene, moments, [](std::size_t, std::span<const BallState>, const Tally&) {});
}

std::int64_t impacts_in_carom(const Scenario& scene) {
  const auto engine = make_carom_engine("carom:event");
  const auto simulation = engine->create(scene, "faithful");
  simulation->advance(scene.duration_s, 1);
  return simulation->tally().impacts;
}

/// By (1) alone, from p = 1: impacts until none approach.
std::int64_t impacts_by_map(double e, double q_mps) {
  double approaching = 1.0;
  double other = q_mps;
  std::int64_t count = 0;
  while (approaching > 0.0) {
    const double next = other + 0.5 * (1.0 + e) * approaching;
    other = -e * approaching;
    approaching = next;
    ++count;
  }
  return count;
}

TEST(Collapse, BelowTheThreshold_ImpactsFollowAGeometricSeriesOfTimes) {
  for (const double e : {0.05, 0.06, 0.07}) {
    SCOPED_TRACE(e);
    ASSERT_LT(e, kThreshold);
    const double b = 0.5 * (1.0 + e);
    const double trace = b * b - 2.0 * e;
    const double eigenvalue = 0.5 * (trace + std::sqrt(trace * trace - 4.0 * e * e));
    const double q = (eigenvalue - b * b + e) / b;  // the first row of M
    const double ratio = e / eigenvalue;
    const double second_s = kGap_m / (q + b);
    const auto time_s = [&](double n) {
      return kFirst_s + second_s * (1.0 - std::pow(ratio, n)) / (1.0 - ratio);
    };
    constexpr int kImpacts = 13;
    const Scenario scene = three(e, q, time_s(kImpacts - 0.5));
    const Solution solution = solved(scene);
    ASSERT_EQ(solution.impact_count, kImpacts);
    // Rounding of q and of places, ε each, is gained on by 1/(q + b) < 4 at the second impact; the direction
    // is one that others come closer to.
    const double rounding = 64.0 * std::numeric_limits<double>::epsilon() * time_s(1e9);
    for (int n = 0; n < kImpacts; ++n) {
      EXPECT_NEAR(solution.impacts[static_cast<std::size_t>(n)].time_s, time_s(n), rounding) << n;
    }
    EXPECT_EQ(impacts_in_carom(scene), kImpacts);
    EXPECT_TRUE(std::isfinite(time_s(1e9)));
  }
}

TEST(Collapse, AboveTheThreshold_ImpactsEnd_AfterAsManyAsTheRotationAllows) {
  for (const double e : {kThreshold * 1.02, 0.08, 0.1, 0.2}) {
    SCOPED_TRACE(e);
    const double b = 0.5 * (1.0 + e);
    const double angle = std::acos((b * b - 2.0 * e) / (2.0 * e));
    const double most = 2.0 * std::ceil(std::numbers::pi / angle) + 1.0;
    std::int64_t worst = 0;
    for (int k = 1; k < 20; ++k) {  // with q below -b p the last two never meet
      const double q = -b * k / 20.0;
      const Solution solution = solved(three(e, q, 1e9));  // slow ones meet late
      EXPECT_FALSE(solution.known_until_s.has_value()) << solution.limit;
      EXPECT_EQ(solution.impact_count, impacts_by_map(e, q));
      EXPECT_LE(static_cast<double>(solution.impact_count), most);
      // Places of 1e9 m are off by 1e-7 m in doubles, so Carom counts in a shorter time.
      const Scenario shorter = three(e, q, 100.0);
      EXPECT_EQ(impacts_in_carom(shorter), solved(shorter).impact_count);
      worst = std::max(worst, solution.impact_count);
    }
    EXPECT_GT(static_cast<double>(worst), 0.5 * most);  // the bound is not an empty one
  }
}

}  // namespace
}  // namespace carom
