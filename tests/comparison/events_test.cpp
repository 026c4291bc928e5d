#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "carom/carom_engine.h"
#include "comparison/compare.h"
#include "comparison/metrics/brought.h"
#include "core/random.h"
#include "engine/modules.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"
#include "trajectory/record.h"

// Events: a run is cut, the balls change, a simulation of the changed scene goes on.

namespace carom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

EngineChoice carom_choice(const std::string& name) {
  const std::shared_ptr<const Engine> engine = make_carom_engine(name);
  return {{name, [engine]() -> const Engine& { return *engine; }}};
}

std::vector<EngineChoice> modules() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(CAROM_ENGINE_DIR_PATH)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<EngineChoice> choices;
  choices.reserve(files.size());
  for (const fs::path& file : files) {
    choices.push_back(
        {{file.stem().string(), [file]() -> const Engine& { return open_engine_module(file); }}});
  }
  return choices;
}

Run run_of(const Scenario& scene, const EngineChoice& choice) {
  return run_engines(scene, {choice}, {}, 1).front();
}

RunComparison measured(const Scenario& scene, const EngineChoice& choice) {
  return compare(std::make_shared<Scenario>(scene), {}, {run_of(scene, choice)}, {}).runs.front();
}

/// How far two runs are apart, m; 0 only where they are the same to the last bit.
double apart_m(const Trajectory& a, const Trajectory& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.frames(); ++k) {
    for (std::size_t i = 0; i < a.balls(); ++i) {
      if (!a.present(k, i)) continue;
      largest = std::max(largest, (a.frame(k)[i].position - b.frame(k)[i].position).norm());
      if (a.frame(k)[i].velocity != b.frame(k)[i].velocity) {
        largest = std::max(largest, std::numeric_limits<double>::denorm_min());
      }
    }
  }
  return largest;
}

/// An event that changes nothing.
Event no_op(double time_s, std::size_t ball = 0) {
  return {time_s, ball, {ScaleMass{1.0}}};
}

Scenario rough_gas(int dimension, std::uint64_t seed) {
  return *gas(dimension, 30, 0.1, 20.0, seed,
              "[effects]\nspin = true\n[contact]\nrestitution = 0.9\nfriction = 0.3\n");
}

// --- cuts

/// Straight flights are rounded once in the life of a list of pairs, and where an event ends one; an impact
/// of balls a few radii apart makes an error at most ten times as large, and a ball has two of them here.
TEST(Events, ThatDoNothing_ChangeNoMoreThanRounding_WhereTheyFallOnTheEndOfAStep) {
  for (const int dimension : {2, 3}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      Scenario scene = rough_gas(dimension, seed);
      // Frames are 0.1 s apart and steps 0.005 s long: on a frame, on a step, twice at once, at both ends.
      Scenario cut = scene;
      for (const double time : {0.0, 0.2, 0.335, 0.335, 0.34, 0.7, 0.995, 1.0}) {
        cut.events.push_back(no_op(time, 3));
      }
      for (const char* name : {"carom:toi", "carom:step"}) {
        SCOPED_TRACE(testing::Message() << dimension << "D, seed " << seed << ", " << name);
        const carom::Run whole = run_of(scene, carom_choice(name));
        const carom::Run parts = run_of(cut, carom_choice(name));
        ASSERT_EQ(parts.status, RunStatus::ok) << parts.reason;
        EXPECT_LE(apart_m(whole.trajectory, parts.trajectory), 100.0 * 8.0 * kEpsilon * 20.0);
        EXPECT_EQ(parts.steps, whole.steps);
        const Tally& a = whole.trajectory.tally(10);
        const Tally& b = parts.trajectory.tally(10);
        EXPECT_EQ(a.impacts, b.impacts);
        EXPECT_EQ(a.wall_impacts, b.wall_impacts);
        EXPECT_LE(a.impacts - a.wall_impacts, 30);  // two of each ball, each of two balls
        // The same numbers, added up in parts: each of the sums is rounded once an impact.
        const double rounding = kEpsilon * static_cast<double>(a.impacts) * 200.0;
        EXPECT_NEAR((a.external_impulse - b.external_impulse).norm(), 0.0, rounding);
        EXPECT_NEAR((a.external_angular_impulse - b.external_angular_impulse).norm(), 0.0, 20.0 * rounding);
        EXPECT_NEAR(a.energy.friction_J, b.energy.friction_J, rounding);
        EXPECT_NEAR(a.wall_push_Ns, b.wall_push_Ns, rounding);
      }
    }
  }
}

