#include "study/measure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "reference/closed_form/closed_form.h"
#include "scenario/parse.h"
#include "study/analyse.h"
#include "study/foresee.h"
#include "study/study_json.h"
#include "tests/study/engines.h"

namespace carom::test {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr const char* kFlight = R"(title = "A flight"
dimension = 2
duration = 1.0
step = 0.1
frames = 4
[[ball]]
mass = 1
radius = 0.1
position = [0, 0]
velocity = [1, 2]
)";

const StudyLimits kLimits{2.0, 4096.0, 2, 30.0};

StudyScene measured(const std::vector<EngineChoice>& engines, StudyScene before = {},
                    const StudyWatch& watch = {}, const StudyLimits& limits = kLimits) {
  measure_scene(parse_scene(kFlight, "flight.toml"), engines, {make_closed_form_truth()}, limits, 2, watch,
                before);
  return before;
}

/// Everything but the times, which no two runs have the same.
std::string rows_of(StudyScene scene) {
  for (StudyPoint& point : scene.points) {
    point.recorded_cpu_s = 0.0;
    for (double& each : point.cpu_s) each = 0.0;
  }
  Study study;
  study.scenes.push_back(std::move(scene));
  return study_json(study);
}

TEST(StudyMeasurement, FindsTheOrder_OfAnEngineThatHasOne) {
  for (const int order : {1, 2}) {
    const StudyScene scene = measured({choice_of<KnownOrder>("known", static_cast<double>(order))});
    for (const Series& series : series_of(scene)) {
      if (series.points.size() < kFewestToFit) continue;
      const Order fit = order_of(scene, series);
      ASSERT_EQ(fit.kind, Order::Kind::fitted);
      // The errors are C hᵖ t but for the rounding of places of 2 m, ε × 2 m / (1e-7 m) relative at the
      // finest step of order 2; a logarithm that is off by that turns a slope over ln 1000 by less.
      EXPECT_NEAR(fit.order, order, 1e-8) << series.setting;
    }
  }
}

TEST(StudyMeasurement, TimesEachSetting_AsOftenAsAsked) {
  const StudyScene scene = measured({choice_of<KnownOrder>("known", 1.0)});
  for (const StudyPoint& point : scene.points) {
    EXPECT_THAT(point.cpu_s, SizeIs(kLimits.repeats));
    EXPECT_GT(point.cpu_s.front(), 0.0);
    EXPECT_EQ(point.steps, 4 * point.steps_per_frame);
  }
}

TEST(StudyMeasurement, KeepsWhatFails_WithItsReason) {
  const StudyScene scene = measured({choice_of<Throws>("throws"), choice_of<KnownOrder>("known", 1.0)});
  for (const StudyPoint& point : scene.points) {
    if (point.engine != "throws") {
      EXPECT_EQ(point.status, RunStatus::ok);
      continue;
    }
    EXPECT_EQ(point.status, RunStatus::crashed);
    EXPECT_THAT(point.reason, HasSubstr("no world today"));
    EXPECT_TRUE(point.cpu_s.empty());
  }
}

TEST(StudyMeasurement, GivesTheSameRows_WhereverItIsStoppedAndResumed) {
  const std::vector<EngineChoice> engines = {choice_of<KnownOrder>("known", 1.0),
                                             choice_of<Throws>("throws")};
  const std::string whole = rows_of(measured(engines));
  // Each change in turn stops it once more.
  for (const int changes : {1, 2, 5, 17}) {
    StudyScene stopped;
    int left = changes;
    StudyWatch watch;
    watch.changed = [&left] {
      if (--left == 0) throw std::runtime_error("stopped");
    };
    EXPECT_THROW(measure_scene(parse_scene(kFlight, "flight.toml"), engines, {make_closed_form_truth()},
                               kLimits, 2, watch, stopped),
                 std::runtime_error);
    // By way of the file that it is kept in.
    Study study;
    study.scenes.push_back(stopped);
    const StudyScene kept = parse_study(study_json(study), "kept.json").scenes.front();
    EXPECT_EQ(rows_of(measured(engines, kept)), whole) << "stopped after " << changes;
  }
}

