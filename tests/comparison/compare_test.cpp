#include "comparison/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "comparison/overlap.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

/// A trajectory made by a function of time; the tally likewise.
using StatesAt = std::function<std::vector<BallState>(double)>;

Run made_run(
    const Scenario& scene, const StatesAt& states_at, const std::string& engine = "engine",
    const std::function<Tally(double)>& tally_at = [](double) { return Tally{}; }) {
  Run run;
  run.engine = engine;
  run.profile = "faithful";
  run.trajectory = Trajectory(scene);
  for (std::size_t k = 0; k < run.trajectory.frames(); ++k) {
    const double t = run.trajectory.time(k);
    const std::vector<BallState> states = states_at(t);
    std::copy(states.begin(), states.end(), run.trajectory.frame(k).begin());
    run.trajectory.tally(k) = tally_at(t);
  }
  return run;
}

Truth made_truth(const Scenario& scene, const StatesAt& states_at) {
  Truth truth;
  truth.kind = "closed-form";
  truth.trajectory = made_run(scene, states_at).trajectory;
  return truth;
}

std::shared_ptr<Scenario> one_ball() {
  auto scene = std::make_shared<Scenario>();
  scene->duration_s = 1.0;
  scene->frames = 10;
  Ball ball;
  ball.mass = 2.0;
  ball.radius = 0.1;
  ball.position = Vec3(0, 1, 0);
  ball.velocity = Vec3(3, 0, 0);
  scene->balls = {ball};
  return scene;
}

StatesAt straight(double speed_factor = 1.0) {
  return [speed_factor](double t) {
    return std::vector<BallState>{
        {Vec3(3 * t, 1, 0), Vec3(3 * (t > 0 ? speed_factor : 1.0), 0, 0), Vec3::Zero()}};
  };
}

SceneComparison compared(const std::shared_ptr<Scenario>& scene, const StatesAt& states, Truth truth = {}) {
  return compare(scene, std::move(truth), {made_run(*scene, states)}, {"engine"});
}

TEST(Compare, FreeFlight_HasNoErrors_AndNoPositionWithoutATruth) {
  const SceneComparison result = compared(one_ball(), straight());
  const Metrics& metrics = result.runs[0].metrics;
  EXPECT_EQ(metrics[Metric::energy], 0.0);
  EXPECT_EQ(metrics[Metric::momentum], 0.0);
  EXPECT_EQ(metrics[Metric::penetration], 0.0);
  EXPECT_FALSE(metrics[Metric::position]);
  EXPECT_FALSE(metrics[Metric::escaped]);  // there is no wall to be behind
  EXPECT_EQ(result.runs[0].verdict, Verdict::shown);
}

TEST(Compare, EnergyGainAndLoss_AreTheTwoSides) {
  const double factor = std::sqrt(1.1);  // energy × 1.1
  Metrics metrics = compared(one_ball(), straight(factor)).runs[0].metrics;
  EXPECT_NEAR(*metrics[Metric::energy], 0.1, 1e-14);
  EXPECT_NEAR(*metrics[Metric::energy_gain], 0.1, 1e-14);
  EXPECT_EQ(*metrics[Metric::energy_loss], 0.0);
  metrics = compared(one_ball(), straight(std::sqrt(0.9))).runs[0].metrics;
  EXPECT_NEAR(*metrics[Metric::energy], 0.1, 1e-14);
  EXPECT_NEAR(*metrics[Metric::energy_loss], 0.1, 1e-14);
}

TEST(Compare, WithLossyImpacts_ARiseIsAViolation_AndALossIsNot) {
  const auto scene = one_ball();
  scene->walls = {{Vec3::UnitY(), 0.0}};
  scene->wall_contact.restitution = 0.5;
  scene->gate.under_test[Metric::energy] = 1e-3;
  const RunComparison loses = compared(scene, straight(0.5)).runs[0];
  EXPECT_EQ(loses.verdict, Verdict::pass);
  EXPECT_EQ(loses.metrics[Metric::energy], 0.0);
  EXPECT_FALSE(loses.metrics[Metric::energy_loss]);
  // Down to half the speed and then up again to three quarters: a gain, though below the start.
  const RunComparison regains = compared(scene, [](double t) {
                                  return std::vector<BallState>{{Vec3(3 * t, 1, 0),
                                                                 Vec3(t == 0    ? 3.0
                                                                      : t < 0.5 ? 1.5
                                                                                : 2.25,
                                                                      0, 0),
                                                                 Vec3::Zero()}};
                                }).runs[0];
  EXPECT_EQ(regains.verdict, Verdict::fail);
  EXPECT_NEAR(*regains.metrics[Metric::energy_gain], 0.75 * 0.75 - 0.25, 1e-14);
}