TEST(Events, WithinAStep_CutItInto_TheFewestStepsNotLongerThanAsked) {
  Scenario scene = rough_gas(2, 1);
  scene.events = {no_op(0.1011), no_op(0.1511)};
  // 0.1 … 0.1011: 1; … 0.1511: 10; … 0.2: ⌈0.0489/0.005⌉ = 10; the other nine intervals 20 each.
  EXPECT_EQ(run_of(scene, carom_choice("carom:toi")).steps, 9 * 20 + 1 + 10 + 10);
  const std::vector<Part> parts = parts_of_interval(scene, 2, 0);
  ASSERT_EQ(parts.size(), 3U);
  double sum = 0.0;
  for (const Part& part : parts) {
    EXPECT_LE(part.step_s, 0.005 * (1.0 + 4.0 * kEpsilon));
    sum += part.step_s * static_cast<double>(part.steps);
  }
  EXPECT_NEAR(sum, 0.1, 4.0 * kEpsilon);
  EXPECT_EQ(parts[0].events + parts[1].events, 2U);
  EXPECT_EQ(parts[2].events, 0U);
}

/// Flights without steps are cut by an event, and rounded there: ε of the place and of what the speed covers,
/// which impacts make grow. Few of them, so by little.
TEST(Events, ThatDoNothing_ChangeNoMoreThanRounding_InFlightsWithoutSteps) {
  Scenario scene = *gas(2, 8, 0.05, 20.0, 1, "");
  Scenario cut = scene;
  for (const double time : {0.1, 0.25, 0.3333, 0.9}) cut.events.push_back(no_op(time));
  const carom::Run whole = run_of(scene, carom_choice("carom:event"));
  const carom::Run parts = run_of(cut, carom_choice("carom:event"));
  ASSERT_EQ(parts.status, RunStatus::ok) << parts.reason;
  const auto impacts = static_cast<double>(whole.trajectory.tally(10).impacts);
  EXPECT_GT(impacts, 0.0);
  EXPECT_EQ(parts.trajectory.tally(10).impacts, whole.trajectory.tally(10).impacts);
  // An impact of balls a few radii apart makes an error at most ten times as large; here a ball has two.
  EXPECT_LE(apart_m(whole.trajectory, parts.trajectory), 100.0 * 8.0 * kEpsilon * 20.0);
}

// --- what events do is what the balls are then, in every engine

/// Six balls in the plane, smooth and elastic, in a box or without; what happens to them is every kind of
/// event.
Scenario eventful(bool in_a_box, std::uint64_t seed) {
  Random random(seed);
  std::vector<Ball> balls;
  for (int i = 0; i < 6; ++i) {
    Ball ball;
    ball.mass = random.uniform(0.5, 2.0);
    ball.radius = random.uniform(0.4, 0.6);
    ball.position = Vec3(2.0 + 2.5 * (i % 3), 2.0 + 3.0 * (i / 3), 0.0);
    ball.velocity = random_vector(random, 2, 2.0);
    balls.push_back(ball);
  }
  Scenario scene = free_scene(2, balls, 3.0, 0.002);
  scene.frames = 30;
  if (in_a_box) {
    scene.walls = {
        {Vec3::UnitX(), 0.0}, {-Vec3::UnitX(), -9.0}, {Vec3::UnitY(), 0.0}, {-Vec3::UnitY(), -7.0}};
  }
  Ball added = balls[0];
  added.position = Vec3(0.7, 3.5, 0.0);
  added.velocity = Vec3(1.0, -0.5, 0.0);
  scene.events = {{0.31, 0, {ScaleMass{1.1}, ScaleRadius{1.05}}},
                  {0.6, 1, {ScaleMass{0.9}, ScaleRadius{0.95}}},
                  {0.9, 2, {SetVelocity{Vec3(-1.0, 2.0, 0.0)}}},
                  {1.2, 3, {SetPosition{Vec3(8.3, 6.3, 0.0)}}},
                  {1.5003, 0, {AddBall{added}}},
                  {2.0, 4, {RemoveBall{}}},
                  {2.2, 6, {ScaleMass{3.0}}}};
  return scene;
}

