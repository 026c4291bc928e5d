#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <vector>

#include "carom/compose.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

// By which power of the step the errors fall, measured. Each order is the slope of log error on log step by
// least squares over six steps that halve, from a step that is short against everything in the scene.

namespace carom::test {
namespace {

/// An error is C hᵖ (1 + D h + …). With the longest step h the next term bends a slope over five halvings by
/// about D h/ln 32, and steps are chosen such that D h is below a half: the slope is off by 0.15 at most, and
/// another order would be off by one.
constexpr double kOrderTolerance = 0.15;
constexpr int kHalvings = 5;

/// The order p in error(steps) ~ steps⁻ᵖ, and a record of it under the test's name.
double order_of(std::int64_t fewest_steps, const std::function<double(std::int64_t)>& error) {
  double sum_x = 0.0;
  double sum_y = 0.0;
  double sum_xx = 0.0;
  double sum_xy = 0.0;
  const double count = kHalvings + 1;
  for (int halving = 0; halving <= kHalvings; ++halving) {
    const double x = halving;
    const double y = std::log2(error(fewest_steps << halving));
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  const double order = -(count * sum_xy - sum_x * sum_y) / (count * sum_xx - sum_x * sum_x);
  testing::Test::RecordProperty("order", std::to_string(order));
  return order;
}

Ball ball_of(double mass, double radius, const Vec3& position, const Vec3& velocity) {
  Ball ball;
  ball.mass = mass;
  ball.radius = radius;
  ball.position = position;
  ball.velocity = velocity;
  return ball;
}

BallState end_of(const Scenario& scene, const std::string& evolver, std::int64_t steps) {
  const auto simulation = compose(scene, {evolver, ""});
  return run(*simulation, scene, steps).front();
}

double distance(const BallState& a, const BallState& b) {
  return (a.position - b.position).norm();
}

// --- a pair, hit at 30° off its line of centres

constexpr double kSigma_m = 0.4;
constexpr double kSpeed_mps = 2.0;
const double kSine = 0.5;
const double kCosine = std::sqrt(0.75);

/// Equal smooth balls; the first flies along x past the second, which rests at the origin, at half the sum of
/// their radii. Both fall alike.
Scenario oblique_pair(double start_m, const Vec3& gravity) {
  Scenario scene =
      free_scene(2,
                 {ball_of(1, 0.3 * kSigma_m, Vec3(-start_m, kSine * kSigma_m, 0), Vec3(kSpeed_mps, 0, 0)),
                  ball_of(1, 0.7 * kSigma_m, Vec3::Zero(), Vec3::Zero())},
                 1.0, 0.01);
  if (!gravity.isZero(0.0)) scene.effects.gravity = gravity;
  return scene;
}

/// The first ball loses what it has along the line of centres, v cos 30° of it at (cos 30°, -sin 30°), once
/// the way start - σ cos 30° is flown.
BallState first_after(const Scenario& pair) {
  const Vec3 start = pair.balls[0].position;
  const Vec3 gravity = pair.effects.gravity.value_or(Vec3::Zero());
  const double t = pair.duration_s;
  const double impact_s = (-start.x() - kCosine * kSigma_m) / kSpeed_mps;
  const Vec3 velocity = kSpeed_mps * kSine * Vec3(kSine, kCosine, 0);
  const Vec3 impact_place(-kCosine * kSigma_m, kSine * kSigma_m, 0);
  return {impact_place + (t - impact_s) * velocity + 0.5 * t * t * gravity, velocity + t * gravity,
          Vec3::Zero()};
}

/// The impact comes when it comes within a step. So the error is averaged over starts that are shifted by
/// shares of the way of a step.
double mean_error_of_pair(const std::string& evolver, std::int64_t steps, const Vec3& gravity) {
  constexpr int kPhases = 64;
  double sum = 0.0;
  for (int phase = 0; phase < kPhases; ++phase) {
    const double way_m = kSpeed_mps / static_cast<double>(steps);
    const Scenario scene = oblique_pair(1.0 + way_m * phase / kPhases, gravity);
    sum += distance(end_of(scene, evolver, steps), first_after(scene));
  }
  return sum / kPhases;
}

TEST(StepConvergence, ObliqueImpact_IsOfOrderOne) {
  // Found up to a step too late, the impact is off in place and in direction by what is flown meanwhile.
  const auto error = [](std::int64_t steps) { return mean_error_of_pair("step", steps, Vec3::Zero()); };
  EXPECT_NEAR(order_of(100, error), 1.0, kOrderTolerance);
}

TEST(StepConvergence, ThrownBall_IsOfOrderOne_AndFallsTooFarByHalfAStep) {
  Scenario scene = free_scene(2, {ball_of(2, 0.1, Vec3::Zero(), Vec3(3, 4, 0))}, 1.0, 0.01);
  scene.effects.gravity = Vec3(0, -kGravity, 0);
  const Vec3 exact(3, 4 - 0.5 * kGravity, 0);
  const auto error = [&](std::int64_t steps) {
    return (end_of(scene, "step", steps).position - exact).norm();
  };
  EXPECT_NEAR(order_of(10, error), 1.0, kOrderTolerance);
  // Symplectic Euler: Σ k h² g = ½ g t² + ½ g h t; 40 steps round places of up to 5 m twice each.
  EXPECT_NEAR(error(40), 0.5 * kGravity / 40, 80 * kEpsilon * 5.0);
}

TEST(StepConvergence, SlidingToRolling_IsOfOrderOne) {
  // Slows by μg and rolls after 2 v_0/(7 μ g) at 5/7 v_0; the end of the slide comes within a step.
  constexpr double kFriction = 0.2;
  constexpr double kRadius_m = 0.1;
  Scenario scene =
      free_scene(2, {ball_of(1, kRadius_m, Vec3(0, kRadius_m, 0), Vec3(kSpeed_mps, 0, 0))}, 1.0, 0.01);
  scene.effects.gravity = Vec3(0, -kGravity, 0);
  scene.effects.spin = true;
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.wall_contact = {0.5, kFriction, 0.0};
  const double rolls_s = 2.0 * kSpeed_mps / (7.0 * kFriction * kGravity);
  const double way_m = kSpeed_mps * rolls_s - 0.5 * kFriction * kGravity * rolls_s * rolls_s;
  const double exact_m = way_m + 5.0 / 7.0 * kSpeed_mps * (1.0 - rolls_s);
  const auto error = [&](std::int64_t steps) {
    return std::abs(end_of(scene, "step", steps).position.x() - exact_m);
  };
  EXPECT_NEAR(order_of(50, error), 1.0, kOrderTolerance);
}

TEST(StepConvergence, Gas_IsOfOrderOne_UpToItsFirstImpacts) {
  // Against `toi`, which has no error of a step here. A fifth of a second is about one impact per ball: then
  // errors have not yet grown out of proportion. Impacts at all phases of a step average out over the balls.
  constexpr int kSeeds = 8;
  const auto error = [](std::int64_t steps) {
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      Scenario scene = *gas(2, 60, 0.1, 4.0, seed);
      scene.duration_s = 0.2;
      const auto stepped = compose(scene, {"step", ""});
      const auto exact = compose(scene, {"toi", ""});
      const auto got = run(*stepped, scene, steps);
      const auto expected = run(*exact, scene, 1);
      for (std::size_t i = 0; i < got.size(); ++i) sum += distance(got[i], expected[i]);
    }
    return sum;
  };
  EXPECT_NEAR(order_of(40, error), 1.0, kOrderTolerance);
}

// --- toi: flights that are no parabolas

constexpr double kMass_kg = 2.0;
const Vec3 kThrown(3, 4, 0);  // m/s

Scenario thrown() {
  return free_scene(2, {ball_of(kMass_kg, 0.1, Vec3::Zero(), kThrown)}, 1.0, 0.01);
}

TEST(ToiConvergence, LinearDrag_IsOfOrderTwo) {
  // v = v_T + (v_0 - v_T) e^{-kt}, v_T = g/k, k = c/m; x is its integral.
  Scenario scene = thrown();
  scene.effects.gravity = Vec3(0, -kGravity, 0);
  scene.effects.drag = Drag{Drag::Kind::linear, 1.5};
  const double k = 1.5 / kMass_kg;
  const Vec3 terminal = *scene.effects.gravity / k;
  const Vec3 exact = terminal + (kThrown - terminal) * (-std::expm1(-k) / k);
  const auto error = [&](std::int64_t steps) {
    return (end_of(scene, "toi", steps).position - exact).norm();
  };
  EXPECT_NEAR(order_of(10, error), 2.0, kOrderTolerance);
}

TEST(ToiConvergence, QuadraticDrag_IsOfOrderTwo) {
  // Falls from rest by (v_t²/g) ln cosh(g t/v_t), v_t = √(m g/c).
  Scenario scene = thrown();
  scene.balls[0].velocity.setZero();
  scene.effects.gravity = Vec3(0, -kGravity, 0);
  scene.effects.drag = Drag{Drag::Kind::quadratic, 0.8};
  const double terminal = std::sqrt(kMass_kg * kGravity / 0.8);
  const double exact = -terminal * terminal / kGravity * std::log(std::cosh(kGravity / terminal));
  const auto error = [&](std::int64_t steps) {
    return std::abs(end_of(scene, "toi", steps).position.y() - exact);
  };
  EXPECT_NEAR(order_of(20, error), 2.0, kOrderTolerance);
}

/// With drag c and Magnus s in the plane, v = v_0 e^{zt}, z = (-c + i s ω)/m; x = v_0 (e^z - 1)/z after 1 s.
double error_of_curve(double c, std::int64_t steps) {
  constexpr double kMagnus_kg = 0.5;
  constexpr double kSpin = 8.0;  // rad/s
  Scenario scene = thrown();
  scene.effects.spin = true;
  scene.effects.magnus = kMagnus_kg;
  if (c > 0.0) scene.effects.drag = Drag{Drag::Kind::linear, c};
  scene.balls[0].spin.z() = kSpin;
  const std::complex<double> z(-c / kMass_kg, kMagnus_kg * kSpin / kMass_kg);
  const std::complex<double> exact = std::complex<double>(kThrown.x(), kThrown.y()) * (std::exp(z) - 1.0) / z;
  const Vec3 end = end_of(scene, "toi", steps).position;
  return std::abs(std::complex<double>(end.x(), end.y()) - exact);
}

TEST(ToiConvergence, MagnusCircle_IsOfOrderTwo) {
  EXPECT_NEAR(order_of(20, [](std::int64_t steps) { return error_of_curve(0.0, steps); }), 2.0,
              kOrderTolerance);
}

TEST(ToiConvergence, MagnusSpiralUnderDrag_IsOfOrderTwo) {
  EXPECT_NEAR(order_of(20, [](std::int64_t steps) { return error_of_curve(1.5, steps); }), 2.0,
              kOrderTolerance);
}

TEST(ToiConvergence, BounceUnderDrag_IsOfOrderTwo) {
  // Falls from rest and rebounds elastically. With linear drag the height lost after t is
  // v_T (t - (1 - e^{-kt})/k), whose root is the time of impact: Newton's method from the fall without drag.
  const double k = 0.75;
  const double height_m = 1.0;
  const double terminal = kGravity / k;
  double impact_s = std::sqrt(2.0 * height_m / kGravity);
  for (int i = 0; i < 20; ++i) {
    const double fallen = terminal * (impact_s + std::expm1(-k * impact_s) / k);
    impact_s -= (fallen - height_m) / (-terminal * std::expm1(-k * impact_s));
  }
  const double rebound = -terminal * std::expm1(-k * impact_s);
  Scenario scene = thrown();
  scene.balls[0].position.y() = 0.1 + height_m;
  scene.balls[0].velocity.setZero();
  scene.effects.gravity = Vec3(0, -kGravity, 0);
  scene.effects.drag = Drag{Drag::Kind::linear, k * kMass_kg};
  scene.walls = {{Vec3::UnitY(), 0.0}};
  const auto error = [&](std::int64_t steps) {
    // Steps a little longer each time, so that the impact comes at every share of one.
    constexpr int kPhases = 64;
    constexpr double kShortest_s = 0.8;
    const double impact_steps = impact_s * static_cast<double>(steps) / kShortest_s;
    double sum = 0.0;
    for (int phase = 0; phase < kPhases; ++phase) {
      scene.duration_s = kShortest_s * (1.0 + phase / (kPhases * impact_steps));
      const double t = scene.duration_s - impact_s;
      const double exact = 0.1 - terminal * t + (rebound + terminal) * (-std::expm1(-k * t) / k);
      sum += std::abs(end_of(scene, "toi", steps).position.y() - exact);
    }
    return sum / kPhases;
  };
  EXPECT_NEAR(order_of(20, error), 2.0, kOrderTolerance);
}

// --- what has no error of the step

class Exactness : public testing::TestWithParam<std::tuple<std::string, std::int64_t>> {
 protected:
  static std::string evolver() { return std::get<0>(GetParam()); }
  static std::int64_t steps() { return std::get<1>(GetParam()); }

