#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "comparison/compare.h"
#include "report/csv.h"
#include "report/json.h"
#include "report/junit.h"
#include "report/summary.h"
#include "report/table.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Two balls that do not meet; one run that passes, one that fails, one that crashed and one that is not
/// gated.
Results four_verdicts() {
  auto scene = std::make_shared<Scenario>();
  scene->id = "group/na|me";
  scene->title = "A <title> & more";
  scene->duration_s = 1.0;
  scene->frames = 2;
  scene->balls.resize(2);
  scene->balls[0].velocity = Vec3(0.1, 0, 0);
  scene->balls[1].position = Vec3(5, 0, 0);
  scene->balls[1].mass = std::numeric_limits<double>::infinity();
  scene->gate.under_test[Metric::energy] = 1e-9;
  scene->gate.under_test[Metric::penetration] = 0.0;
  const auto run = [&](const std::string& name, double speed) {
    Run result;
    result.engine = name;
    result.profile = "faithful";
    result.settings = {{"erp", 0.1}, {"sleeping", false}};
    result.trajectory = Trajectory(*scene);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto frame = result.trajectory.frame(k);
      frame[0] = {Vec3(0.1 * result.trajectory.time(k), 0, 0), Vec3(k == 0 ? 0.1 : speed, 0, 0),
                  Vec3::Zero()};
      frame[1] = {Vec3(5, 0, 0), Vec3::Zero(), Vec3::Zero()};
      result.trajectory.tally(k) = {};
    }
    return result;
  };
  std::vector<Run> runs = {run("good", 0.1), run("bad", 0.2), run("dead", 0.1), run("other", 0.3)};
  runs[2].status = RunStatus::crashed;
  runs[2].reason = "killed by signal 11 <here>";
  Results results;
  results.version = "1.2.3";
  results.machine = {"a cpu", 2, "a compiler", "Release"};
  results.missing = {{"absent", "libabsent-dev"}};
  results.scenes.push_back(compare(scene, {}, std::move(runs), {"good", "bad", "dead"}));
  return results;
}

TEST(Json, HasTheKeysThatScriptsRelyOn) {
  const auto json = nlohmann::json::parse(results_json(four_verdicts(), false));
  EXPECT_EQ(json["carom"], "1.2.3");
  EXPECT_EQ(json["machine"]["cores"], 2);
  const auto& scene = json["scenes"][0];
  EXPECT_EQ(scene["id"], "group/na|me");
  EXPECT_EQ(scene["balls"], 2);
  EXPECT_EQ(scene["truth"]["kind"], "none");
  const auto& runs = scene["runs"];
  EXPECT_EQ(runs[0]["verdict"], "pass");
  EXPECT_EQ(runs[1]["verdict"], "fail");
  EXPECT_EQ(runs[2]["verdict"], "error");
  EXPECT_EQ(runs[2]["status"], "crashed");
  EXPECT_EQ(runs[3]["verdict"], "shown");
  EXPECT_EQ(runs[0]["settings"]["erp"], 0.1);
  EXPECT_TRUE(runs[0]["metrics"]["position"].is_null());
  EXPECT_TRUE(runs[0]["metrics"]["escaped"].is_null());
  EXPECT_TRUE(runs[2]["metrics"]["energy"].is_null());
  EXPECT_EQ(runs[1]["gates"][0]["holds"], false);
  EXPECT_TRUE(runs[0]["final"][1]["mass"].is_null());  // infinite
  EXPECT_EQ(runs[0]["final"][0]["position"], (std::vector<double>{0.1, 0.0, 0.0}));
}

TEST(Json, NumbersReadBackToTheSameDouble) {
  Results results = four_verdicts();
  auto last = results.scenes[0].runs[0].run.trajectory.frame(2);
  Random random(4);
  for (int trial = 0; trial < 200; ++trial) {
    const double value = std::ldexp(random.uniform(), static_cast<int>(random.uniform(-300.0, 300.0)));
    last[0].position.x() = value;
    const auto json = nlohmann::json::parse(results_json(results, false));
    EXPECT_EQ(json["scenes"][0]["runs"][0]["final"][0]["position"][0].get<double>(), value);
  }
}

TEST(Junit, HasACaseForEachGate_AndItsCountsAreRight) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(results_junit(four_verdicts()).c_str()));
  const pugi::xml_node suites = document.child("testsuites");
  // Two gates for good and bad each, one case for the crash, one for the engine that is only shown.
  EXPECT_EQ(suites.attribute("tests").as_int(), 6);
  EXPECT_EQ(suites.attribute("failures").as_int(), 1);
  EXPECT_EQ(suites.attribute("errors").as_int(), 1);
  EXPECT_EQ(suites.attribute("skipped").as_int(), 1);
  int cases = 0;
  for (const pugi::xml_node test : suites.child("testsuite").children("testcase")) {
    ++cases;
    if (test.child("failure").empty()) continue;
    EXPECT_STREQ(test.attribute("name").value(), "energy");
    EXPECT_THAT(test.child("failure").attribute("message").value(), HasSubstr("is above its limit 1e-09"));
  }
  EXPECT_EQ(cases, 6);
}

TEST(Summary, NamesWhatIsViolated_AndKeepsItsTableWhole) {
  const std::string summary = results_summary(four_verdicts());
  EXPECT_THAT(summary, HasSubstr("**2 violated:**"));
  EXPECT_THAT(summary, HasSubstr("| group/na\\|me | bad | energy | 3"));
  EXPECT_THAT(summary, HasSubstr("| dead | crashed | killed by signal 11 &lt;here\\> |"));
  EXPECT_THAT(summary, HasSubstr("| group/na\\|me | good | ✅ pass |"));
}