TEST(Events, OfEveryKind_AreBooked_SoThatEnergyAndMomentaAreAsExpected) {
  for (const bool in_a_box : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Scenario scene = eventful(in_a_box, seed);
      for (const char* name : {"carom", "carom:event", "carom:toi"}) {
        SCOPED_TRACE(testing::Message() << name << ", seed " << seed << (in_a_box ? ", in a box" : ", free"));
        const RunComparison result = measured(scene, carom_choice(name));
        ASSERT_EQ(result.run.status, RunStatus::ok) << result.run.reason;
        ASSERT_EQ(result.run.interferences.size(), scene.events.size());
        // Each impact and each event rounds the sums by some ε; energies here grow to ten times E_0.
        const auto impacts = static_cast<double>(result.run.trajectory.tally(30).impacts);
        const double rounding = 16.0 * 10.0 * kEpsilon * (impacts + 20.0);
        EXPECT_LE(*result.metrics[Metric::energy], rounding);
        EXPECT_LE(*result.metrics[Metric::momentum], rounding);
        EXPECT_LE(*result.metrics[Metric::angular_momentum], rounding);
      }
    }
  }
}

/// The sum over all causes is the change of energy; and what events brought is not small here.
TEST(Events, AreACauseOfTheirOwn_WhereTheEnergyWent) {
  const Scenario scene = eventful(true, 1);
  const RunComparison result = measured(scene, carom_choice("carom:toi"));
  ASSERT_TRUE(result.energy_split);
  EXPECT_GT(std::abs(result.energy_split->events_J), 0.1);
  EXPECT_NEAR(result.energy_split->flight_J, 0.0, 1e-12);
  EXPECT_NEAR(result.energy_split->ball_impacts_J, 0.0, 1e-12);
}

/// Each engine alone decides how exactly it conserves; no engine may be off by what an event brings, which is
/// of the size of the scales.
TEST(Events, AreTakenByEveryEngine) {
  Scenario scene = eventful(true, 2);
  for (const EngineChoice& choice : modules()) {
    SCOPED_TRACE(choice.source.name);
    const RunComparison result = measured(scene, choice);
    ASSERT_EQ(result.run.status, RunStatus::ok) << result.run.reason;
    EXPECT_LE(*result.metrics[Metric::momentum], 1e-4);
    EXPECT_LE(*result.metrics[Metric::energy], 0.05);
    for (std::size_t i = 0; i < 7; ++i) {
      EXPECT_EQ(result.run.trajectory.present(30, i), i != 4);
      EXPECT_EQ(result.run.trajectory.frame(30)[i].position.allFinite(), i != 4);
      EXPECT_EQ(result.run.trajectory.frame(14)[i].position.allFinite(), i != 6);
    }
  }
  EXPECT_GE(modules().size(), 1U);
}

TEST(Events, OfGravity_AreExpected_WithTheMassesOfTheirTime) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Scenario scene = eventful(false, seed);
    scene.effects.gravity = Vec3(0.3, -9.81, 0.0);
    const RunComparison result = measured(scene, carom_choice("carom:toi"));
    ASSERT_EQ(result.run.status, RunStatus::ok) << result.run.reason;
    // Places reach 45 m and speeds 30 m/s at steps of 2 ms: 1500 of them round what is summed up.
    const double rounding = 1500.0 * 64.0 * kEpsilon;
    EXPECT_LE(*result.metrics[Metric::energy], rounding) << "seed " << seed;
    EXPECT_LE(*result.metrics[Metric::momentum], rounding) << "seed " << seed;
    EXPECT_LE(*result.metrics[Metric::angular_momentum], rounding) << "seed " << seed;
  }
}