  /// A step rounds a coordinate of up to 4 m, or m/s, twice; an impact as often as ten steps, and its normal
  /// turns by the place's rounding over σ.
  static double rounding() { return (2.0 * static_cast<double>(steps()) + 20.0 / kSigma_m) * kEpsilon * 4.0; }
};

TEST_P(Exactness, ObliqueImpact_IsRightToRounding_AtAnyStep) {
  for (const Vec3& gravity : {Vec3(0, 0, 0), Vec3(1.5, -kGravity, 0)}) {
    for (const double start : {0.7, 1.0, 1.3}) {
      const Scenario scene = oblique_pair(start, gravity);
      const BallState end = end_of(scene, evolver(), steps());
      const BallState exact = first_after(scene);
      EXPECT_LE(distance(end, exact), rounding()) << "start " << start << ", g " << gravity.transpose();
      EXPECT_LE((end.velocity - exact.velocity).norm(), rounding());
    }
  }
}

TEST_P(Exactness, BouncingBall_IsRightToRounding_AtAnyStep) {
  // From the apex h to the floor takes t_f = √(2h/g). After 9.5 t_f it has bounced five times, at 1, 3, … 9
  // t_f, and is half a t_f before its next apex.
  const double height_m = 1.25;
  const double fall_s = std::sqrt(2.0 * height_m / kGravity);
  Scenario scene =
      free_scene(2, {ball_of(1, 0.1, Vec3(0, 0.1 + height_m, 0), Vec3(0.5, 0, 0))}, 9.5 * fall_s, 0.01);
  scene.effects.gravity = Vec3(0, -kGravity, 0);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  const double left_s = 0.5 * fall_s;
  const double exact = 0.1 + height_m - 0.5 * kGravity * left_s * left_s;
  const BallState end = end_of(scene, evolver(), steps());
  // A bounce is as late as all before it together, so with five bounces the roundings count five times.
  EXPECT_NEAR(end.position.y(), exact, 5.0 * rounding());
  EXPECT_NEAR(end.position.x(), 0.5 * scene.duration_s, rounding());
}

INSTANTIATE_TEST_SUITE_P(Steps, Exactness,
                         testing::Combine(testing::Values("toi", "event"),
                                          testing::Values(1, 2, 3, 10, 77, 640, 5000)));

}  // namespace
}  // namespace carom::test
