#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/compose.h"
#include "carom/world.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

Ball ball(double mass, const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  Ball made;
  made.mass = mass;
  made.radius = 0.1;
  made.position = position;
  made.velocity = velocity;
  return made;
}

/// Kinetic energy with rotation, and the potential energy under gravity, J.
double energy_of(const Scenario& scene, const std::vector<BallState>& states) {
  const Vec3 gravity = scene.effects.gravity.value_or(Vec3::Zero());
  double sum = kinetic_energy_of(scene, states);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Ball& each = scene.balls[i];
    sum += 0.5 * each.inertia * each.mass * each.radius * each.radius * states[i].spin.squaredNorm();
    sum -= each.mass * gravity.dot(states[i].position);
  }
  return sum;
}

double sum_of(const EnergyAccount& energy) {
  return energy.ball_impacts_J + energy.wall_impacts_J + energy.friction_J + energy.correction_J;
}

/// What a run of a scene changed, and what its account says of it.
struct Outcome {
  double change_J = 0.0;
  EnergyAccount account;
  std::int64_t impacts = 0;
};

Outcome outcome_of(const Scenario& scene, const std::string& evolver, std::int64_t steps) {
  const auto simulation = compose(scene, {evolver, ""});
  const double before_J = energy_of(scene, states_of(scene));
  const double after_J = energy_of(scene, run(*simulation, scene, steps));
  return {after_J - before_J, simulation->tally().energy, simulation->tally().impacts};
}

class Energy : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Evolvers, Energy, testing::Values("event", "toi", "step"),
                         [](const auto& info) { return std::string(info.param); });

// Without fields nothing changes energy but pushes, so that the account must explain all of it: to a few
// roundings of the energies in each impact.
TEST_P(Energy, Account_ExplainsEveryJoule_InRoughLossyGas) {
  for (const int dimension : {2, 3}) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      Scenario scene = *gas(dimension, 40, 0.1, 20.0, seed);
      scene.duration_s = 20.0;
      scene.effects.spin = true;
      scene.ball_contact = {0.9, 0.2, 0.3};
      scene.wall_contact = {0.7, 0.4, 0.0};
      const Outcome outcome = outcome_of(scene, GetParam(), 4000);
      EXPECT_TRUE(outcome.account.known);
      EXPECT_GT(outcome.impacts, 20);
      const double energy_J = energy_of(scene, states_of(scene));
      const double rounding_J = 64.0 * kEpsilon * energy_J * static_cast<double>(outcome.impacts);
      EXPECT_NEAR(sum_of(outcome.account), outcome.change_J, rounding_J) << dimension << "D, seed " << seed;
      EXPECT_LT(outcome.account.ball_impacts_J, 0.0);
      EXPECT_LT(outcome.account.wall_impacts_J, 0.0);
      EXPECT_LT(outcome.account.friction_J, 0.0);
      EXPECT_EQ(outcome.account.correction_J, 0.0);
    }
  }
}

TEST_P(Energy, Account_IsZero_InElasticGas) {
  const Scenario scene = *gas(2, 40, 0.1, 20.0, 1);
  const Outcome outcome = outcome_of(scene, GetParam(), 200);
  const double rounding_J =
      64.0 * kEpsilon * energy_of(scene, states_of(scene)) * static_cast<double>(outcome.impacts + 1);
  EXPECT_NEAR(outcome.account.ball_impacts_J, 0.0, rounding_J);
  EXPECT_NEAR(outcome.account.wall_impacts_J, 0.0, rounding_J);
  EXPECT_EQ(outcome.account.friction_J, 0.0);
}

// ½ m (1 - e²) v² with the reduced mass m.
TEST_P(Energy, InelasticImpact_LosesItInBallImpacts) {
  Scenario scene = free_scene(2, {ball(2.0, {0, 0, 0}, {3.0, 0, 0}), ball(6.0, {1, 0, 0})}, 1.0, 0.001);
  scene.ball_contact.restitution = 0.5;
  const Outcome outcome = outcome_of(scene, GetParam(), 1000);
  EXPECT_NEAR(outcome.account.ball_impacts_J, -0.5 * 1.5 * (1.0 - 0.25) * 9.0, 64.0 * kEpsilon * 9.0);
  EXPECT_EQ(outcome.account.wall_impacts_J, 0.0);
  EXPECT_EQ(outcome.account.friction_J, 0.0);
}

TEST_P(Energy, ImmovableBall_CountsAsWall) {
  Scenario scene = free_scene(
      2, {ball(2.0, {0, 0, 0}, {3.0, 0, 0}), ball(std::numeric_limits<double>::infinity(), {1, 0, 0})}, 1.0,
      0.001);
  scene.ball_contact.restitution = 0.5;
  const Outcome outcome = outcome_of(scene, GetParam(), 1000);
  EXPECT_NEAR(outcome.account.wall_impacts_J, -0.5 * 2.0 * (1.0 - 0.25) * 9.0, 64.0 * kEpsilon * 9.0);
  EXPECT_EQ(outcome.account.ball_impacts_J, 0.0);
}