/// Linear drag takes c Σ Δx, and leaps are no way: they would be c · 5 m = 1 N s here. A step h takes the
/// mean of the velocities at its ends for that in between; what is left of Σ c Δx is at most h²/12 of
/// c |v''| T = c (c/m)² |v| T for each ball, with m >= 0.45 kg and |v| <= 6 m/s.
TEST(Events, UnderDrag_LeapsAreNoWay) {
  Scenario scene = eventful(false, 3);
  constexpr double kDrag = 0.2;
  scene.effects.drag = Drag{Drag::Kind::linear, kDrag};
  const double scale_Ns = Reference(scene).momentum_scale_Ns;
  for (const double step_s : {0.004, 0.002, 0.001}) {
    scene.step_s = step_s;
    const double left_Ns = step_s * step_s / 12.0 * kDrag * std::pow(kDrag / 0.45, 2) * 6.0 * 3.0 * 7.0;
    const RunComparison result = measured(scene, carom_choice("carom:toi"));
    ASSERT_EQ(result.run.status, RunStatus::ok) << result.run.reason;
    EXPECT_LE(*result.metrics[Metric::momentum], left_Ns / scale_Ns) << "step " << step_s;
  }
}

TEST(Events, ASpinningBallThatGrows_KeepsItsAngularMomentum_InTheBooksToo) {
  Scenario scene = free_scene(2, {Ball{}}, 1.0, 0.01);
  scene.frames = 10;
  scene.effects.spin = true;
  scene.balls[0].velocity = Vec3(1, 0, 0);
  scene.balls[0].spin = Vec3(0, 0, 5);
  scene.events = {{0.5, 0, {ScaleRadius{2.0}}}};
  const carom::Run run = run_of(scene, carom_choice("carom:toi"));
  EXPECT_EQ(run.trajectory.frame(10)[0].spin.z(), 1.25);
  const Conserved brought = brought_by(Reference(scene), run.interferences.front());
  EXPECT_EQ(brought.angular_momentum_Nms.z(), 0.0);
  EXPECT_EQ(brought.momentum_Ns, Vec3::Zero());
  EXPECT_EQ(brought.energy_J, -0.5 * 0.4 * 25.0 * 0.75);
}

// --- overlaps

/// Two balls lie near each other, and one grows into the other: contact at once, of balls that do not
/// approach, so nothing is pushed. carom's evolvers in time neither gain nor lose; `step` moves them apart.
TEST(Events, ThatMakeBallsOverlap_GainNoEnergy_AndAreTold) {
  for (const double approach : {0.0, 0.5}) {
    Scenario scene = free_scene(2, {Ball{}, Ball{}}, 1.0, 0.001);
    scene.frames = 10;
    for (Ball& ball : scene.balls) ball.radius = 0.5;
    scene.balls[1].position = Vec3(1.2, 0.0, 0.0);
    scene.balls[0].velocity = Vec3(approach, 0.1, 0.0);
    scene.balls[1].velocity = Vec3(0.0, 0.1, 0.0);
    scene.events = {{0.1, 0, {ScaleRadius{1.6}}}};
    for (const char* name : {"carom", "carom:event", "carom:toi", "carom:step"}) {
      SCOPED_TRACE(testing::Message() << name << ", approaching at " << approach);
      const RunComparison result = measured(scene, carom_choice(name));
      ASSERT_EQ(result.run.status, RunStatus::ok) << result.run.reason;
      const double gap = 1.2 - 0.1 * approach - 0.5 - 0.8;
      EXPECT_NEAR(result.run.interferences.front().overlap_radii, -gap / 0.5, 1e-12);
      EXPECT_LE(*result.metrics[Metric::energy], 16.0 * kEpsilon);
      EXPECT_LE(*result.metrics[Metric::momentum], 16.0 * kEpsilon);
    }
  }
}

