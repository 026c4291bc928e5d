#include "comparison/baseline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "comparison/baseline_file.h"
#include "core/random.h"
#include "tests/support/numbers.h"

namespace carom::test {
namespace {

/// One ball of 1 kg, 10 steps, no impact: 11 updates of ten operations, ε √(3 · 110) of what is rounded.
const double kSumRounding = kEpsilon * std::sqrt(330.0);

Results measured(std::optional<double> energy, std::optional<double> escaped = std::nullopt) {
  auto scene = std::make_shared<Scenario>();
  scene->id = "group/scene";
  scene->sha256 = "abc";
  scene->duration_s = 2.0;
  Ball ball;
  ball.radius = 0.5;
  ball.position = Vec3(0, 3, 0);
  ball.velocity = Vec3(1, 0, 0);
  scene->balls = {ball};
  Results results;
  SceneComparison& comparison = results.scenes.emplace_back();
  comparison.scene = scene;
  RunComparison& run = comparison.runs.emplace_back();
  run.run.engine = "engine";
  run.run.profile = "faithful";
  run.run.precision = "float64";
  run.run.steps = 10;
  run.run.trajectory = Trajectory(*scene);
  for (std::size_t k = 0; k < 2; ++k) {
    run.run.trajectory.frame(k)[0] = {ball.position, ball.velocity, Vec3::Zero()};
  }
  run.metrics[Metric::energy] = energy;
  run.metrics[Metric::escaped] = escaped;
  return results;
}

Results held(const Results& was, Results is, double factor = 2.0) {
  hold_against(baseline_of(was), factor, is);
  return is;
}

bool holds(std::optional<double> was, std::optional<double> is) {
  return held(measured(was), measured(is)).holds();
}

TEST(Baseline, WorseByMoreThanTheFactor_DoesNotHold) {
  EXPECT_TRUE(holds(1e-3, 1e-3));
  EXPECT_TRUE(holds(1e-3, 2e-3));
  EXPECT_FALSE(holds(1e-3, 2.001e-3));
  EXPECT_TRUE(holds(1e-3, 0.0));
  EXPECT_TRUE(held(measured(1e-3), measured(2.9e-3), 3.0).holds());
}

TEST(Baseline, RoundingIsNoRegression_AndWhatIsAboveItIs) {
  for (const double was : {0.0, 1e-17, 1e-16}) {
    EXPECT_TRUE(holds(was, 2e-16));
    EXPECT_TRUE(holds(was, 1.9 * kSumRounding));
    EXPECT_FALSE(holds(was, 2.1 * kSumRounding));
  }
}

TEST(Baseline, CountHasNoRounding) {
  EXPECT_TRUE(held(measured(0.0, 0.0), measured(0.0, 0.0)).holds());
  EXPECT_FALSE(held(measured(0.0, 0.0), measured(0.0, 1.0)).holds());
}

TEST(Baseline, RoundingFloor_IsThatOfTheLargestNumberByTheScale) {
  Results results = measured(0.0);
  SceneComparison& scene = results.scenes[0];
  RunComparison& run = scene.runs[0];
  const auto floor = [&](Metric metric) { return rounding_floor(scene, run, metric); };
  // The ball is at y = 3 m and moves at 1 m/s for 2 s: 5 m; its radius is 0.5 m. It is its own centre of
  // mass, so angular momentum is by 0.5 m of the momentum.
  EXPECT_DOUBLE_EQ(floor(Metric::energy), kSumRounding);
  EXPECT_DOUBLE_EQ(floor(Metric::momentum), kSumRounding);
  EXPECT_DOUBLE_EQ(floor(Metric::position), 5.0 * kSumRounding);
  EXPECT_DOUBLE_EQ(floor(Metric::penetration), 10.0 * kSumRounding);
  EXPECT_DOUBLE_EQ(floor(Metric::angular_momentum), 10.0 * kSumRounding);
  scene.truth.uncertainty_m = 1e-3;
  EXPECT_DOUBLE_EQ(floor(Metric::position), 1e-3 + 5.0 * kSumRounding);
  run.run.precision = "float32";
  EXPECT_DOUBLE_EQ(floor(Metric::energy), 0x1p29 * kSumRounding);
}

TEST(Baseline, BetterByMoreThanTheFactor_IsTold) {
  EXPECT_TRUE(held(measured(1e-3), measured(0.6e-3)).baseline->better.empty());
  const Results better = held(measured(1e-3), measured(0.4e-3));
  ASSERT_EQ(better.baseline->better.size(), 1U);
  EXPECT_EQ(better.baseline->better[0].baseline, 1e-3);
  EXPECT_TRUE(held(measured(1e-16), measured(0.0)).baseline->better.empty());
}

TEST(Baseline, MetricThatCannotBeToldAnyMore_DoesNotHold) {
  const Results results = held(measured(1e-3), measured(std::nullopt));
  EXPECT_FALSE(results.holds());
  EXPECT_FALSE(results.scenes[0].runs[0].gates[0].value);
}

TEST(Baseline, MetricThatIsNew_IsTold) {
  const Results results = held(measured(std::nullopt), measured(1e-3));
  EXPECT_TRUE(results.holds());
  ASSERT_EQ(results.baseline->not_compared.size(), 1U);
  EXPECT_EQ(results.baseline->not_compared[0].what[0], "group/scene engine energy");
}

TEST(Baseline, Merged_KeepsWhatDidNotTakePart_UnlessTheSceneIsAnother) {
  Baseline older = baseline_of(measured(1.0));
  older.scenes["group/scene"].engines["other"] = {};
  older.scenes["group/more"] = {};
  const Baseline newer = baseline_of(measured(0.5));
  Baseline both = merged(older, newer);
  EXPECT_EQ(both.scenes.size(), 2U);
  EXPECT_TRUE(both.scenes["group/scene"].engines.contains("other"));
  EXPECT_EQ(both.scenes["group/scene"].engines["engine"][Metric::energy], 0.5);
  older.scenes["group/scene"].sha256 = "before";
  EXPECT_FALSE(merged(older, newer).scenes["group/scene"].engines.contains("other"));
}

TEST(BaselineFile, ReadsBackToTheSameDoubles) {
  Random random(11);
  for (int trial = 0; trial < 100; ++trial) {
    Results results = measured(std::ldexp(random.uniform(), static_cast<int>(random.uniform(-900.0, 900.0))));
    results.seed = static_cast<std::uint64_t>(trial);
    Baseline written = baseline_of(results);
    written.scenes["group/scene"].engines["na\"me\n@x"] = {};
    const Baseline read = parse_baseline(baseline_json(written), "file");
    ASSERT_EQ(read.scenes.size(), 1U);
    const BaselineScene& scene = read.scenes.at("group/scene");
    EXPECT_TRUE(scene.same_scene(written.scenes.at("group/scene")));
    EXPECT_EQ(scene.engines.size(), 2U);
    EXPECT_EQ(scene.engines.at("engine")[Metric::energy], results.scenes[0].runs[0].metrics[Metric::energy]);
    EXPECT_EQ(baseline_json(read), baseline_json(written));
  }
}

}  // namespace
}  // namespace carom::test