TEST(Compare, Momentum_CountsInWhatTheWallsPushed) {
  const auto scene = one_ball();
  scene->walls = {{-Vec3::UnitX(), -2.0}};
  const auto bounced = [](double t) {
    return t < 0.5 ? std::vector<BallState>{{Vec3(3 * t, 1, 0), Vec3(3, 0, 0), Vec3::Zero()}}
                   : std::vector<BallState>{{Vec3(3 - 3 * t, 1, 0), Vec3(-3, 0, 0), Vec3::Zero()}};
  };
  const auto booked = [](double t) {
    Tally tally;
    if (t >= 0.5) tally.external_impulse = Vec3(-12, 0, 0);
    if (t >= 0.5) tally.external_angular_impulse = Vec3(1.5, 1, 0).cross(tally.external_impulse);
    return tally;
  };
  const Metrics right = compare(scene, {}, {made_run(*scene, bounced, "engine", booked)}, {}).runs[0].metrics;
  EXPECT_NEAR(*right[Metric::momentum], 0.0, 1e-15);
  EXPECT_NEAR(*right[Metric::angular_momentum], 0.0, 1e-15);
  const Metrics forgotten = compare(scene, {}, {made_run(*scene, bounced)}, {}).runs[0].metrics;
  EXPECT_NEAR(*forgotten[Metric::momentum], 2.0, 1e-15);
  const auto cannot_tell = [](double) { return Tally{.external_known = false}; };
  const Metrics unknown =
      compare(scene, {}, {made_run(*scene, bounced, "engine", cannot_tell)}, {}).runs[0].metrics;
  EXPECT_FALSE(unknown[Metric::momentum]);
}

TEST(Compare, Gravity_IsExpectedInEnergyMomentumAndAngularMomentum) {
  const auto scene = one_ball();
  scene->effects.gravity = Vec3(0, -10, 0);
  Ball other = scene->balls[0];
  other.mass = 5.0;
  other.position = Vec3(-4, 2, 0);
  other.velocity = Vec3(0, 7, 0);
  scene->balls.push_back(other);
  const auto fall = [&](double t) {
    std::vector<BallState> states;
    for (const Ball& ball : scene->balls) {
      states.push_back({ball.position + t * ball.velocity + 0.5 * t * t * Vec3(0, -10, 0),
                        ball.velocity + t * Vec3(0, -10, 0), Vec3::Zero()});
    }
    return states;
  };
  const Metrics metrics = compared(scene, fall).runs[0].metrics;
  EXPECT_NEAR(*metrics[Metric::energy], 0.0, 1e-14);
  EXPECT_NEAR(*metrics[Metric::momentum], 0.0, 1e-14);
  EXPECT_NEAR(*metrics[Metric::angular_momentum], 0.0, 1e-14);
}

TEST(Compare, LinearDrag_ExplainsTheMomentumLost) {
  const auto scene = one_ball();
  scene->effects.drag = Drag{Drag::Kind::linear, 4.0};
  const auto slowed = [](double t) {
    return std::vector<BallState>{
        {Vec3(-1.5 * std::expm1(-2 * t), 1, 0), Vec3(3 * std::exp(-2 * t), 0, 0), Vec3::Zero()}};
  };
  EXPECT_NEAR(*compared(scene, slowed).runs[0].metrics[Metric::momentum], 0.0, 1e-15);
  EXPECT_FALSE(compared(scene, slowed).runs[0].metrics[Metric::angular_momentum]);
}