// --- what an engine is asked and says

TEST(Events, AnEngineThatChooses_ChoosesAnew_AndSaysSo) {
  Scenario scene = free_scene(2, {Ball{}, Ball{}}, 1.0, 0.01);
  scene.frames = 10;
  scene.balls[1].position = Vec3(5, 5, 0);
  scene.effects.gravity = Vec3(0, -9.81, 0);
  scene.walls = {{Vec3::UnitY(), -100.0}};
  const carom::Run run = run_of(scene, carom_choice("carom"));
  scene.events = {no_op(0.5)};
  const carom::Run cut = run_of(scene, carom_choice("carom"));
  EXPECT_EQ(cut.settings.at("evolver"), run.settings.at("evolver"));
  // `event` lays no ball on a ball: put there, it is refused from then on.
  scene.balls[0].mass = std::numeric_limits<double>::infinity();
  scene.events = {{0.5, 1, {SetPosition{Vec3(0, 2, 0)}, SetVelocity{Vec3::Zero()}}}};
  const carom::Run refused = run_of(scene, carom_choice("carom:event"));
  EXPECT_EQ(refused.status, RunStatus::unsupported);
  EXPECT_THAT(refused.reason, HasSubstr("lies on ball"));
  EXPECT_THAT(refused.reason, HasSubstr("from t = 0.5 s on"));
}

TEST(Events, ThatTakeAllBalls_LeaveAnEmptyScene) {
  Scenario scene = free_scene(2, {Ball{}}, 1.0, 0.01);
  scene.frames = 10;
  scene.balls[0].velocity = Vec3(1, 0, 0);
  Ball added;
  added.velocity = Vec3(0, 2, 0);
  scene.events = {{0.25, 0, {RemoveBall{}}}, {0.75, 0, {AddBall{added}}}};
  for (const EngineChoice& choice : modules()) {
    const carom::Run run = run_of(scene, choice);
    ASSERT_EQ(run.status, RunStatus::ok) << choice.source.name << ": " << run.reason;
    EXPECT_NEAR(run.trajectory.frame(10)[1].position.y(), 0.5, 1e-5) << choice.source.name;
  }
  EXPECT_LE(*measured(scene, carom_choice("carom:toi")).metrics[Metric::momentum], 4.0 * kEpsilon);
}

/// A second stage that drew what the first did would let the same balls pass again.
TEST(Events, ABarrierDrawsAnew_AfterThem) {
  Scenario scene = free_scene(2, {}, 4.0, 0.05);
  scene.frames = 4;
  scene.effects.collisions = false;
  Barrier barrier;
  barrier.offset = 1.0;
  barrier.thickness = 1.0;
  barrier.height = 1.0;
  scene.barriers = {barrier};
  constexpr std::size_t kBalls = 400;
  for (std::size_t i = 0; i < kBalls; ++i) {
    Ball ball;
    ball.radius = 1e-3;
    ball.position = Vec3(0.0, static_cast<double>(i), 0.0);
    ball.velocity = Vec3(1.0, 0.0, 0.0);
    scene.balls.push_back(ball);
  }
  for (std::size_t i = 0; i < kBalls; ++i) {
    scene.events.push_back(
        {2.0, i, {SetPosition{scene.balls[i].position}, SetVelocity{scene.balls[i].velocity}}});
  }
  const carom::Run run = run_of(scene, carom_choice("carom:toi"));
  ASSERT_EQ(run.status, RunStatus::ok) << run.reason;
  std::size_t same = 0;
  for (std::size_t i = 0; i < kBalls; ++i) {
    const bool first = run.interferences[i].changes[0].before->velocity.x() > 0.0;
    const bool second = run.trajectory.frame(4)[i].velocity.x() > 0.0;
    same += first == second ? 1 : 0;
  }
  // Independent draws with p = 0.42 agree in p² + (1 - p)² = 0.513 of the cases, ± 0.025: five of these.
  EXPECT_NEAR(static_cast<double>(same) / kBalls, 0.513, 0.125);
}

}  // namespace
}  // namespace carom::test