/// A fall of 1 m onto a floor with e = 0.8, seen before the second impact.
Scenario drop(double restitution) {
  Scenario scene = free_scene(2, {ball(2.0, {0, 1.1, 0})}, 0.8, 0.001);
  scene.effects.gravity = Vec3(0, -10.0, 0);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.wall_contact.restitution = restitution;
  return scene;
}

TEST(EnergyUnderGravity, DroppedBall_LosesItAtTheWall_AndFlightKeepsIt) {
  for (const char* evolver : {"event", "toi"}) {
    const Outcome outcome = outcome_of(drop(0.8), evolver, 800);
    const double lost_J = (1.0 - 0.64) * 2.0 * 10.0 * 1.0;
    // Heights and speeds are rounded in each step.
    const double rounding_J = 800.0 * kEpsilon * 20.0;
    EXPECT_NEAR(outcome.account.wall_impacts_J, -lost_J, rounding_J) << evolver;
    EXPECT_NEAR(outcome.change_J, -lost_J, rounding_J) << evolver;
  }
}

// The fixed step lifts the ball out of the floor by up to v h: energy that came from no push.
TEST(EnergyUnderGravity, FixedStep_GivesEnergyByPositionCorrection) {
  const Scenario scene = drop(1.0);
  const Outcome outcome = outcome_of(scene, "step", 800);
  EXPECT_GT(outcome.account.correction_J, 0.0);
  const double speed_mps = std::sqrt(2.0 * 10.0);
  EXPECT_LE(outcome.account.correction_J, 1.01 * 2.0 * 10.0 * speed_mps * scene.step_s);
  EXPECT_NEAR(outcome.account.wall_impacts_J, 0.0, 64.0 * kEpsilon * 20.0);
}

// The last bounces are taken in one piece, by a crowd of one, which gives the ball what gravity gives in the
// whole step, ½ m (g h)², and takes it again.
TEST(EnergyUnderGravity, BallThatComesToRest_HasLostAllOfItAtTheWall) {
  Scenario scene = drop(0.5);
  scene.duration_s = 4.0;
  const Outcome outcome = outcome_of(scene, "toi", 4000);
  const double crowd_J = 0.5 * 2.0 * std::pow(10.0 * 0.001, 2);
  EXPECT_NEAR(outcome.account.wall_impacts_J, -20.0, crowd_J);
  EXPECT_NEAR(outcome.change_J, -20.0, 4000.0 * kEpsilon * 20.0);
  EXPECT_EQ(outcome.account.ball_impacts_J, 0.0);
}

// A ball slides and then rolls, v = 5/7 v0: friction takes ½ m v0² (1 - 5/7).
TEST(EnergyUnderGravity, SlidingBall_LosesToFriction_WhatRollingDoesNotNeed) {
  Scenario scene = free_scene(3, {ball(2.0, {0, 0, 0.1}, {1.0, 0, 0})}, 2.0, 0.001);
  scene.effects.gravity = Vec3(0, 0, -10.0);
  scene.effects.spin = true;
  scene.walls = {{Vec3::UnitZ(), 0.0}};
  scene.wall_contact = {0.0, 0.2, 0.0};
  const Outcome outcome = outcome_of(scene, "toi", 2000);
  const double rounding_J = 2000.0 * 16.0 * kEpsilon * 1.0;
  EXPECT_NEAR(outcome.account.friction_J, -2.0 / 7.0, rounding_J);
  EXPECT_NEAR(sum_of(outcome.account), outcome.change_J, rounding_J);
  EXPECT_NEAR(outcome.account.wall_impacts_J, 0.0, rounding_J);
}

/// Five touching balls and one that arrives: all contacts are closed at once.
TEST(EnergyOfTouchingBalls, Account_ExplainsEveryJoule_UnderEveryLaw) {
  for (const MultiContact law :
       {MultiContact::sequential, MultiContact::simultaneous, MultiContact::generalized_reflections}) {
    for (const double e : {1.0, 0.6}) {
      std::vector<Ball> balls = {ball(1.0, {-0.5, 0, 0}, {1.0, 0, 0})};
      for (int i = 0; i < 4; ++i) balls.push_back(ball(1.0 + i, {0.2 * i, 0, 0}));
      Scenario scene = free_scene(2, balls, 1.0, 0.01);
      scene.walls = {{-Vec3::UnitX(), -0.7 - 1e-12}};
      scene.multi_contact = law;
      scene.ball_contact.restitution = scene.wall_contact.restitution = e;
      for (const char* evolver : {"toi", "step"}) {
        const Outcome outcome = outcome_of(scene, evolver, 100);
        EXPECT_NEAR(sum_of(outcome.account), outcome.change_J, 1e3 * kEpsilon)
            << evolver << " " << static_cast<int>(law) << " e = " << e;
      }
    }
  }
}

}  // namespace
}  // namespace carom::test
