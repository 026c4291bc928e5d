#include "comparison/predictability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "comparison/compare.h"

namespace carom::test {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// One ball at speed 1 along x for 10 s in 100 frames; L of the rounding bound is 10 m, the tolerance 1e-4 m.
std::shared_ptr<Scenario> scene_of_ten_seconds() {
  auto scene = std::make_shared<Scenario>();
  scene->duration_s = 10.0;
  scene->frames = 100;
  Ball ball;
  ball.radius = 0.1;
  ball.velocity = Vec3(1, 0, 0);
  scene->balls = {ball};
  return scene;
}

/// The straight flight with this error of its x at each time.
template <class ErrorAt>
Trajectory flight(const Scenario& scene, const ErrorAt& error_at) {
  Trajectory trajectory(scene);
  for (std::size_t k = 0; k < trajectory.frames(); ++k) {
    const double t = trajectory.time(k);
    trajectory.frame(k)[0] = {Vec3(t + error_at(t), 0, 0), Vec3(1, 0, 0), Vec3::Zero()};
  }
  return trajectory;
}

/// A truth in which errors grow like e^{λt}.
Truth truth_of(const Scenario& scene, double growth_rate_per_s) {
  Truth truth;
  truth.kind = "exact";
  truth.trajectory = flight(scene, [](double) { return 0.0; });
  for (std::size_t k = 0; k < truth.trajectory.frames(); ++k) {
    truth.solution.amplification.push_back(std::exp(growth_rate_per_s * truth.trajectory.time(k)));
  }
  return truth;
}

template <class ErrorAt>
RunComparison judged(double growth_rate_per_s, const ErrorAt& error_at, const char* precision = "float64",
                     const std::vector<TrueImpact>& impacts = {}) {
  const auto scene = scene_of_ten_seconds();
  Truth truth = truth_of(*scene, growth_rate_per_s);
  truth.solution.impacts = impacts;
  carom::Run run;
  run.engine = "engine";
  run.profile = "faithful";
  run.precision = precision;
  run.trajectory = flight(*scene, error_at);
  return compare(scene, std::move(truth), {run}, {}).runs.front();
}

TEST(Predictability, GrowthRate_IsFound_WhereErrorsGrowExponentially) {
  const auto scene = scene_of_ten_seconds();
  for (const double rate : {1.0, 2.5, 4.0}) {
    const Predictability found = predictability_of(*scene, truth_of(*scene, rate), 1e-4);
    ASSERT_TRUE(found.growth_rate_per_s);
    // The fit of an exact exponential is exact but for the rounding of its logarithms.
    EXPECT_NEAR(*found.growth_rate_per_s, rate, 1e-12 * rate);
    EXPECT_NEAR(found.growth_r_squared, 1.0, 1e-12);
  }
}

TEST(Predictability, Horizon_IsWhereRoundingReachesTheTolerance) {
  const auto scene = scene_of_ten_seconds();
  const double rate = 4.0;
  // (1) of rounding_growth_m(): 8 roundings, √(2·2·1) directions, L = 10 m at the end of the flight.
  const double start_m = 8.0 * 2.0 * kEps * 10.0;
  const double expected_s = std::log(1e-4 / start_m) / rate;
  const Predictability found = predictability_of(*scene, truth_of(*scene, rate), 1e-4);
  ASSERT_TRUE(found.horizon_s);
  EXPECT_LE(*found.horizon_s, expected_s);
  EXPECT_GT(*found.horizon_s, expected_s - 2.0 * 0.1);  // frames are 0.1 s apart
}

TEST(Predictability, OfACalmScene_HasNoHorizon) {
  const auto scene = scene_of_ten_seconds();
  EXPECT_FALSE(predictability_of(*scene, truth_of(*scene, 0.1), 1e-4).horizon_s);
}

TEST(Predictability, WithoutAmplification_IsNotKnown) {
  const auto scene = scene_of_ten_seconds();
  Truth truth = truth_of(*scene, 4.0);
  truth.solution.amplification.clear();
  const Predictability found = predictability_of(*scene, truth, 1e-4);
  EXPECT_FALSE(found.growth_rate_per_s);
  EXPECT_FALSE(found.horizon_s);
}

TEST(Predictability, Horizon_EndsThePositionMetric) {
  // Wrong by a metre from 9 s on, when no double can know.
  const RunComparison run = judged(4.0, [](double t) { return t > 9.0 ? 1.0 : 0.0; });
  EXPECT_EQ(run.metrics[Metric::position], 0.0);
  EXPECT_TRUE(std::isnan(run.series.position.back()));
}

TEST(Judgement, OfRoundingThatStaysSmall_IsExact) {
  const RunComparison run = judged(0.1, [](double t) { return kEps * t; });
  ASSERT_TRUE(run.judgement);
  EXPECT_EQ(run.judgement->accuracy, Accuracy::exact);
  EXPECT_FALSE(run.judgement->beyond_rounding_s);
}

TEST(Judgement, OfSmallErrorsBeyondRounding_IsWithinTolerance) {
  const RunComparison run = judged(0.1, [](double t) { return t > 2.0 ? 1e-6 : 0.0; });
  EXPECT_EQ(run.judgement->accuracy, Accuracy::within_tolerance);
  EXPECT_NEAR(*run.judgement->beyond_rounding_s, 2.0, 0.1 + 1e-9);
}

TEST(Judgement, OfRoundingGrownByTheScene_IsChaos_InSinglePrecision) {
  // A float's rounding passes the tolerance long before a double's does.
  const double float_eps = std::numeric_limits<float>::epsilon();
  const auto grown = [&](double t) { return float_eps * std::exp(2.0 * t); };
  EXPECT_EQ(judged(2.0, grown, "float32").judgement->accuracy, Accuracy::chaos);
  EXPECT_EQ(judged(2.0, grown, "float64").judgement->accuracy, Accuracy::systematic);
}

TEST(Judgement, OfAWrongStart_IsSystematic_FromThatMoment) {
  const RunComparison run = judged(2.0, [](double t) { return t > 1.0 ? 0.01 : 0.0; });
  EXPECT_EQ(run.judgement->accuracy, Accuracy::systematic);
  EXPECT_NEAR(*run.judgement->beyond_rounding_s, 1.0, 0.1 + 1e-9);
}

TEST(Judgement, NeedsATruth) {
  const auto scene = scene_of_ten_seconds();
  carom::Run run;
  run.trajectory = flight(*scene, [](double) { return 0.0; });
  EXPECT_FALSE(compare(scene, Truth{}, {run}, {}).runs.front().judgement);
}

TEST(Divergence, Cause_IsTheImpactFromWhichTheErrorGrew) {
  // Off by 1 mm/s from 3 s on: seen (1e-4 m) at 3.1 s. Before and after that there were other impacts.
  const auto late = [](double t) { return t > 3.0 ? 1e-3 * (t - 3.0) : 0.0; };
  const std::vector<TrueImpact> impacts = {{1.0, 0, 2, true}, {2.99, 0, 1, true}, {3.35, 0, 3, true}};
  const RunComparison run = judged(0.1, late, "float64", impacts);
  ASSERT_TRUE(run.first_divergence);
  ASSERT_TRUE(run.first_divergence->cause);
  EXPECT_EQ(run.first_divergence->cause->partner, 1U);
}

TEST(Divergence, InFlight_HasNoCause) {
  const auto drift = [](double t) { return 1e-3 * t; };
  const RunComparison run = judged(0.1, drift, "float64", {{5.0, 0, 1, true}});
  ASSERT_TRUE(run.first_divergence);
  EXPECT_FALSE(run.first_divergence->cause);
}

}  // namespace
}  // namespace carom::test
