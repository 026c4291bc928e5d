#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/reference/energy.h"
#include "tests/reference/support.h"
#include "tests/reference/switches.h"
#include "tests/support/numbers.h"

namespace carom::test {
namespace {

using namespace reference_test;

/// What Chipmunk and ODE have in common: fixed steps in double precision, without continuous collision.
struct Case {
  const char* name;
  int dimension;
};

class DoubleEngine : public testing::TestWithParam<Case> {
 protected:
  const Engine& engine_ = engine(GetParam().name);
  const int dimension_ = GetParam().dimension;

  // A velocity passes through a handful of roundings (itself, the impulse, two updates a side): 8 ε.
  double rounding() const { return 8.0 * epsilon(engine_); }
};

INSTANTIATE_TEST_SUITE_P(Engines, DoubleEngine,
                         testing::Values(Case{"chipmunk", 2}, Case{"ode", 2}, Case{"ode", 3}),
                         [](const testing::TestParamInfo<Case>& info) {
                           return std::string(info.param.name) + std::to_string(info.param.dimension) + "D";
                         });

TEST_P(DoubleEngine, Info_NamesPrecisionAndProfiles) {
  const EngineInfo info = engine_.info();
  EXPECT_EQ(info.name, GetParam().name);
  EXPECT_EQ(info.precision, "float64");
  EXPECT_THAT(info.version, testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
  ASSERT_EQ(info.profiles.size(), 2U);
  EXPECT_EQ(info.profiles[0].name, "faithful");
  EXPECT_EQ(info.profiles[1].name, "default");
}

TEST_P(DoubleEngine, PairCoefficients_AreTheScenes) {
  const Contact low = {0.5, 0.1, 0.0};
  const Contact high = {1.0, 0.3, 0.0};
  // Rounding of the surface speeds, up to 50 m/s, shows in coefficients taken from 10 m/s and less.
  const double tolerance = 10.0 * rounding();
  for (const auto& [balls, walls] : {std::pair{low, high}, {high, low}}) {
    const Measured ball = ball_on_ball(engine_, "faithful", dimension_, balls, walls);
    EXPECT_NEAR(ball.restitution, balls.restitution, tolerance);
    EXPECT_NEAR(ball.friction, balls.friction, tolerance);
    const Measured wall = ball_on_wall(engine_, "faithful", dimension_, balls, walls);
    EXPECT_NEAR(wall.restitution, walls.restitution, tolerance);
    EXPECT_NEAR(wall.friction, walls.friction, tolerance);
  }
}

// Both reflect the velocity from before gravity was added, which retraces the ball's own path.
TEST_P(DoubleEngine, DroppedBall_KeepsItsApex_Over100Bounces) {
  constexpr double kHeight_m = 10.0;
  Scenario scene = scene_of(dimension_, 1e-3, 300000);
  scene.effects.gravity = Vec3(0, -9.81, 0);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.balls = {ball(1.0, 0.5, Vec3(0, 0.5 + kHeight_m, 0))};
  Probe run(engine_, scene);
  double apex_m = 0.0;
  while (run.tally().impacts <= 100) {
    if (run.tally().impacts == 100) apex_m = std::max(apex_m, run[0].position.y() - 0.5);
    run.advance(1);
  }
  // The apex lies up to a quarter of a step's fall, g h²/8, above the highest sample, and where the path is
  // turned round lies within a step of its start, g h²: 1e-5 m in all.
  EXPECT_NEAR(apex_m / kHeight_m, 1.0, 1e-6);
}

// ODE is an engine for space, and nothing holds it to the plane: what acts in the plane has no part across
// it, not even a rounding.
TEST_P(DoubleEngine, PlaneScene_StaysInItsPlane) {
  if (dimension_ == 3) return;
  Scenario scene = gas(2, 8, 1.0 / 240.0, 480);
  scene.effects.spin = true;
  scene.ball_contact = scene.wall_contact = {0.9, 0.3, 0.0};
  scene.walls.push_back({Vec3(0.6, 0.8, 0.0), 0.5});
  for (const char* profile : {"faithful", "default"}) {
    const Probe run = after(engine_, scene, profile);
    for (std::size_t i = 0; i < scene.balls.size(); ++i) {
      EXPECT_EQ(run[i].position.z(), 0.0);
      EXPECT_EQ(run[i].velocity.z(), 0.0);
      EXPECT_EQ(run[i].spin.head<2>(), Eigen::Vector2d::Zero());
    }
  }
}

TEST_P(DoubleEngine, BallThatCanJumpThroughAnother_IsRefusedByTheFaithfulProfile) {
  Scenario scene = scene_of(dimension_, 0.01, 1);
  scene.balls = {ball(1.0, 0.5, Vec3::Zero(), Vec3(69.0, 0, 0)), ball(1.0, 0.2, Vec3(5.0, 0, 0))};
  EXPECT_EQ(engine_.refuses(scene, "faithful"), "");
  scene.balls[0].velocity.x() = 71.0;  // 0.71 m a step, past 0.5 + 0.2
  EXPECT_THAT(engine_.refuses(scene, "faithful"), testing::HasSubstr("continuous collision"));
  EXPECT_EQ(engine_.refuses(scene, "default"), "");
  scene.effects.collisions = false;
  EXPECT_EQ(engine_.refuses(scene, "faithful"), "");
}

TEST_P(DoubleEngine, FastBall_IsHeldByItsWall_AtStepsLongerThanItsDiameter) {
  Scenario scene = scene_of(dimension_, 0.1, 8);
  add_box(scene, 4.0);
  scene.balls = {ball(1.0, 0.1, Vec3(2, 2, dimension_ == 2 ? 0.0 : 2.0), Vec3(9.0, 7.0, 0))};
  ASSERT_EQ(engine_.refuses(scene, "faithful"), "");
  Probe run(engine_, scene);
  for (int step = 0; step < 8; ++step) {
    run.advance(1);
    // No deeper behind the plane than a step's way.
    EXPECT_LE((run[0].position.head<2>() - Eigen::Vector2d(2, 2)).cwiseAbs().maxCoeff(), 2.0 + 0.9);
  }
  EXPECT_NEAR(run[0].velocity.squaredNorm(), 130.0, 130.0 * 8.0 * rounding());
}

TEST_P(DoubleEngine, TwoWorlds_DoNotDisturbEachOther) {
  const Scenario scene = gas(dimension_, 4, 1.0 / 240.0, 240);
  Scenario lossy = scene;
  lossy.ball_contact.restitution = 0.5;
  Probe alone(engine_, scene);
  for (std::int64_t k = 0; k < scene.frames; ++k) alone.advance(1);
  Probe first(engine_, scene);
  Probe other(engine_, lossy);
  for (std::int64_t k = 0; k < scene.frames; ++k) {
    first.advance(1);
    other.advance(1);
  }
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    EXPECT_EQ(first[i].position, alone[i].position);
    EXPECT_EQ(first[i].velocity, alone[i].velocity);
  }
  EXPECT_LT(other.kinetic_energy(), 0.99 * first.kinetic_energy());
}

TEST_P(DoubleEngine, UnknownSwitch_IsRefused) {
  const Scenario scene = scene_for_switches();
  EXPECT_THROW(engine_.create_switched(scene, "default", std::vector<std::string>{"warmth"}),
               std::logic_error);
}

TEST_P(DoubleEngine, FaithfulProfile_PushesNothingOut) {
  Scenario scene = scene_of(dimension_, 0.01, 200);
  scene.effects.gravity = Vec3(0, -10.0, 0);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.wall_contact.restitution = 0.0;
  scene.balls = {ball(1.0, 0.5, Vec3(0, 0.45, 0))};
  // Places are rounded in every step.
  EXPECT_LE(std::abs(after(engine_, scene).tally().energy.correction_J),
            200.0 * epsilon(engine_) * 10.0 * 0.5);
}

// What is peculiar to one of them.

// Chipmunk leaves a tenth of a metre of overlap alone; a ball that is deeper is lifted without a velocity.
TEST(Chipmunk, DefaultProfile_LiftsABallOutOfTheFloor_AllButItsSlop) {
  constexpr double kDepth_m = 0.3;
  constexpr double kSlop_m = 0.1;
  Scenario scene = scene_of(2, 0.01, 400);
  scene.effects.gravity = Vec3(0, -10.0, 0);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.wall_contact.restitution = 0.0;
  scene.balls = {ball(1.0, 0.5, Vec3(0, 0.5 - kDepth_m, 0))};
  const Probe run = after(engine("chipmunk"), scene, "default");
  // In the first step nothing bears the ball yet, and it falls by no more than g h².
  const double fall_m = 10.0 * 0.01 * 0.01;
  EXPECT_NEAR(run[0].position.y(), 0.5 - kSlop_m, 1e-6);
  EXPECT_NEAR(run.tally().energy.correction_J, 10.0 * (kDepth_m - kSlop_m), 10.0 * fall_m);
}

// By default Chipmunk remembers a pair for three steps after it parted. One that meets again starts from the
// sum of its old impulses without applying them, and may even pull. Gravity lets balls meet again at once.
TEST(Chipmunk, Account_ExplainsMomentum_WherePairsPartAndMeetAgain) {
  Scenario scene = gas(2, 16, 1.0 / 60.0, 500);
  scene.effects.gravity = Vec3(0, -10.0, 0);
  scene.ball_contact.restitution = scene.wall_contact.restitution = 0.5;
  const Unexplained rest = unexplained(engine("chipmunk"), scene, "default");
  // The balls fall through 16 m, so that some come to 18 m/s and the places of all are rounded at that size.
  EXPECT_LE(rest.momentum_Ns, 5.0 * momentum_rounding(engine("chipmunk"), scene, rest.tally));
}

// By default ODE takes μ for newtons: in a step of h a ball loses no more than h μ/m of its speed along the
// wall.
TEST(Ode, DefaultFriction_IsAForceAndNoCoefficient) {
  Scenario scene = scene_of(3, 0.01, 30);
  scene.effects.spin = true;
  scene.wall_contact = {0.9, 0.3, 0.0};
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.balls = {ball(1.0, 0.5, Vec3(0, 0.625, 0), Vec3(5.0, -1.0, 0))};
  const double lost_mps = 5.0 - after(engine("ode"), scene, "default")[0].velocity.x();
  EXPECT_GT(lost_mps, 0.0);
  EXPECT_LE(lost_mps, 2.0 * 0.01 * 0.3);  // two steps of contact
  const auto cured =
      engine("ode").create_switched(scene, "default", std::vector<std::string>{"friction_law"});
  EXPECT_NEAR(5.0 - states_after(*cured, scene)[0].velocity.x(), 0.3 * 1.9, 1e-8);
}

// The error reduction goes through the velocity: erp = 0.2 of an overlap δ in a step h leaves it at 0.2 δ/h.
TEST(Ode, DefaultErp_ThrowsOverlappingBallsApart) {
  constexpr double kOverlap_m = 0.1;
  Scenario scene = scene_of(3, 0.01, 1);
  scene.balls = {ball(1.0, 0.5, Vec3::Zero()), ball(1.0, 0.5, Vec3(1.0 - kOverlap_m, 0, 0))};
  const Probe run = after(engine("ode"), scene, "default");
  // The default's softness, 1e-10 s/kg, takes a share of 1e-10 · m/(2 h) of it.
  EXPECT_NEAR(run[1].velocity.x() - run[0].velocity.x(), 0.2 * kOverlap_m / 0.01, 1e-7);
  EXPECT_EQ(after(engine("ode"), scene, "faithful")[1].velocity, Vec3::Zero());
}

// Chipmunk's own inertia by default is a disk's, so that only ODE's energy is the scene's in both profiles.
TEST(Ode, EnergyAccount_ExplainsEveryJoule_ByDefaultToo) {
  EXPECT_LE(unexplained_energy_of_gas(engine("ode"), "default", 3), 480.0 * epsilon(engine("ode")));
}

TEST(Ode, DefaultProfile_LosesBouncesBelowItsThreshold) {
  Scenario scene = scene_of(3, 0.01, 300);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.balls = {ball(1.0, 0.5, Vec3(0, 0.5996, 0), Vec3(0, -0.09, 0))};  // below 0.1 m/s
  EXPECT_LT(after(engine("ode"), scene, "default")[0].velocity.y(), 0.02);
  EXPECT_NEAR(after(engine("ode"), scene)[0].velocity.y(), 0.09, 1e-15);
}

}  // namespace
}  // namespace carom::test
