#include "study/impact_times.h"

#include <gtest/gtest.h>

#include "carom/carom_engine.h"
#include "reference/exact/exact.h"
#include "scenario/parse.h"
#include "study/plan.h"

namespace carom::test {
namespace {

constexpr const char* kDrop = R"(title = "A drop"
dimension = 2
duration = 2.0
step = 0.1
frames = 20
[effects]
gravity = [0, -9.81]
[[wall]]
normal = [0, 1]
offset = 0.0
[[ball]]
mass = 1
radius = 0.1
position = [0, 5.1]
velocity = [0.3, 0]
)";

struct Measured {
  Truth truth;
  Run run;
};

Measured run(const ScenarioPtr& scene, const std::string& engine, std::int64_t steps) {
  const std::shared_ptr<const Engine> carom = make_carom_engine(engine);
  Measured measured;
  measured.truth = record_truth(*scene, {make_exact_truth()}, {});
  measured.run = std::move(run_engines(with_steps(*scene, steps),
                                       {{{engine, [carom]() -> const Engine& { return *carom; }}}}, {}, 1)
                               .front());
  return measured;
}

TEST(ImpactTimes, AreRight_OfAnEngineThatFindsThem) {
  const ScenarioPtr scene = parse_scene(kDrop, "drop.toml");
  const Measured measured = run(scene, "carom:toi", 1);
  const std::optional<double> error_s = impact_time_error_s(*scene, measured.truth, measured.run);
  ASSERT_TRUE(error_s);
  // A place of 5 m rounded in each of 20 steps, passed at 10 m/s: 20 ε 5 m / (10 m/s), twice, for before and
  // after.
  EXPECT_LT(*error_s, 20 * 2.3e-16);
}

TEST(ImpactTimes, AreLateByUpToAStep_OfAnEngineThatLooksAfterwards) {
  const ScenarioPtr scene = parse_scene(kDrop, "drop.toml");
  const Measured measured = run(scene, "carom:step", 32);
  const std::optional<double> error_s = impact_time_error_s(*scene, measured.truth, measured.run);
  ASSERT_TRUE(error_s);
  EXPECT_GT(*error_s, 1e-6);
  EXPECT_LT(*error_s, 0.1 / 32.0);
}

TEST(ImpactTimes, AreNotTold_OfARunThatMissesOne) {
  const ScenarioPtr scene = parse_scene(kDrop, "drop.toml");
  Measured measured = run(scene, "carom:toi", 1);
  // The ball falls on as if there were no floor.
  const double fall_s = 0.1;
  for (std::size_t k = 1; k < measured.run.trajectory.frames(); ++k) {
    measured.run.trajectory.frame(k)[0] = {Vec3(0.03 * static_cast<double>(k), 0.0, 0.0),
                                           Vec3(0.3, -9.81 * fall_s * static_cast<double>(k), 0.0),
                                           Vec3::Zero()};
  }
  EXPECT_FALSE(impact_time_error_s(*scene, measured.truth, measured.run));
}

}  // namespace
}  // namespace carom::test