TEST(Junit, IsXml_WhateverAnEngineSays) {
  Results results = four_verdicts();
  results.scenes[0].runs[2].run.reason = "\x1b[31mred\x01 \xff\xc3 \xe2\x82\xac ]]> & <end>";
  const std::string xml = results_junit(results);
  EXPECT_THAT(xml, Not(HasSubstr("&#27;")));
  EXPECT_THAT(xml, Not(HasSubstr("\xff")));
  EXPECT_THAT(xml, HasSubstr("?[31mred? ?? \xe2\x82\xac ]]&gt; &amp; &lt;end&gt;"));
}

TEST(Junit, HasOneCaseForAMetric_ThatTheSceneAndTheBaselineLimit) {
  Results results = four_verdicts();
  RunComparison& bad = results.scenes[0].runs[1];
  bad.gates.push_back({Metric::energy, 0.5, 3.0, false, 0.25});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(results_junit(results).c_str()));
  EXPECT_EQ(document.child("testsuites").attribute("tests").as_int(), 6);
  const pugi::xml_node failure = document.select_node("//testcase[failure]").node();
  EXPECT_STREQ(failure.attribute("classname").value(), "group/na|me.bad");
  EXPECT_STREQ(failure.attribute("name").value(), "energy");
  const std::string message = failure.child("failure").attribute("message").value();
  EXPECT_THAT(message,
              HasSubstr("above its limit 1e-09; energy = 3 is above 0.5, what its baseline 0.25 allows"));
  EXPECT_EQ(message, failure.child("failure").text().get());
  EXPECT_STREQ(failure.child("failure").attribute("type").value(), "gate");
}

TEST(Summary, IsShort_WhereAllIsWell) {
  Results results = four_verdicts();
  results.scenes[0].runs.resize(1);
  const SceneComparison scene = results.scenes[0];
  for (int i = 0; i < 70; ++i) results.scenes.push_back(scene);
  const std::string summary = results_summary(results);
  const std::string open = summary.substr(0, summary.find("<details>"));
  EXPECT_LT(std::count(open.begin(), open.end(), '\n'), 10) << open;
  EXPECT_THAT(open, HasSubstr("Every gate holds: 142 limits in 71 scenes."));
  EXPECT_THAT(open, HasSubstr("| good | 71 | | | | |"));
}

TEST(Summary, NothingFromOutside_BecomesMarkup) {
  Results results = four_verdicts();
  results.scenes[0].runs[2].run.reason = "a_b _c_ `d` *e* [f](g) <h> &amp; i|j\nk \\";
  EXPECT_THAT(results_summary(results),
              HasSubstr(R"(| crashed | a_b \_c\_ \`d\` \*e\* \[f\](g) &lt;h\> &amp;amp; i\|j k \\ | | |)"));
}

TEST(Table, FitsInto80Columns_AndHasColourOnlyOnRequest) {
  const std::string table = results_table(four_verdicts(), false);
  EXPECT_THAT(table, Not(HasSubstr("\x1b[")));
  EXPECT_THAT(results_table(four_verdicts(), true), HasSubstr("\x1b["));
  EXPECT_THAT(table, HasSubstr("violated: group/na|me: bad: energy = "));
  EXPECT_THAT(table, HasSubstr("absent is not built: libabsent-dev is not installed"));
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    const bool free_text = line.starts_with("violated");
    EXPECT_TRUE(free_text || line.size() <= 80U) << line;
  }
}

TEST(Csv, HasARowForEachFrameAndBall_WithAllDigits) {
  Results results = four_verdicts();
  results.scenes[0].runs[0].run.trajectory.frame(1)[0].position.x() = 0.1 + 0.2;
  const std::string csv = trajectory_csv(results.scenes[0].runs[0].run.trajectory);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * 2);
  EXPECT_THAT(csv, HasSubstr("\n0.5,0,0.30000000000000004,0,0,0.1,0,0,0,0,0\n"));
}

TEST(Json, EnergyByCause_IsNull_WhereTheEngineCannotTell) {
  Results results = four_verdicts();
  results.scenes[0].runs[0].energy_split = EnergySplit{0.5, -1.0, -2.0, -3.0, 4.0};
  results.scenes[0].runs[1].energy_split.reset();
  const nlohmann::json runs = nlohmann::json::parse(results_json(results, false)).at("scenes")[0].at("runs");
  EXPECT_EQ(runs[0].at("energy_by_cause"),
            nlohmann::json::parse(R"({"flight": 0.5, "ball_impacts": -1.0, "wall_impacts": -2.0,
                                      "friction": -3.0, "position_correction": 4.0, "events": 0.0})"));
  EXPECT_EQ(runs[1].at("energy_by_cause"), nullptr);
}

TEST(Json, Coefficients_AreThere_WhereTheyWereMeasured) {
  Results results = four_verdicts();
  EXPECT_FALSE(nlohmann::json::parse(results_json(results, false)).contains("coefficients"));
  results.coefficients = {
      {Coefficient::friction, true, 0.3, {0.1, 1.0}, {{"good", {Delivered{0.3, 0.2, 0.4}, std::nullopt}}}}};
  const nlohmann::json panel = nlohmann::json::parse(results_json(results, false)).at("coefficients").at(0);
  EXPECT_EQ(panel.at("coefficient"), "friction");
  EXPECT_EQ(panel.at("on"), "wall");
  EXPECT_EQ(panel.at("nominal"), 0.3);
  EXPECT_EQ(panel.at("speeds_mps"), nlohmann::json({0.1, 1.0}));
  EXPECT_EQ(panel.at("delivered").at("good"),
            nlohmann::json::parse(R"([{"value": 0.3, "lowest": 0.2, "highest": 0.4}, null])"));
}

}  // namespace
}  // namespace carom::test
