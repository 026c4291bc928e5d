#include "study/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "scenario/parse.h"
#include "tests/study/engines.h"

namespace carom::test {
namespace {

using ::testing::ElementsAre;

constexpr const char* kLongFlight = R"(title = "A flight"
dimension = 2
duration = 3.0
step = 0.1
frames = 7
[[ball]]
mass = 1
radius = 0.1
position = [0, 0]
velocity = [1, 2]
)";

ScenarioPtr flight() {
  return parse_scene(kLongFlight, "flight.toml");
}

std::vector<PlannedPoint> plan_of(const std::vector<EngineChoice>& engines) {
  return plan_scene(*flight(), engines, ask_engines(*flight(), engines, {}, 1));
}

TEST(StudySteps, SpanThreeDecades_InNineWholeNumbers) {
  EXPECT_THAT(study_steps(), ElementsAre(1, 2, 6, 13, 32, 75, 178, 422, 1000));
}

TEST(StudySteps, CutTheFrameInterval_IntoExactlySoManySteps) {
  for (const std::int64_t steps : study_steps()) {
    EXPECT_EQ(steps_per_frame(with_steps(*flight(), steps)), steps);
  }
}

TEST(Plan, HasEveryStepOfEverySetting_AndOneOfWhatIsNoMatterOfSteps) {
  const std::vector<PlannedPoint> plan = plan_of({choice_of<KnownOrder>("a", 1.0)});
  const auto count = [&](const std::string& setting) {
    return std::count_if(plan.begin(), plan.end(),
                         [&](const PlannedPoint& each) { return each.point.setting == setting; });
  };
  EXPECT_EQ(count(""), 9);
  EXPECT_EQ(count("factor = 3"), 9);
  EXPECT_EQ(count("colour = red"), 1);
}

TEST(Plan, GoesEngineByEngine_AtEachStep) {
  const std::vector<PlannedPoint> plan =
      plan_of({choice_of<KnownOrder>("a", 1.0), choice_of<Throws>("b"), choice_of<KnownOrder>("c", 2.0)});
  std::set<std::string> at_first_step;
  for (const PlannedPoint& each : plan) {
    if (each.point.steps_per_frame == 1) at_first_step.insert(each.point.engine);
  }
  EXPECT_THAT(at_first_step, ElementsAre("a", "b", "c"));
  EXPECT_TRUE(std::is_sorted(plan.begin(), plan.end(), [](const PlannedPoint& x, const PlannedPoint& y) {
    return x.point.steps_per_frame < y.point.steps_per_frame;
  }));
}

TEST(Plan, TakesTheClaim_FromTheEngine) {
  const std::vector<EngineChoice> engines = {choice_of<KnownOrder>("a", 2.0), choice_of<Throws>("b")};
  const std::vector<Answer> answers = ask_engines(*flight(), engines, {}, 1);
  EXPECT_TRUE(answers[0].engine.claims);
  EXPECT_EQ(answers[0].engine.claimed_order, 2);
  EXPECT_FALSE(answers[1].engine.claims);
  EXPECT_TRUE(answers[1].tunings.empty());
}

}  // namespace
}  // namespace carom::test