TEST(Compare, Position_IsTheFarthestBallAgainstTheTruth_UpToTheHorizon) {
  const auto scene = one_ball();
  const auto late = [](double t) {
    return std::vector<BallState>{{Vec3(3 * t + (t > 0.55 ? 0.25 : 0.0), 1, 0), Vec3(3, 0, 0), Vec3::Zero()}};
  };
  Truth truth = made_truth(*scene, straight());
  const SceneComparison whole = compared(scene, late, truth);
  EXPECT_NEAR(*whole.runs[0].metrics[Metric::position], 0.25, 1e-15);
  EXPECT_NEAR(*whole.runs[0].metrics[Metric::position_rms], 0.25 * std::sqrt(5.0 / 11.0), 1e-15);
  ASSERT_TRUE(whole.runs[0].first_divergence);
  EXPECT_NEAR(whole.runs[0].first_divergence->time_s, 0.6, 1e-15);
  EXPECT_EQ(whole.runs[0].first_divergence->balls, std::vector<std::size_t>{0});
  EXPECT_EQ(whole.runs[0].first_divergence->metric, Metric::position);
  truth.horizon_s = 0.5;
  const SceneComparison until = compared(scene, late, truth);
  EXPECT_EQ(until.runs[0].metrics[Metric::position], 0.0);
  EXPECT_FALSE(until.runs[0].first_divergence);
}

TEST(Compare, AFrameAtAnImpact_MayShowEitherSideOfIt) {
  const auto scene = one_ball();
  scene->walls = {{-Vec3::UnitX(), -10.0}};
  scene->wall_contact.restitution = 0.5;
  // The impact is at t = 0.5, which is a frame: the truth shows what is before, the engine what is after.
  const auto halves = [](double from) {
    return [from](double t) {
      return std::vector<BallState>{{Vec3(1.5, 1, 0), Vec3(t < from ? 3.0 : -1.5, 0, 0), Vec3::Zero()}};
    };
  };
  Truth truth = made_truth(*scene, halves(0.51));
  EXPECT_GT(*compared(scene, halves(0.49), truth).runs[0].metrics[Metric::energy], 0.5);
  truth.around = {made_run(*scene, halves(0.51)).trajectory, made_run(*scene, halves(0.49)).trajectory};
  EXPECT_EQ(compared(scene, halves(0.49), truth).runs[0].metrics[Metric::energy], 0.0);
}

TEST(Compare, Escaped_CountsBallsWhoseCentreWasBehindAWall) {
  const auto scene = one_ball();
  scene->walls = {{-Vec3::UnitX(), -2.0}};
  EXPECT_EQ(*compared(scene, straight()).runs[0].metrics[Metric::escaped], 1.0);
  scene->walls[0].offset = -4.0;
  EXPECT_EQ(*compared(scene, straight()).runs[0].metrics[Metric::escaped], 0.0);
}

double deepest_of_all(const Scenario& scene, const std::vector<BallState>& states) {
  double deepest = 0.0;
  for (std::size_t a = 0; a < states.size(); ++a) {
    for (const Wall& wall : scene.walls) {
      const double gap = wall.normal.dot(states[a].position) - wall.offset;
      deepest = std::max(deepest, (scene.balls[a].radius - gap) / scene.balls[a].radius);
    }
    for (std::size_t b = a + 1; b < states.size(); ++b) {
      const double reach = scene.balls[a].radius + scene.balls[b].radius;
      const double overlap = reach - (states[a].position - states[b].position).norm();
      deepest = std::max(deepest, overlap / std::min(scene.balls[a].radius, scene.balls[b].radius));
    }
  }
  return deepest;
}

// Alike or not in size, still or fast, few cells or many, a wall that some touch, that one all but touches or
// that is far: they are searched for in different ways.
TEST(OverlapSearch, AgreesWithLookingAtAllPairsAndWalls_FrameAfterFrame) {
  Random random(3);
  for (int trial = 0; trial < 60; ++trial) {
    const int dimension = trial % 2 == 0 ? 2 : 3;
    const double smallest_m = trial % 3 == 0 ? 0.01 : 0.1;
    const double way_m = trial % 5 == 0 ? 0.5 : 0.01 * (trial % 4);  // in a frame
    const double room_m = trial % 7 == 0 ? 20.0 : 1.0;
    Scenario scene;
    for (int i = 0; i < 60; ++i) {
      Ball ball;
      ball.radius = random.uniform(smallest_m, 0.3);
      ball.position = random_vector(random, dimension, room_m);
      ball.velocity = random_vector(random, dimension, 1.0);
      scene.balls.push_back(ball);
    }
    if (trial % 4 == 0) scene.balls.resize(2);  // so few that a wall's overlap may be the deepest
    const Vec3 normal = random_vector(random, dimension, 1.0).normalized();
    double lowest_m = std::numeric_limits<double>::infinity();
    for (const Ball& ball : scene.balls)
      lowest_m = std::min(lowest_m, normal.dot(ball.position) - ball.radius);
    for (const double below_m : {trial % 3 == 0 ? -0.1 : 1e-15, 3.0}) {
      scene.walls.push_back({normal, lowest_m - below_m});
    }
    OverlapSearch search(scene);
    std::vector<BallState> states = states_of(scene);
    for (int frame = 0; frame < 12; ++frame) {
      EXPECT_DOUBLE_EQ(search.deepest(states), deepest_of_all(scene, states)) << trial << " " << frame;
      for (BallState& state : states) state.position += way_m * state.velocity;
    }
  }
}