TEST(StudyMeasurement, DoesNotMeasureAgain_WhatIsKnown) {
  const std::vector<EngineChoice> engines = {choice_of<KnownOrder>("known", 1.0)};
  const StudyScene first = measured(engines);
  std::size_t runs = 0;
  StudyWatch watch;
  watch.more = [&runs](std::size_t more) { runs += more; };
  const StudyScene second = measured(engines, first, watch);
  EXPECT_EQ(runs, 0U);
  EXPECT_EQ(second.points.front().cpu_s, first.points.front().cpu_s);
}

TEST(StudyMeasurement, LeavesOut_WhatIsForeseenToTakeTooLong) {
  // The finest step takes 4000 × 50 µs.
  const StudyScene scene = measured({choice_of<Slow>("slow")}, {}, {}, {0.05, 4096.0, 1, 30.0});
  EXPECT_THAT(scene.points.front().cpu_s, SizeIs(1));
  EXPECT_EQ(scene.points.back().status, RunStatus::timeout);
  EXPECT_THAT(scene.points.back().reason, HasSubstr("longer than 0.05 s"));
}

TEST(StudyMeasurement, DoesNotTime_WhatTookTooLong) {
  const double timeout_s = 2.0 * SlowSimulation::kStepCost_s;  // less than the four coarsest steps take
  const StudyScene scene = measured({choice_of<Slow>("slow")}, {}, {}, {timeout_s, 4096.0, 1, 30.0});
  EXPECT_EQ(scene.points.front().status, RunStatus::ok);
  EXPECT_TRUE(scene.points.front().errors.position_m);
  EXPECT_THAT(scene.points.front().cpu_s, SizeIs(0));
  EXPECT_THAT(scene.points.front().untimed, HasSubstr("longer than 0.0001 s"));
}

TEST(StudyMeasurement, KeepsToItsBudget_AndTimesWhatWasRun) {
  const StudyScene scene =
      measured({choice_of<Slow>("slow"), choice_of<KnownOrder>("known", 1.0)}, {}, {}, {2.0, 4096.0, 1, 0.1});
  EXPECT_EQ(scene.points.front().status, RunStatus::ok);
  for (const StudyPoint& point : scene.points) {
    if (point.status == RunStatus::ok) {
      EXPECT_THAT(point.cpu_s, SizeIs(1));
    } else {
      EXPECT_EQ(point.status, RunStatus::timeout);
    }
  }
  // The finest step takes 0.2 s, which are more than there is.
  EXPECT_THAT(scene.points, Contains(Field(&StudyPoint::reason, HasSubstr("budget of 0.1 s"))));
}

TEST(StudyMeasurement, StopsBeforeTheNextRun_WhenAsked) {
  const std::vector<EngineChoice> engines = {choice_of<KnownOrder>("known", 1.0)};
  const std::string whole = rows_of(measured(engines));
  for (const int changes : {0, 1, 3, 30}) {
    int seen = 0;
    StudyWatch watch;
    watch.changed = [&] { ++seen; };
    watch.stopped = [&] { return seen >= changes; };
    const StudyScene stopped = measured(engines, {}, watch);
    EXPECT_EQ(seen, changes);
    EXPECT_EQ(rows_of(measured(engines, stopped)), whole) << "stopped after " << changes;
  }
}

TEST(StudyRepeats, AreFewer_OfALongRun) {
  EXPECT_EQ(repeats_for(1e-3, 5), 5);
  EXPECT_EQ(repeats_for(1.0, 5), 3);
  EXPECT_EQ(repeats_for(1.0, 1), 1);
}

}  // namespace
}  // namespace carom::test
