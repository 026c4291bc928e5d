#include "report/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "tests/support/folder.h"

namespace carom {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();
const std::filesystem::path kWeb = std::filesystem::path(CAROM_SOURCE_DIR) / "reports/web";

std::string page_of(const Results& results) {
  return render_page(results, kWeb);
}

/// Balls on a line along x, one metre apart, all moving along `velocity`.
std::shared_ptr<Scenario> scene(const std::string& id, int dimension, std::size_t balls,
                                const Vec3& velocity) {
  auto made = std::make_shared<Scenario>();
  made->id = id;
  made->title = "Scene " + id;
  made->dimension = dimension;
  made->duration_s = 2.0;
  made->frames = 40;
  for (std::size_t i = 0; i < balls; ++i) {
    Ball ball;
    ball.radius = 0.1;
    ball.position = Vec3(static_cast<double>(i), 1.0, 0.0);
    ball.velocity = velocity;
    made->balls.push_back(ball);
  }
  return made;
}

/// Free flight, off by `error_m` times the time.
Trajectory flight(const Scenario& scene, double error_m) {
  Trajectory trajectory(scene);
  for (std::size_t k = 0; k < trajectory.frames(); ++k) {
    const double t = trajectory.time(k);
    for (std::size_t i = 0; i < trajectory.balls(); ++i) {
      const Ball& ball = scene.balls[i];
      trajectory.frame(k)[i] = {ball.position + (1.0 + error_m) * t * ball.velocity, ball.velocity,
                                Vec3::Zero()};
    }
  }
  return trajectory;
}

RunComparison run_of(const Scenario& scene, const std::string& engine, const std::string& profile,
                     Verdict verdict, double error_m = 0.0) {
  RunComparison made;
  made.run.engine = engine;
  made.run.profile = profile;
  made.run.steps = 500;
  made.run.settings = {{"velocity_threshold_mps", 0.25}, {"sleep", false}, {"solver", std::string("pairs")}};
  made.run.trajectory = flight(scene, error_m);
  made.verdict = verdict;
  made.metrics[Metric::energy] = error_m;
  made.metrics[Metric::position] = error_m * 2.0;
  for (std::size_t k = 0; k < made.run.trajectory.frames(); ++k) {
    const double t = made.run.trajectory.time(k);
    made.series.energy.push_back(-error_m * t);
    made.series.momentum.push_back(0.0);
    made.series.position.push_back(error_m * t);
  }
  return made;
}

RunComparison stopped(RunComparison run, RunStatus status, const std::string& reason) {
  run.run.status = status;
  run.run.reason = reason;
  run.metrics = {};
  run.series = {};
  return run;
}

SceneComparison comparison(std::shared_ptr<Scenario> scene, std::vector<RunComparison> runs) {
  SceneComparison made;
  made.truth.kind = "closed-form";
  made.truth.uncertainty_m = 1e-15;
  made.truth.trajectory = flight(*scene, 0.0);
  made.position_tolerance_m = 1e-4;
  made.scene = std::move(scene);
  made.runs = std::move(runs);
  return made;
}

/// A scene of every verdict.
SceneComparison every_verdict() {
  const auto head_on = scene("impact/head-on", 2, 2, Vec3(1, 0.3, 0));
  RunComparison pass = run_of(*head_on, "carom", "faithful", Verdict::pass, 1e-15);
  pass.under_test = true;
  pass.gates = {{Metric::energy, 1e-9, 1e-15, true, {}}};
  RunComparison fail = run_of(*head_on, "box2d", "faithful", Verdict::fail, 0.01);
  fail.gates = {{Metric::energy, 1e-4, 0.01, false, {}}};
  fail.first_divergence = Divergence{0.5, {0, 1}, Metric::position};
  const RunComparison base = run_of(*head_on, "x", "faithful", Verdict::unsupported);
  RunComparison unsupported = stopped(base, RunStatus::unsupported, "its balls are square");
  unsupported.run.engine = "chipmunk";
  RunComparison crashed = stopped(base, RunStatus::crashed, "Segmentation fault");
  crashed.run.engine = "bullet";
  crashed.verdict = Verdict::error;
  SceneComparison made = comparison(
      head_on, {pass, fail, run_of(*head_on, "box2d", "default", Verdict::shown, 0.3), unsupported, crashed});
  made.pairs = {{0, 1, 0.02, 0.01, 0.01, std::nullopt, std::nullopt, Divergence{0.5, {1}, Metric::energy}}};
  return made;
}

SceneComparison gas(std::size_t balls) {
  const auto made = scene("gas/many", 3, balls, Vec3(0.1, 0.2, 0.3));
  made->box = Box{Vec3::Zero(), Vec3(20, 20, 20)};
  SceneComparison gas = comparison(made, {run_of(*made, "carom", "faithful", Verdict::shown, 1e-13)});
  gas.truth = Truth{};
  gas.truth.reason = "the balls can meet";
  return gas;
}

Results results_of(std::vector<SceneComparison> scenes) {
  Results made;
  made.version = "1.2.3";
  made.machine = {"a processor", 2, "a compiler", "Release"};
  made.scenes = std::move(scenes);
  EngineInfo box2d;
  box2d.name = "box2d";
  box2d.about = "circles in the plane";
  box2d.profiles = {{"faithful", "set for fidelity"}};
  box2d.cannot = {{Feature::space, "it is flat"}};
  made.engines = {box2d};
  made.missing = {{"bullet-f64", "libbullet-dev"}};
  return made;
}

Results usual_results() {
  const auto drop = scene("wall/drop", 2, 1, Vec3(0, -1, 0));
  return results_of({every_verdict(), gas(100),
                     comparison(drop, {run_of(*drop, "carom", "faithful", Verdict::shown, 1e-12)})});
}

/// The body, read as XML.
void parse_body(const std::string& page, pugi::xml_document& body) {
  const std::size_t begin = page.find("<body>");
  const std::size_t end = page.find("</body>");
  ASSERT_NE(begin, std::string::npos);
  ASSERT_NE(end, std::string::npos);
  const std::string text = page.substr(begin, end + 7 - begin);
  const pugi::xml_parse_result parsed = body.load_string(text.c_str(), pugi::parse_full);
  ASSERT_TRUE(parsed) << parsed.description() << " at "
                      << text.substr(static_cast<std::size_t>(parsed.offset), 80);
}

/// The body's text as a reader sees it.
std::string text_of(const pugi::xml_node& node) {
  std::string text = node.value();
  for (const pugi::xml_node child : node.children()) text += text_of(child);
  return text;
}

TEST(Page, HasEverySceneEngineAndVerdict_WhateverHappened) {
  const std::string page = page_of(usual_results());
  for (const char* expected : {"Scene impact/head-on",
                               "Scene gas/many",
                               "Scene wall/drop",
                               "carom",
                               "box2d@default",
                               "chipmunk",
                               "bullet",
                               "✓</span> pass",
                               "✗</span> fail",
                               "○</span> shown",
                               "–</span> unsupported",
                               "!</span> error",
                               "its balls are square",
                               "crashed: Segmentation fault",
                               "bullet-f64",
                               "libbullet-dev",
                               "it is flat",
                               "the balls can meet",
                               "position of balls 0 and 1",
                               "velocity_threshold_mps",
                               "a compiler",
                               "1.2.3"}) {
    EXPECT_THAT(page, HasSubstr(expected));
  }
}

TEST(Page, SaysWhatBreaks_WithValueAndLimit) {
  EXPECT_THAT(page_of(usual_results()),
              AllOf(HasSubstr("impact/head-on: box2d: energy = 0.01 is above its limit 0.0001"),
                    HasSubstr("holds every gate in 1 of 1 scene.")));
}

// The DOI of a publication asks nothing of a network before somebody clicks on it.
TEST(Page, IsWellFormed_AndLinksOnlyInsideItself_AndToPublications) {
  pugi::xml_document body;
  parse_body(page_of(usual_results()), body);
  for (const auto& found : body.select_nodes("//@href")) {
    const std::string target = found.attribute().value();
    if (target.starts_with("https://doi.org/10.")) continue;
    ASSERT_EQ(target.front(), '#') << target;
    EXPECT_TRUE(body.select_node(("//*[@id='" + target.substr(1) + "']").c_str())) << target;
  }
  EXPECT_TRUE(body.select_nodes("//@src").empty());
}

TEST(Page, NeedsNoNetwork_WhateverASceneLinksTo) {
  SceneComparison linking = every_verdict();
  auto changed = std::make_shared<Scenario>(*linking.scene);
  changed->about =
      "After [a paper](https://example.org/x), <https://example.org/y>, ![a picture](http://e.org/z.png)";
  linking.scene = changed;
  const std::string page = page_of(results_of({linking}));
  EXPECT_THAT(page, AllOf(Not(HasSubstr("http:")), Not(HasSubstr("https://e")),
                          HasSubstr("a paper (example.org/x)"), HasSubstr("a picture")));
}

TEST(Page, EscapesEverything_ThatASceneOrAnEngineSays) {
  const std::string attack = "<script>alert('x')</script> & \"quoted\"";
  SceneComparison hostile = every_verdict();
  auto changed = std::make_shared<Scenario>(*hostile.scene);
  changed->id = "impact/" + attack;
  changed->title = attack;
  changed->about = attack + "\n\n**bold** <b onclick='x'>raw</b>";
  changed->notes = {attack};
  hostile.scene = changed;
  hostile.truth.kind = attack;
  for (RunComparison& run : hostile.runs) {
    run.run.engine += attack;
    run.run.reason = attack;
    run.run.settings = {{attack, attack}};
  }
  Results results = results_of({hostile});
  results.engines[0].about = results.machine.cpu = results.missing[0].package = attack;
  const std::string page = page_of(results);
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(page.find("<b onclick"), std::string::npos);
  EXPECT_THAT(page, HasSubstr("<strong>bold</strong>"));
  pugi::xml_document body;
  parse_body(page, body);
  EXPECT_EQ(text_of(body.select_node("//section[@class='scene']/h2").node()), attack);
  EXPECT_TRUE(body.select_nodes("//script").empty());
}

TEST(Page, DrawsNoNumberThatIsNotFinite_WhereSeriesAndPathsHaveGaps) {
  SceneComparison broken = every_verdict();
  RunComparison& run = broken.runs[0];
  run.series.energy[3] = run.series.momentum[4] = kNaN;
  run.series.position[5] = kInfinite;
  run.run.trajectory.frame(7)[0].position.x() = kNaN;
  run.run.trajectory.frame(40)[1].position.y() = -kInfinite;
  run.run.trajectory.frame(9)[1].position.y() = 1e300;
  broken.runs[1].series.energy.assign(41, kNaN);
  broken.runs[2].series.energy[1] = 1e300;
  pugi::xml_document body;
  parse_body(page_of(results_of({broken})), body);
  const std::regex not_finite("nan|inf", std::regex::icase);
  for (const auto& found : body.select_nodes("//svg//@*")) {
    const std::string name = found.attribute().name();
    if (name == "class" || name == "data-label") continue;
    EXPECT_FALSE(std::regex_search(found.attribute().value(), not_finite)) << found.attribute().value();
  }
}

TEST(Page, LeavesAPlotOut_WhereNothingIsKnown) {
  SceneComparison blind = every_verdict();
  for (RunComparison& run : blind.runs) run.series.momentum.assign(run.series.momentum.size(), kNaN);
  EXPECT_THAT(page_of(results_of({every_verdict()})), HasSubstr("Momentum, deviation"));
  EXPECT_THAT(page_of(results_of({blind})), Not(HasSubstr("Momentum, deviation")));
}

TEST(Page, DrawsZeroAtTheFloor_OfALogarithmicAxis) {
  const std::string page = page_of(results_of({every_verdict()}));
  EXPECT_THAT(page, HasSubstr("Zero, and what is below 1e-17, is drawn at the bottom."));
  pugi::xml_document body;
  parse_body(page, body);
  // The momentum of every run is 0 throughout: a line along the bottom of its plot.
  const auto line =
      body.select_node("//figure[contains(., 'Momentum')]//svg[@class='area']/path[@data-label]").node();
  const auto area = line.parent();
  EXPECT_EQ(std::string(line.attribute("d").value()), "M0 " + std::string(area.attribute("height").value()) +
                                                          "L" + area.attribute("width").value() + " " +
                                                          area.attribute("height").value());
}

TEST(Page, DrawsTheEnergyOfTheTruth_WhereItIsNotConserved) {
  SceneComparison lossy = every_verdict();
  for (BallState& ball : lossy.truth.trajectory.frame(30)) ball.velocity *= 0.5;
  pugi::xml_document body;
  parse_body(page_of(results_of({lossy})), body);
  EXPECT_EQ(body.select_nodes("//figure[@class='plot'][contains(., 'Energy')]//path[@class='truth']").size(),
            1U);
}

TEST(Page, DrawsHeightOverTime_WhereABallOnlyFalls) {
  const auto drop = scene("wall/drop", 2, 1, Vec3(0, -1, 0));
  const auto throw_ = scene("wall/throw", 2, 1, Vec3(1, -1, 0));
  const auto of = [](const std::shared_ptr<Scenario>& s) {
    return page_of(results_of({comparison(s, {run_of(*s, "carom", "faithful", Verdict::shown)})}));
  };
  EXPECT_THAT(of(drop), HasSubstr("so y is drawn over time"));
  EXPECT_THAT(of(throw_), Not(HasSubstr("over time;")));
}

TEST(Page, SaysThatItProjects_WhereTheSceneIsInSpace) {
  EXPECT_THAT(page_of(results_of({gas(3)})), HasSubstr("Seen along z"));
}

TEST(Page, DescribesEveryDrawing_InWords) {
  pugi::xml_document body;
  parse_body(page_of(usual_results()), body);
  const auto drawings = body.select_nodes("//svg[@role='img']");
  EXPECT_GT(drawings.size(), 8U);
  for (const auto& drawing : drawings) {
    EXPECT_STRNE(drawing.node().child_value("title"), "");
    EXPECT_STRNE(drawing.node().child_value("desc"), "");
  }
}

TEST(Page, SaysWhereTheEnergyWent_WhereAnyDid) {
  Results results = usual_results();
  EXPECT_THAT(page_of(results), Not(HasSubstr("Where the energy went")));
  // Two balls of 1 kg with 1.09 m²/s² each: 1.09 J.
  results.scenes[0].runs[0].energy_split = EnergySplit{0.0, -0.545, 0.0, 0.0, 1e-9};
  results.scenes[0].runs[2].energy_split = EnergySplit{0.109, 0.0, 0.0, 0.0, 0.0};
  const std::string page = page_of(results);
  pugi::xml_document body;
  ASSERT_NO_FATAL_FAILURE(parse_body(page, body));
  EXPECT_THAT(text_of(body), AllOf(HasSubstr("Where the energy went"), HasSubstr("−0.5"), HasSubstr("+0.1")));
}

/// The edges of the parts of each bar, left to right, as [from, to].
std::vector<std::vector<std::pair<double, double>>> bars_of(const pugi::xml_document& body) {
  std::vector<std::vector<std::pair<double, double>>> bars;
  for (const auto& bar : body.select_nodes("//svg[@class='bar']")) {
    std::vector<std::pair<double, double>> parts;
    for (const auto& part : bar.node().select_nodes("rect")) {
      const double left = part.node().attribute("x").as_double();
      parts.emplace_back(left, left + part.node().attribute("width").as_double());
    }
    std::sort(parts.begin(), parts.end());
    bars.push_back(parts);
  }
  return bars;
}

TEST(Page, DrawsEnergyByCause_OnOneScale_AndCutsWhatIsBeyondIt) {
  Results results = usual_results();
  const double start_J = 1.09;  // as above
  results.scenes[0].runs[0].energy_split =
      EnergySplit{0.1 * start_J, -0.2 * start_J, 0.0, -0.1 * start_J, 0.0};
  results.scenes[0].runs[2].energy_split = EnergySplit{0.0, 0.0, 5.0 * start_J, 0.0, 0.0};
  pugi::xml_document body;
  ASSERT_NO_FATAL_FAILURE(parse_body(page_of(results), body));
  const auto bars = bars_of(body);
  ASSERT_EQ(bars.size(), 2U);
  ASSERT_EQ(bars[0].size(), 3U);
  ASSERT_EQ(bars[1].size(), 1U);
  // Friction, ball impacts, zero, flight; from -0.3 to 1 there are 166 px. Numbers are rounded to tenths of a
  // px.
  const double share_px = 166.0 / 1.3;
  constexpr double kRounding_px = 0.2;
  EXPECT_NEAR(bars[0][0].second - bars[0][0].first, 0.1 * share_px, kRounding_px);
  EXPECT_NEAR(bars[0][1].second - bars[0][1].first, 0.2 * share_px, kRounding_px);
  EXPECT_NEAR(bars[0][1].second, bars[0][2].first, kRounding_px);
  EXPECT_NEAR(bars[0][2].second - bars[0][2].first, 0.1 * share_px, kRounding_px);
  EXPECT_NEAR(bars[1][0].first, bars[0][2].first, kRounding_px);
  EXPECT_NEAR(bars[1][0].second - bars[1][0].first, share_px, kRounding_px);
  EXPECT_EQ(body.select_nodes("//path[@class='beyond']").size(), 1U);
  EXPECT_STREQ(body.select_node("//svg[@class='bar']/desc").node().child_value(),
               "Lost: ball impacts 0.2, friction 0.1. Gained: flight 0.1. ");
}

TEST(Page, ShowsWhatImpactsDeliver_WhereItWasMeasured) {
  Results results = usual_results();
  EXPECT_THAT(page_of(results), Not(HasSubstr("id=\"coefficients\"")));
  const std::vector<double> speeds = {0.1, 1.0, 10.0};
  const auto exactly = [](double value) { return Delivered{value, value, value}; };
  const CoefficientCurve half = {"carom", {exactly(0.5), exactly(0.5), exactly(0.5)}};
  const CoefficientCurve rough = {"carom", {exactly(0.3), exactly(0.3), exactly(0.3)}};
  const CoefficientCurve lossy = {"box2d@default", {std::nullopt, exactly(0.0), Delivered{0.52, 0.5, 0.6}}};
  results.coefficients = {{Coefficient::restitution, false, 0.5, speeds, {half, lossy}},
                          {Coefficient::friction, true, 0.3, speeds, {rough}}};
  const std::string page = page_of(results);
  pugi::xml_document body;
  ASSERT_NO_FATAL_FAILURE(parse_body(page, body));
  const pugi::xml_node section = body.find_node(
      [](const pugi::xml_node& node) { return std::string(node.attribute("id").value()) == "coefficients"; });
  ASSERT_TRUE(section);
  const std::string text = text_of(section);
  EXPECT_THAT(text, HasSubstr("e of a ball on a ball, 0.5 asked for"));
  EXPECT_THAT(text, HasSubstr("box2d@default: no bounce up to 1 m/s, then 0.5 to 0.6"));
  EXPECT_THAT(text, HasSubstr("Every engine delivers what is asked for."));
  EXPECT_THAT(page, AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf "))));
}

TEST(Page, IsTheSameBytes_ForTheSameResults) {
  EXPECT_EQ(page_of(usual_results()), page_of(usual_results()));
}

TEST(Page, StaysSmall_ForTwentyLongScenesInSevenEngines) {
  std::vector<SceneComparison> scenes;
  for (int i = 0; i < 20; ++i) {
    const auto long_scene = scene("gas/" + std::to_string(i), 2, 20, Vec3(1, 0.5, 0));
    long_scene->frames = 2000;
    std::vector<RunComparison> runs;
    for (int engine = 0; engine < 7; ++engine) {
      RunComparison run =
          run_of(*long_scene, "engine-" + std::to_string(engine), "faithful", Verdict::shown, 1e-9);
      // A path that turns at every frame, and errors of all sizes: nothing that thinning finds easy.
      for (std::size_t k = 0; k < run.run.trajectory.frames(); ++k) {
        const double wave = std::sin(0.1 * static_cast<double>(k * (k + static_cast<std::size_t>(engine))));
        for (BallState& ball : run.run.trajectory.frame(k)) ball.position.y() += wave;
        run.series.energy[k] = wave * 1e-9;
        run.series.momentum[k] = run.series.position[k] = std::pow(10.0, 8.0 * wave - 9.0);
      }
      runs.push_back(std::move(run));
    }
    scenes.push_back(comparison(long_scene, std::move(runs)));
  }
  constexpr std::size_t kMiB = std::size_t{1} << 20U;
  const std::string page = page_of(results_of(std::move(scenes)));
  EXPECT_LT(page.size(), 4 * kMiB) << page.size();
}

/// A folder with a stand-in for the bundled viewer.
class PageWithViewer : public testing::Test {
 protected:
  PageWithViewer() {
    write_file(folder_ / "report.js", "/* the viewer */");
    write_file(folder_ / "report.css", "/* its style */");
  }

  std::string page_of(const Results& results) const { return render_page(results, kWeb, folder_.path()); }

  /// The playbacks in a page.
  static std::vector<std::string> playbacks(const std::string& page) {
    std::vector<std::string> found;
    pugi::xml_document body;
    parse_body(page, body);
    for (const auto& each : body.select_nodes("//script[@class='playback']")) {
      found.emplace_back(each.node().child_value());
    }
    return found;
  }

 private:
  test::TestFolder folder_;
};

TEST_F(PageWithViewer, HoldsTheViewer_AndARunOfEveryEngineThatEndedWell) {
  const std::string page = page_of(usual_results());
  EXPECT_THAT(page, AllOf(HasSubstr("/* the viewer */"), HasSubstr("/* its style */")));
  const std::vector<std::string> found = playbacks(page);
  ASSERT_EQ(found.size(), 3U);
  const nlohmann::json first = nlohmann::json::parse(found[0]);
  EXPECT_EQ(first["scene"]["id"], "impact/head-on");
  std::vector<std::string> labels;
  for (const auto& run : first["runs"]) labels.push_back(run["label"]);
  EXPECT_THAT(labels, testing::ElementsAre("truth", "carom", "box2d", "chipmunk", "bullet", "box2d@default"));
}

TEST_F(PageWithViewer, StaysAPage_WhateverASceneIsCalled) {
  SceneComparison hostile = every_verdict();
  auto changed = std::make_shared<Scenario>(*hostile.scene);
  changed->title = "</script><script>alert(1)</script> & <!--";
  hostile.scene = changed;
  const std::string page = page_of(results_of({hostile}));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  const std::vector<std::string> found = playbacks(page);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(nlohmann::json::parse(found[0])["scene"]["title"], changed->title);
}

TEST_F(PageWithViewer, PlaysNothing_WhereNoRunEndedWell) {
  const auto drop = scene("wall/drop", 2, 1, Vec3(0, -1, 0));
  const RunComparison base = run_of(*drop, "x", "faithful", Verdict::error);
  EXPECT_TRUE(
      playbacks(page_of(results_of({comparison(drop, {stopped(base, RunStatus::crashed, "")})}))).empty());
}

// Nothing is easy to pack here: every ball goes somewhere else in each frame.
TEST_F(PageWithViewer, TakesAtMostOneAndAHalfMegabytes_ForALargeScene) {
  const auto large = scene("gas/large", 3, 1000, Vec3(1, 0.5, 0));
  large->frames = 300;
  Random random(3);
  RunComparison run = run_of(*large, "carom", "faithful", Verdict::shown);
  for (std::size_t k = 0; k < run.run.trajectory.frames(); ++k) {
    for (BallState& ball : run.run.trajectory.frame(k)) {
      for (int axis = 0; axis < 3; ++axis) {
        ball.position[axis] += random.uniform(-0.3, 0.3);
        ball.velocity[axis] = random.uniform(-1.0, 1.0);
      }
    }
  }
  RunComparison other = run;
  other.run.engine = "box2d";
  other.run.trajectory = flight(*large, 0.0);
  const std::vector<std::string> found = playbacks(page_of(results_of({comparison(large, {run, other})})));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT(found[0].size(), 1500000U);
  EXPECT_GT(nlohmann::json::parse(found[0])["frames"]["every"], 1);
}

TEST(Page, SaysWhichFileIsMissing_WhereTheWebFolderIsNot) {
  EXPECT_THROW(render_page(usual_results(), kWeb / "nowhere"), InputError);
}

}  // namespace
}  // namespace carom
