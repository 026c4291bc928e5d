#include "study/foresee.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace carom::test {
namespace {

using ::testing::HasSubstr;

StudyPoint run_of(const std::string& engine, const std::string& setting, std::int64_t steps, double cpu_s) {
  StudyPoint point;
  point.engine = engine;
  point.setting = setting;
  point.steps_per_frame = steps;
  point.recorded_cpu_s = cpu_s;
  if (cpu_s > 0.0) point.status = RunStatus::ok;
  return point;
}

TEST(Foresight, GoesWithTheSteps_FromTheLastCoarserRun) {
  const std::vector<StudyPoint> points = {run_of("one", "", 1, 0.5), run_of("two", "", 1, 7.0),
                                          run_of("one", "", 10, 2.0), run_of("one", "", 40, 0.0)};
  EXPECT_EQ(foresee(points, 3).cpu_s, 8.0);
  EXPECT_EQ(foresee({points.begin() + 3, points.end()}, 0).cpu_s, std::nullopt);
}

TEST(Foresight, TakesTheEngineAsItComes_WhereTheSettingWasNotRun) {
  std::vector<StudyPoint> points = {run_of("one", "", 1, 0.5), run_of("one", "rounds = 8", 1, 0.0),
                                    run_of("one", "rounds = 8", 4, 0.0)};
  EXPECT_EQ(foresee(points, 1).cpu_s, 0.5);
  points[1] = run_of("one", "rounds = 8", 1, 3.0);
  EXPECT_EQ(foresee(points, 2).cpu_s, 12.0);
}

TEST(Foresight, IsHopeless_WhereACoarserStepDidNotEnd) {
  std::vector<StudyPoint> points = {run_of("one", "", 1, 0.5), run_of("one", "", 10, 0.0),
                                    run_of("one", "", 20, 0.0)};
  EXPECT_EQ(too_long(foresee(points, 2), 20.0), "");
  points[1].status = RunStatus::timeout;
  EXPECT_THAT(too_long(foresee(points, 2), 20.0), HasSubstr("a coarser step"));
  EXPECT_THAT(too_long(foresee(points, 2), 5.0), HasSubstr("foreseen to take 10 s, longer than 5 s"));
}

}  // namespace
}  // namespace carom::test
