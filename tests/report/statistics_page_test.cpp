#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "report/json.h"
#include "report/page/statistics.h"

namespace carom::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

RunComparison run_named(const std::string& engine) {
  RunComparison run;
  run.run.engine = engine;
  run.run.profile = "faithful";
  return run;
}

/// A gas with one engine as expected, one that is off, and one that crashed.
SceneComparison gas() {
  auto scene = std::make_shared<Scenario>();
  scene->id = "statistics/gas";
  scene->dimension = 3;
  scene->balls.resize(1);
  SceneComparison made;
  made.scene = scene;
  SceneStatistics asked;
  asked.not_asked = {{StatisticKind::cooling, "impacts take no energy"}};
  asked.warm_up_s = 2.5;
  asked.collisions_per_ball = 75.0;
  asked.cell_width = 1.0;
  asked.speed_density = {0.2, 0.5, 0.25, 0.05};
  made.statistics = asked;
  RunComparison good = run_named("good");
  good.statistics = RunStatistics{
      {{StatisticKind::collision_rate, 4.4, 4.5, 0.1, 1.0, "chance"}}, {}, {0.2, 0.5, 0.2, 0.1}};
  RunComparison off = run_named("off");
  off.statistics = RunStatistics{
      {{StatisticKind::collision_rate, 3.0, 4.5, 0.1, 15.0, "chance"}}, {}, {0.0, 1.0, 0.0, 0.0}};
  RunComparison dead = run_named("dead");
  dead.run.status = RunStatus::crashed;
  made.runs = {good, off, dead};
  made.pairs = {{0, 1, 1.0, 1.0, {}, {}, {}, Divergence{0.25, {3}, Metric::position}}};
  return made;
}

std::string markup_of(const SceneComparison& scene) {
  pugi::xml_document document;
  page::add_statistics(document.append_child("main"), scene, page::Legend({scene}));
  std::ostringstream text;
  document.save(text, "", pugi::format_raw | pugi::format_no_declaration);
  return text.str();
}

TEST(StatisticsPage, SaysWhoIsAsExpected_AndWhoIsOffByHowMuch) {
  const std::string text = markup_of(gas());
  EXPECT_THAT(text, AllOf(HasSubstr("✓</span> as expected"), HasSubstr("4.4; 4.5 ± 0.1")));
  EXPECT_THAT(text, AllOf(HasSubstr("✗</span> off by 15"), HasSubstr("3; 4.5 ± 0.1")));
  EXPECT_THAT(text, HasSubstr("crashed"));
  EXPECT_THAT(text, HasSubstr("first 2.5 s are left out"));
  EXPECT_THAT(text, HasSubstr("Does not apply: impacts take no energy."));
  EXPECT_THAT(text, HasSubstr("class=\"truth\""));
}

TEST(StatisticsPage, SaysWhenTwoEnginesPart) {
  const std::string text = markup_of(gas());
  EXPECT_THAT(text, HasSubstr("When two engines part"));
  EXPECT_THAT(text,
              HasSubstr("<th scope=\"row\">good</th><td class=\"number\"/><td class=\"number\">0.25</td>"));
}

TEST(StatisticsPage, SaysWhyNothingIsAsked_AndNothingOfFewBalls) {
  SceneComparison scene = gas();
  scene.statistics = SceneStatistics{"forces act between impacts", {}, 0.0, 0.0, 0.0, 0.0, {}};
  EXPECT_THAT(markup_of(scene),
              AllOf(HasSubstr("Not asked: forces act between impacts."), Not(HasSubstr("<svg"))));
  scene.statistics.reset();
  EXPECT_EQ(markup_of(scene), "<main/>");
}

TEST(StatisticsJson, HasEveryStatistic_AndWhyOthersAreNotAsked) {
  Results results;
  results.scenes = {gas()};
  for (RunComparison& run : results.scenes[0].runs) {
    if (run.run.status == RunStatus::ok) run.run.trajectory = Trajectory(*results.scenes[0].scene);
  }
  const nlohmann::json scene = nlohmann::json::parse(results_json(results, false)).at("scenes").at(0);
  EXPECT_EQ(scene.at("statistics").at("warm_up"), 2.5);
  EXPECT_EQ(scene.at("statistics").at("not_asked").at("cooling"), "impacts take no energy");
  const nlohmann::json off = scene.at("runs").at(1).at("statistics").at("collision_rate");
  EXPECT_EQ(off.at("value"), 3.0);
  EXPECT_EQ(off.at("deviations"), 15.0);
  EXPECT_EQ(off.at("as_expected"), false);
  EXPECT_TRUE(scene.at("runs").at(2).at("statistics").is_null());
}

}  // namespace
}  // namespace carom::test
