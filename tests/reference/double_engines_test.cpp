#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <variant>

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

TEST_P(DoubleEngine, HeadOnVelocity_MatchesExact_From01To100Mps) {
  EXPECT_LE(head_on_sweep_error(engine_, dimension_), rounding());
}

TEST_P(DoubleEngine, HeadOnVelocity_MatchesExact_AnyRadius) {
  for (const double radius : {1e-5, 1e-3, 0.05, 30.0}) {
    EXPECT_LE(head_on_error(engine_, dimension_, 1.0, 1.0, 100.0, radius), rounding()) << radius;
  }
}

TEST_P(DoubleEngine, WallBounce_MatchesExact_AnyRestitutionAndDirection) {
  for (const double restitution : {1.0, 0.5, 0.0}) {
    for (const double angle : {0.0, 0.4, 1.2, 2.0, 3.5, 5.9}) {
      const Vec3 normal = Vec3(std::cos(angle), std::sin(angle), dimension_ == 3 ? angle : 0.0).normalized();
      EXPECT_LE(wall_error(engine_, dimension_, normal, restitution), rounding())
          << restitution << " " << angle;
    }
  }
}

// Sliding: Δv_t = μ (1 + e) v_n. Sticking: Δv_t = (2/7) g_t. The spin changes by (5/2) Δv_t/r.
TEST_P(DoubleEngine, SpinAndFriction_MatchImpactLaw_SlidingAndSticking) {
  for (const double along_mps : {0.5, 5.0}) {
    Scenario scene = scene_of(dimension_, 0.01, 30);
    scene.effects.spin = true;
    scene.wall_contact = {0.9, 0.3, 0.0};
    scene.walls = {{Vec3::UnitY(), 0.0}};
    scene.balls = {ball(1.0, 0.5, Vec3(0, 0.625, 0), Vec3(along_mps, -1.0, 0))};
    const double slowed = std::min(0.3 * 1.9 * 1.0, 2.0 / 7.0 * along_mps);
    const Probe run = after(engine_, scene);
    EXPECT_LE((run[0].velocity - Vec3(along_mps - slowed, 0.9, 0)).norm(), along_mps * rounding());
    EXPECT_NEAR(run[0].spin.z(), -2.5 * slowed / 0.5, 5.0 * along_mps * rounding());
  }
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

TEST_P(DoubleEngine, Ball_DoesNotRotate_WithoutSpin) {
  const Scenario scene = gas(dimension_, 6, 1.0 / 240.0, 240);
  for (const char* profile : {"faithful", "default"}) {
    const Probe run = after(engine_, scene, profile);
    for (std::size_t i = 0; i < scene.balls.size(); ++i) EXPECT_EQ(run[i].spin, Vec3::Zero());
  }
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

TEST_P(DoubleEngine, Account_ExplainsMomenta_InWalledGas) {
  const Scenario scene = gas(dimension_, dimension_ == 2 ? 16 : 6, 1.0 / 240.0, 1000);
  const Unexplained rest = unexplained(engine_, scene);
  EXPECT_GT(rest.tally.impacts, 500);
  EXPECT_GT(rest.tally.external_impulse.norm(), 1.0);
  EXPECT_LE(rest.momentum_Ns, momentum_rounding(engine_, scene, rest.tally));
  EXPECT_LE(rest.angular_momentum_Nms, angular_momentum_rounding(engine_, scene));
  // Each impact rounds the energies of two balls, 2 ε each.
  const double per_ball = static_cast<double>(rest.tally.impacts) / static_cast<double>(scene.balls.size());
  EXPECT_LE(rest.energy_change, 4.0 * epsilon(engine_) * per_ball);
}

TEST_P(DoubleEngine, Account_ExplainsMomentum_WithGravityAndFriction) {
  Scenario scene = gas(dimension_, 6, 1.0 / 240.0, 500);
  scene.effects.gravity = Vec3(0.3, -0.5, 0);
  scene.effects.spin = true;
  scene.ball_contact = scene.wall_contact = {0.9, 0.3, 0.0};
  for (const char* profile : {"faithful", "default"}) {
    const Unexplained rest = unexplained(engine_, scene, profile);
    EXPECT_LE(rest.momentum_Ns, momentum_rounding(engine_, scene, rest.tally)) << profile;
  }
}

TEST_P(DoubleEngine, Account_ExplainsAngularMomentum_OfFrictionAtWalls) {
  Scenario scene = gas(dimension_, 6, 1.0 / 240.0, 500);
  scene.effects.spin = true;
  scene.wall_contact = {0.9, 0.3, 0.0};
  const Unexplained rest = unexplained(engine_, scene);
  EXPECT_LE(rest.angular_momentum_Nms, angular_momentum_rounding(engine_, scene));
}

TEST_P(DoubleEngine, Bounces_AreCountedOnce_WhileBallRests) {
  Scenario scene = scene_of(dimension_, 0.004, 2000);
  scene.effects.gravity = Vec3(0, -9.81, 0);
  scene.wall_contact.restitution = 0.0;
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.balls = {ball(1.0, 0.5, Vec3(0, 1.0, 0))};
  EXPECT_EQ(after(engine_, scene).tally().impacts, 1);  // it lands and stays
}

TEST_P(DoubleEngine, ImmovableBall_StandsOrMovesSteadily_AndIsAccountedFor) {
  for (const double speed_mps : {0.0, -2.0}) {
    Scenario scene = scene_of(dimension_, 0.01, 60);
    scene.effects.gravity = Vec3(0, -1e-3, 0);
    scene.balls = {ball(2.0, 0.5, Vec3(-1.0, 0, 0), Vec3(1.0, 0, 0)),
                   ball(kInfinity, 0.5, Vec3(0.505, 0, 0), Vec3(speed_mps, 0, 0))};
    const Unexplained rest = unexplained(engine_, scene);
    const Probe run = after(engine_, scene);
    EXPECT_EQ(run[1].velocity, Vec3(speed_mps, 0, 0));
    EXPECT_NEAR(run[1].position.x(), 0.505 + 0.6 * speed_mps, 60.0 * rounding());
    EXPECT_NEAR(run[0].velocity.x(), 2.0 * speed_mps - 1.0, 1e-5);  // the pair meets 1e-4 m off its axis
    EXPECT_LE(rest.momentum_Ns, 60.0 * 4.0 * rounding());
  }
}

TEST_P(DoubleEngine, LinearDrag_IsExponential_AtAnyStep) {
  for (const double step_s : {0.001, 0.1}) {
    Scenario scene = scene_of(dimension_, step_s, std::lround(1.0 / step_s));
    scene.effects.drag = Drag{Drag::Kind::linear, 0.6};
    scene.balls = {ball(2.0, 0.5, Vec3::Zero(), Vec3(3.0, 0, 0))};
    // Each step rounds the velocity twice.
    const double tolerance = 2.0 * epsilon(engine_) * static_cast<double>(scene.frames);
    EXPECT_NEAR(after(engine_, scene)[0].velocity.x() / 3.0, std::exp(-0.3), tolerance);
  }
}

TEST_P(DoubleEngine, QuadraticDragAndMagnus_MatchClosedForms) {
  Scenario scene = scene_of(dimension_, 0.01, 100);
  scene.effects.drag = Drag{Drag::Kind::quadratic, 0.6};
  scene.balls = {ball(2.0, 0.5, Vec3::Zero(), Vec3(3.0, 0, 0))};
  const double tolerance = 3.0 * 100.0 * 4.0 * epsilon(engine_);  // four roundings a step
  EXPECT_NEAR(after(engine_, scene)[0].velocity.x(), 3.0 / (1.0 + 0.3 * 3.0), tolerance);

  scene.effects.drag.reset();
  scene.effects.spin = true;
  scene.effects.magnus = 0.5;
  scene.balls[0].spin = Vec3(0, 0, 4.0);  // turns the velocity at sω/m = 1 rad/s
  EXPECT_LE((after(engine_, scene)[0].velocity - 3.0 * Vec3(std::cos(1.0), std::sin(1.0), 0)).norm(),
            tolerance);
}

TEST_P(DoubleEngine, Balls_PassThroughEachOther_WithoutCollisions) {
  Scenario scene = scene_of(dimension_, 0.01, 300);
  scene.effects.collisions = false;
  add_box(scene, 4.0);
  const double z = dimension_ == 2 ? 0.0 : 2.0;
  scene.balls = {ball(1.0, 0.5, Vec3(1, 2, z), Vec3(1, 0, 0)), ball(1.0, 0.5, Vec3(3, 2, z), Vec3(-1, 0, 0))};
  const Probe run = after(engine_, scene);
  EXPECT_EQ(run.tally().impacts, 2);  // each met the opposite wall
  EXPECT_TRUE(run.tally().walls_known);
  EXPECT_EQ(run.tally().wall_impacts, 2);
  EXPECT_NEAR(run.tally().wall_push_Ns, 4.0, 4.0 * rounding());
  EXPECT_NEAR(run[0].velocity.x(), -1.0, rounding());
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

TEST_P(DoubleEngine, Switches_MakeOneProfileTheOther_AllTogether) {
  EXPECT_THAT(all_switched_is_not_the_other(engine_), testing::IsEmpty());
}

TEST_P(DoubleEngine, Switch_MovesItsOwnSettingOnly) {
  EXPECT_THAT(one_switched_moves_others(engine_), testing::IsEmpty());
}

TEST_P(DoubleEngine, UnknownSwitch_IsRefused) {
  const Scenario scene = scene_for_switches();
  EXPECT_THROW(engine_.create_switched(scene, "default", std::vector<std::string>{"warmth"}),
               std::logic_error);
}

// Each impulse is rounded in each of the iterations that move it, in each step: 480 of them, all in one
// direction.
TEST_P(DoubleEngine, EnergyAccount_ExplainsEveryJoule_InRoughLossyGas) {
  EXPECT_LE(unexplained_energy_of_gas(engine_, "faithful", dimension_), 480.0 * epsilon(engine_));
}

TEST_P(DoubleEngine, EnergyAccount_BooksAWallImpactAtTheWall) {
  EXPECT_LE(wall_impact_error(engine_, dimension_), 16.0 * epsilon(engine_));
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
