#include "report/page/survival.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "report/page.h"

namespace carom::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using page::Node;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Two balls that begin `overlap` of their radius inside each other.
std::shared_ptr<Scenario> overlapping_scene(const std::string& id, double overlap = 0.0) {
  auto made = std::make_shared<Scenario>();
  made->id = id;
  made->title = "Scene " + id;
  for (const double x : {0.0, 2.0 - overlap}) {
    Ball ball;
    ball.position = Vec3(x, 0.0, 0.0);
    made->balls.push_back(ball);
  }
  made->gate.under_test = {{Metric::energy_gain, 1e-14},
                           {Metric::momentum, 1e-14},
                           {Metric::penetration, 1e-12 + overlap},
                           {Metric::escaped, 0.0}};
  return made;
}

/// A run that is right in everything.
RunComparison clean(const std::string& engine, double overlap = 0.0) {
  RunComparison made;
  made.run.engine = engine;
  made.run.profile = "faithful";
  for (const Metric metric : {Metric::energy_gain, Metric::energy_loss, Metric::momentum, Metric::escaped}) {
    made.metrics[metric] = 0.0;
  }
  made.metrics[Metric::penetration] = overlap;
  return made;
}

RunComparison with(const std::vector<std::pair<Metric, double>>& values) {
  RunComparison made = clean("carom");
  for (const auto& [metric, value] : values) {
    made.metrics[metric] = value;
    if (metric == Metric::energy_gain) made.series.energy = {0.0, value, kNaN, 0.5 * value};
  }
  return made;
}

RunComparison stopped(const std::string& engine, RunStatus status, const std::string& reason) {
  RunComparison made;
  made.run.engine = engine;
  made.run.profile = "faithful";
  made.run.status = status;
  made.run.reason = reason;
  return made;
}

SceneComparison comparison(std::shared_ptr<Scenario> scene, std::vector<RunComparison> runs) {
  SceneComparison made;
  made.scene = std::move(scene);
  made.position_tolerance_m = 1e-3;
  made.runs = std::move(runs);
  return made;
}

/// The chapter's text as a reader sees it, one line for each cell, with its tooltip behind it.
std::string chapter_of(std::vector<SceneComparison> scenes) {
  Results results;
  results.scenes = std::move(scenes);
  pugi::xml_document document;
  Node body = document.append_child("body");
  page::add_survival(body, results, page::Legend(results.scenes));
  std::string text;
  auto parts = body.select_nodes("//td | //p | //th");
  parts.sort();
  for (const auto& found : parts) {
    for (const auto& piece : found.node().select_nodes(".//text()")) text += piece.node().value();
    if (const auto link = found.node().child("a")) {
      text += std::string(" [") + link.attribute("title").value() + "]";
    }
    text += "\n";
  }
  return text;
}

std::string cell_of(const RunComparison& run, double overlap_at_start = 0.0) {
  const std::string text = chapter_of({comparison(overlapping_scene("hard/one", overlap_at_start), {run})});
  const std::size_t first = text.find("hard/one");
  const std::size_t begin = text.find('\n', first) + 1;
  return text.substr(begin, text.find('\n', begin) - begin);
}

TEST(Survival, ChapterIsAbsent_WithoutHardScenes) {
  EXPECT_EQ(chapter_of({comparison(overlapping_scene("impact/hard"), {clean("carom")})}), "");
  EXPECT_EQ(chapter_of({comparison(overlapping_scene("hardly/so"), {clean("carom")})}), "");
}

TEST(Survival, TableHasHardScenesAndTheirRunsOnly) {
  const std::string text =
      chapter_of({comparison(overlapping_scene("impact/one"), {clean("carom"), clean("elsewhere")}),
                  comparison(overlapping_scene("hard/one"), {clean("carom"), clean("box2d")}),
                  comparison(overlapping_scene("hard/two"), {clean("carom")})});
  EXPECT_THAT(text, AllOf(HasSubstr("Scene hard/one"), HasSubstr("Scene hard/two"), HasSubstr("box2d"),
                          HasSubstr("not run"), Not(HasSubstr("impact")), Not(HasSubstr("elsewhere"))));
}