TEST(Gates, AreForTheEngineUnderTest_AndForThoseWithATableOfTheirOwn) {
  const auto scene = one_ball();
  scene->gate.under_test[Metric::energy] = 1e-6;
  scene->gate.per_engine["other"][Metric::energy] = 0.5;
  const double factor = std::sqrt(1.1);
  const std::vector<carom::Run> runs = {made_run(*scene, straight(factor), "tested"),
                                        made_run(*scene, straight(factor), "other"),
                                        made_run(*scene, straight(factor), "third")};
  const SceneComparison result = compare(scene, {}, runs, {"tested"});
  EXPECT_EQ(result.runs[0].verdict, Verdict::fail);
  EXPECT_TRUE(result.runs[0].violates());
  EXPECT_EQ(result.runs[1].verdict, Verdict::pass);
  EXPECT_EQ(result.runs[2].verdict, Verdict::shown);
  EXPECT_FALSE(result.runs[2].violates());
}

TEST(Gates, ATableForTheEngineUnderTest_AddsToTheCommonOne) {
  const auto scene = one_ball();
  scene->gate.under_test[Metric::energy] = 1e-6;
  scene->gate.under_test[Metric::momentum] = 1e-6;
  scene->gate.per_engine["engine"][Metric::momentum] = 1e-3;
  const std::vector<GateResult> gates = compared(scene, straight()).runs[0].gates;
  ASSERT_EQ(gates.size(), 2U);
  EXPECT_EQ(gates[0].limit, 1e-6);
  EXPECT_EQ(gates[1].limit, 1e-3);
}

TEST(Gates, OnWhatCannotBeTold_CannotHold) {
  const auto scene = one_ball();
  scene->gate.under_test[Metric::position] = 1.0;
  const RunComparison result = compared(scene, straight()).runs[0];
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_FALSE(result.gates[0].value);
}

TEST(Gates, AnEngineUnderTestThatFails_Violates_AndAnyOtherDoesNot) {
  const auto scene = one_ball();
  scene->gate.under_test[Metric::energy] = 1e-6;
  for (const RunStatus status :
       {RunStatus::crashed, RunStatus::timeout, RunStatus::invalid, RunStatus::unsupported}) {
    carom::Run run = made_run(*scene, straight());
    run.status = status;
    EXPECT_TRUE(compare(scene, {}, {run}, {"engine"}).runs[0].violates()) << name_of(status);
    EXPECT_FALSE(compare(scene, {}, {run}, {}).runs[0].violates()) << name_of(status);
  }
}

TEST(Pairs, AreEveryTwoEnginesThatRan) {
  const auto scene = one_ball();
  std::vector<carom::Run> runs = {made_run(*scene, straight(), "a"), made_run(*scene, straight(), "b"),
                                  made_run(*scene, straight(2.0), "c")};
  runs[1].status = RunStatus::crashed;
  const SceneComparison result = compare(scene, {}, runs, {});
  ASSERT_EQ(result.pairs.size(), 1U);
  EXPECT_EQ(result.pairs[0].a, 0U);
  EXPECT_EQ(result.pairs[0].b, 2U);
  EXPECT_EQ(result.pairs[0].position_m, 0.0);
  EXPECT_NEAR(*result.pairs[0].energy, 3.0, 1e-15);
  ASSERT_TRUE(result.pairs[0].first_divergence);
  EXPECT_NEAR(result.pairs[0].first_divergence->time_s, 0.1, 1e-15);
}

}  // namespace
}  // namespace carom::test