TEST(Survival, RunThatHoldsTheLimitsOfTheScene_IsRight) {
  EXPECT_THAT(cell_of(clean("carom")), HasSubstr("✓ right"));
  EXPECT_THAT(cell_of(with({{Metric::energy_gain, 1e-14}})), HasSubstr("✓ right"));
}

TEST(Survival, RunWithinTheCommonLimits_Survives) {
  EXPECT_THAT(cell_of(with({{Metric::energy_gain, 1e-7}})),
              HasSubstr("○ survives [energy above the start 1e-7,"));
  EXPECT_THAT(cell_of(with({{Metric::energy_gain, 0.01}})), HasSubstr("○ survives"));
  EXPECT_THAT(cell_of(with({{Metric::penetration, 0.1}})), HasSubstr("○ survives"));
  EXPECT_THAT(cell_of(with({{Metric::energy_gain, 1e-7}, {Metric::position, 0.5}})),
              HasSubstr("○ survives0.5 radii off ["));
  EXPECT_THAT(cell_of(with({{Metric::energy_gain, 1e-7}, {Metric::position, 1e-4}})),
              HasSubstr("○ survives ["));
  EXPECT_THAT(cell_of(with({{Metric::energy_gain, 1e-7}, {Metric::energy_loss, 0.5}})),
              HasSubstr("○ survivesloses 50 % energy"));
}

// A scene's limit on a metric that does not apply is not held, but it is no failure either.
TEST(Survival, UnknownMetric_IsNeitherRightNorFailed) {
  RunComparison run = clean("carom");
  run.metrics[Metric::energy_gain].reset();
  EXPECT_THAT(cell_of(run), HasSubstr("○ survives [energy above the start 0, above the truth n/a"));
}

TEST(Survival, SceneWithoutLimits_HasNobodyRight) {
  const auto free = overlapping_scene("hard/one");
  free->gate = {};
  EXPECT_THAT(chapter_of({comparison(free, {clean("carom")})}), HasSubstr("○ survives"));
}

TEST(Survival, Failure_IsNamedWithItsNumber) {
  EXPECT_THAT(cell_of(with({{Metric::energy_gain, 0.43}})), HasSubstr("✗ gains energy ×1.43 ["));
  EXPECT_THAT(cell_of(with({{Metric::penetration, 0.12}})), HasSubstr("✗ overlap 12 % ["));
  EXPECT_THAT(cell_of(with({{Metric::momentum, 0.5}})), HasSubstr("✗ momentum off 50 % ["));
  EXPECT_THAT(cell_of(with({{Metric::escaped, 3.0}})), HasSubstr("✗ 3 outside ["));
}

// Factors over the limits: gain 2 (0.02/0.01), momentum 10 (0.1/0.01), overlap 5 (0.5/0.1); nobody may be
// outside.
TEST(Survival, SeveralFailures_StandWithTheWorstFirst) {
  const std::vector<std::pair<Metric, double>> values = {
      {Metric::energy_gain, 0.02}, {Metric::momentum, 0.1}, {Metric::penetration, 0.5}};
  EXPECT_THAT(cell_of(with(values)), HasSubstr("✗ momentum off 10 %overlap 50 %gains energy ×1.02 ["));
  RunComparison outside = with(values);
  outside.metrics[Metric::escaped] = 1.0;
  EXPECT_THAT(cell_of(outside), HasSubstr("✗ 1 outside"));
}

TEST(Survival, OverlapThatTheSceneBeginsWith_IsNotHeldAgainstAnyone) {
  EXPECT_THAT(cell_of(clean("carom", 0.9), 0.9), HasSubstr("✓ right"));
  EXPECT_THAT(cell_of(clean("carom", 0.95), 0.9), HasSubstr("○ survives"));
  EXPECT_THAT(cell_of(clean("carom", 1.2), 0.9), HasSubstr("✗ overlap 120 % ["));
}

// A bounce that loses energy and comes a step late has more than the truth for a moment, and gains nothing.
TEST(Survival, EnergyAboveTheTruthButNotTheStart_IsNoGain) {
  RunComparison late = with({{Metric::energy_gain, 0.3}});
  late.series.energy = {0.0, -0.1, -0.4};
  EXPECT_THAT(cell_of(late), HasSubstr("○ survives"));
}

// What is pushed for is not known: an engine that lets a pile sleep books nothing.
TEST(Survival, MomentumUnderGravity_IsNotAsked) {
  const auto falling = overlapping_scene("hard/one");
  falling->effects.gravity = Vec3(0.0, -9.81, 0.0);
  const RunComparison run = with({{Metric::momentum, 0.9}, {Metric::energy_gain, 1e-3}});
  EXPECT_THAT(chapter_of({comparison(falling, {run})}), HasSubstr("○ survives"));
}

// A scene that lets balls pass through each other on purpose does not limit their overlap.
TEST(Survival, LimitsOfTheScene_ComeBeforeTheCommonOnes) {
  const auto passing = overlapping_scene("hard/one");
  passing->gate.under_test = {{Metric::momentum, 1e-15}};
  EXPECT_THAT(chapter_of({comparison(passing, {with({{Metric::penetration, 2.0}})})}), HasSubstr("✓ right"));
}

TEST(Survival, RunThatDidNotEndWell_SaysHow) {
  EXPECT_THAT(cell_of(stopped("x", RunStatus::crashed, "Segmentation fault")),
              HasSubstr("! crashed [Segmentation fault.]"));
  EXPECT_THAT(cell_of(stopped("x", RunStatus::timeout, "stopped after 20 s")), HasSubstr("! timeout ["));
  EXPECT_THAT(cell_of(stopped("x", RunStatus::invalid, "ball 3")), HasSubstr("! NaN [Ball 3.]"));
  EXPECT_THAT(cell_of(stopped("x", RunStatus::unsupported, "it is flat")),
              HasSubstr("– cannot [It is flat.]"));
}

TEST(Survival, CriteriaStandUnderTheTable_WithTheirNumbers) {
  EXPECT_THAT(chapter_of({comparison(overlapping_scene("hard/one"), {clean("carom")})}),
              AllOf(HasSubstr("never has 1 % more energy"), HasSubstr("within 1 %"),
                    HasSubstr("less than 10 % of a radius")));
}

/// A scene that a whole page can be drawn of.
SceneComparison drawable(const std::string& id) {
  const auto made = overlapping_scene(id);
  RunComparison run = clean("carom");
  run.run.trajectory = Trajectory(*made);
  for (std::size_t k = 0; k < run.run.trajectory.frames(); ++k) {
    for (std::size_t i = 0; i < made->balls.size(); ++i) {
      run.run.trajectory.frame(k)[i] = {made->balls[i].position, Vec3::Zero(), Vec3::Zero()};
    }
    run.series.energy.push_back(0.0);
    run.series.momentum.push_back(0.0);
    run.series.position.push_back(0.0);
  }
  return comparison(made, {run});
}

TEST(Survival, PageLinksToTheChapter_WhereItIs) {
  const auto page_of = [](const std::string& id) {
    Results results;
    results.scenes = {drawable(id)};
    return render_page(results, CAROM_SOURCE_DIR "/reports/web");
  };
  EXPECT_THAT(page_of("hard/one"), AllOf(HasSubstr("href=\"#survival\""), HasSubstr("id=\"survival\"")));
  EXPECT_THAT(page_of("impact/one"), Not(HasSubstr("survival")));
}

}  // namespace
}  // namespace carom::test
