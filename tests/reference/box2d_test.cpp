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

const Engine& box2d() {
  static const Engine& module = engine("box2d");
  return module;
}

// A velocity passes through a handful of roundings (itself, the impulse, two updates a side): 8 ε < 1e-6.
double rounding() {
  return 8.0 * epsilon(box2d());
}

TEST(Box2d, Info_NamesProfiles_FaithfulFirst) {
  const EngineInfo info = box2d().info();
  EXPECT_EQ(info.name, "box2d");
  EXPECT_EQ(info.precision, "float32");
  ASSERT_EQ(info.profiles.size(), 2U);
  EXPECT_EQ(info.profiles[0].name, "faithful");
  EXPECT_EQ(info.profiles[1].name, "default");
}

TEST(Box2d, HeadOnVelocity_MatchesExact_From01To100Mps) {
  EXPECT_LE(head_on_sweep_error(box2d(), 2), rounding());
}

// The world is rescaled by powers of two: radii near 0.5 inside, whatever they are outside.
TEST(Box2d, HeadOnVelocity_MatchesExact_AnyRadius) {
  for (const double radius : {1e-5, 1e-3, 0.05, 30.0}) {
    EXPECT_LE(head_on_error(box2d(), 2, 1.0, 1.0, 100.0, radius), rounding()) << radius;
  }
}

TEST(Box2d, WallBounce_MatchesExact_AnyRestitutionAndDirection) {
  for (const double restitution : {1.0, 0.5, 0.0}) {
    for (const double angle : {0.0, 0.4, 1.2, 2.0, 3.5, 5.9}) {
      const Vec3 normal(std::cos(angle), std::sin(angle), 0.0);
      EXPECT_LE(wall_error(box2d(), 2, normal, restitution), rounding()) << restitution << " at " << angle;
    }
  }
}

TEST(Box2d, PairCoefficients_AreTheScenes_InBothProfiles) {
  const Contact low = {0.5, 0.1, 0.0};
  const Contact high = {1.0, 0.3, 0.0};
  // The normal part is exact to rounding; the friction limit uses it before the last iteration changed it.
  const double tolerance = 100.0 * epsilon(box2d());
  for (const char* profile : {"faithful", "default"}) {
    for (const auto& [balls, walls] : {std::pair{low, high}, {high, low}}) {
      const Measured ball = ball_on_ball(box2d(), profile, 2, balls, walls);
      EXPECT_NEAR(ball.restitution, balls.restitution, tolerance) << profile;
      EXPECT_NEAR(ball.friction, balls.friction, tolerance) << profile;
      const Measured wall = ball_on_wall(box2d(), profile, 2, balls, walls);
      EXPECT_NEAR(wall.restitution, walls.restitution, tolerance) << profile;
      EXPECT_NEAR(wall.friction, walls.friction, tolerance) << profile;
    }
  }
}

// The lever arm ends in the middle of the overlap, so spin is short by up to v h/(2 r) of itself.
TEST(Box2d, SpinAfterSliding_ConvergesWithStep) {
  const auto error = [](double step_s) {
    Scenario scene = scene_of(2, step_s, std::lround(0.3 / step_s));
    scene.effects.spin = true;
    scene.wall_contact = {0.9, 0.3, 0.0};
    scene.walls = {{Vec3::UnitY(), 0.0}};
    scene.balls = {ball(1.0, 0.5, Vec3(0, 0.6 + 0.1 * step_s, 0), Vec3(5.0, -1.0, 0))};
    const Probe run = after(box2d(), scene);
    const double exact = -2.5 * 0.3 * (1.0 + 0.9) / 0.5;  // -(5/2) μ (1 + e) v_n / r
    return std::abs(run[0].spin.z() / exact - 1.0);
  };
  for (const double step_s : {1e-2, 1e-3, 1e-4}) EXPECT_LE(error(step_s), step_s * 1.0 / (2.0 * 0.5) + 1e-5);
}

TEST(Box2d, Ball_DoesNotRotate_WithoutSpin) {
  Scenario scene = gas(2, 8, 1.0 / 240.0, 240);
  scene.wall_contact.friction = scene.ball_contact.friction = 0.0;
  for (const char* profile : {"faithful", "default"}) {
    const Probe run = after(box2d(), scene, profile);
    for (std::size_t i = 0; i < scene.balls.size(); ++i) EXPECT_EQ(run[i].spin, Vec3::Zero());
  }
}

TEST(Box2d, Account_ExplainsMomentum_InWalledGas) {
  const Scenario scene = gas(2, 32, 1.0 / 240.0, 1000);
  const Unexplained rest = unexplained(box2d(), scene);
  EXPECT_GT(rest.tally.impacts, 1000);
  EXPECT_GT(rest.tally.external_impulse.norm(), 1.0);
  EXPECT_LE(rest.momentum_Ns, momentum_rounding(box2d(), scene, rest.tally));
  EXPECT_LE(rest.angular_momentum_Nms, angular_momentum_rounding(box2d(), scene));
  // Each impact rounds the energies of two balls of a thousand, 2 ε each.
  const double per_ball = static_cast<double>(rest.tally.impacts) / static_cast<double>(scene.balls.size());
  EXPECT_LE(rest.energy_change, 4.0 * epsilon(box2d()) * per_ball);
}

TEST(Box2d, Account_ExplainsMomentum_WithGravityAndFriction) {
  Scenario scene = gas(2, 16, 1.0 / 240.0, 500);
  scene.effects.gravity = Vec3(0.3, -0.5, 0);
  scene.effects.spin = true;
  scene.ball_contact = scene.wall_contact = {0.9, 0.3, 0.0};
  const Unexplained rest = unexplained(box2d(), scene);
  EXPECT_LE(rest.momentum_Ns, momentum_rounding(box2d(), scene, rest.tally));
}

TEST(Box2d, Account_ExplainsMomentum_UnderContinuousCollision) {
  const Scenario scene = gas(2, 16, 1.0 / 8.0, 200);  // v·h = 0.7 r at the mean speed
  const Unexplained rest = unexplained(box2d(), scene);
  EXPECT_LE(rest.momentum_Ns, momentum_rounding(box2d(), scene, rest.tally));
}

TEST(Box2d, Bounces_AreCountedOnce_WhileBallsOverlap) {
  Scenario scene = scene_of(2, 0.004, 2000);
  scene.effects.gravity = Vec3(0, -9.81, 0);
  scene.wall_contact.restitution = 0.0;
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.balls = {ball(1.0, 0.5, Vec3(0, 1.0, 0))};
  EXPECT_EQ(after(box2d(), scene).tally().impacts, 1);  // it lands and stays
}

TEST(Box2d, FastBall_HitsBallAndWall_AtStepsLongerThanItsRadius) {
  for (const double radii_per_step : {0.7, 1.0, 3.3, 8.0}) {
    Scenario scene = scene_of(2, radii_per_step * 0.5 / 10.0, 6);
    scene.balls = {ball(1.0, 0.5, Vec3(-0.5, 0, 0), Vec3(10.0, 0, 0)), ball(1.0, 0.5, Vec3(0.8, 0, 0))};
    const Probe run = after(box2d(), scene);
    EXPECT_NEAR(run[1].velocity.x(), 10.0, 10.0 * rounding()) << radii_per_step;
    EXPECT_EQ(run.tally().impacts, 1);
  }
}

TEST(Box2d, ImmovableBall_StandsOrMovesSteadily_AndIsAccountedFor) {
  for (const double speed_mps : {0.0, -2.0}) {
    Scenario scene = scene_of(2, 0.01, 60);
    scene.effects.gravity = Vec3(0, -1e-3, 0);
    scene.balls = {ball(2.0, 0.5, Vec3(-1.0, 0, 0), Vec3(1.0, 0, 0)),
                   ball(kInfinity, 0.5, Vec3(0.505, 0, 0), Vec3(speed_mps, 0, 0))};
    const Unexplained rest = unexplained(box2d(), scene);
    const Probe run = after(box2d(), scene);
    EXPECT_NEAR(run[1].velocity.x(), speed_mps, rounding());
    EXPECT_EQ(run[1].velocity.y(), 0.0);
    EXPECT_NEAR(run[0].velocity.x(), 2.0 * speed_mps - 1.0, 1e-5);  // the pair meets 1e-4 m off its axis
    EXPECT_LE(rest.momentum_Ns, 60.0 * 4.0 * rounding());
  }
}

TEST(Box2d, LinearDrag_IsExponential_AtAnyStep) {
  for (const double step_s : {0.001, 0.1}) {
    Scenario scene = scene_of(2, step_s, std::lround(1.0 / step_s));
    scene.effects.drag = Drag{Drag::Kind::linear, 0.6};
    scene.balls = {ball(2.0, 0.5, Vec3::Zero(), Vec3(3.0, 0, 0))};
    const Probe run = after(box2d(), scene);
    // Each step rounds the velocity once and uses a damping that was rounded once.
    const double tolerance = 2.0 * epsilon(box2d()) * static_cast<double>(scene.frames);
    EXPECT_NEAR(run[0].velocity.x() / 3.0, std::exp(-0.3), tolerance);
  }
}

TEST(Box2d, QuadraticDragAndMagnus_MatchClosedForms) {
  Scenario scene = scene_of(2, 0.01, 100);
  scene.effects.drag = Drag{Drag::Kind::quadratic, 0.6};
  scene.balls = {ball(2.0, 0.5, Vec3::Zero(), Vec3(3.0, 0, 0))};
  const double tolerance = 100.0 * 4.0 * epsilon(box2d());  // four roundings a step
  EXPECT_NEAR(after(box2d(), scene)[0].velocity.x(), 3.0 / (1.0 + 0.3 * 3.0), 3.0 * tolerance);

  scene.effects.drag.reset();
  scene.effects.spin = true;
  scene.effects.magnus = 0.5;
  scene.balls[0].spin = Vec3(0, 0, 4.0);  // turns the velocity at sω/m = 1 rad/s
  const Vec3 velocity = after(box2d(), scene)[0].velocity;
  EXPECT_NEAR(velocity.x(), 3.0 * std::cos(1.0), 3.0 * tolerance);
  EXPECT_NEAR(velocity.y(), 3.0 * std::sin(1.0), 3.0 * tolerance);
}

TEST(Box2d, Balls_PassThroughEachOther_WithoutCollisions) {
  Scenario scene = scene_of(2, 0.01, 300);
  scene.effects.collisions = false;
  add_box(scene, 4.0);
  scene.balls = {ball(1.0, 0.5, Vec3(1, 2, 0), Vec3(1, 0, 0)), ball(1.0, 0.5, Vec3(3, 2, 0), Vec3(-1, 0, 0))};
  const Probe run = after(box2d(), scene);
  EXPECT_EQ(run.tally().impacts, 2);  // each met the opposite wall
  EXPECT_TRUE(run.tally().walls_known);
  EXPECT_EQ(run.tally().wall_impacts, 2);
  EXPECT_NEAR(run.tally().wall_push_Ns, 4.0, 4.0 * rounding());
  EXPECT_NEAR(run[0].velocity.x(), -1.0, rounding());
}

TEST(Box2d, Refuses_BallFasterThanItsClamp) {
  Scenario scene = scene_of(2, 0.1, 1);
  scene.balls = {ball(1.0, 0.5, Vec3::Zero(), Vec3(1.0, 0, 0))};
  EXPECT_EQ(box2d().refuses(scene, "faithful"), "");
  scene.balls[0].velocity.x() = 1000.0;  // 200 radii a step
  EXPECT_NE(box2d().refuses(scene, "faithful"), "");
}

TEST(Box2d, DefaultProfile_LosesSlowBounces) {
  Scenario scene = scene_of(2, 0.01, 100);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.balls = {ball(1.0, 0.5, Vec3(0, 0.8, 0), Vec3(0, -0.9, 0))};  // below its threshold of 1 m/s
  EXPECT_NEAR(after(box2d(), scene, "default")[0].velocity.y(), 0.0, 1e-6);
  EXPECT_NEAR(after(box2d(), scene, "faithful")[0].velocity.y(), 0.9, rounding());
  EXPECT_EQ(std::get<double>(after(box2d(), scene, "default").settings().at("velocity_threshold_mps")), 1.0);
}

TEST(Box2d, Switches_MakeOneProfileTheOther_AllTogether) {
  EXPECT_THAT(all_switched_is_not_the_other(box2d()), testing::IsEmpty());
}

TEST(Box2d, Switch_MovesItsOwnSettingOnly) {
  EXPECT_THAT(one_switched_moves_others(box2d()), testing::IsEmpty());
}

TEST(Box2d, UnknownSwitch_IsRefused) {
  const Scenario scene = scene_for_switches();
  EXPECT_THROW(box2d().create_switched(scene, "default", std::vector<std::string>{"warmth"}),
               std::logic_error);
}

// Each impulse is rounded in each of the iterations that move it, in each step: 480 of them, all in one
// direction.
TEST(Box2d, EnergyAccount_ExplainsEveryJoule_InRoughLossyGas) {
  EXPECT_LE(unexplained_energy_of_gas(box2d(), "faithful", 2), 480.0 * epsilon(box2d()));
}

TEST(Box2d, EnergyAccount_BooksAWallImpactAtTheWall) {
  EXPECT_LE(wall_impact_error(box2d(), 2), 16.0 * epsilon(box2d()));
}

// By default the position iterations lift a ball that starts 0.05 m deep out of the floor, all but the slop
// of 0.005 m and with the skin of 0.01 m, against gravity and without a velocity.
TEST(Box2d, PositionIterations_GiveEnergyUnderGravity) {
  constexpr double kDepth_m = 0.05;
  constexpr double kSkin_m = 0.01;
  constexpr double kSlop_m = 0.005;
  Scenario scene = scene_of(2, 0.01, 50);
  scene.effects.gravity = Vec3(0, -10.0, 0);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.wall_contact.restitution = 0.0;
  scene.balls = {ball(1.0, 0.5, Vec3(0, 0.5 - kDepth_m, 0))};
  const double lift_m = kDepth_m + kSkin_m - kSlop_m;
  EXPECT_NEAR(after(box2d(), scene, "default").tally().energy.correction_J, 10.0 * lift_m, 10.0 * kSlop_m);
  // Places are rounded in every step.
  EXPECT_LE(std::abs(after(box2d(), scene, "faithful").tally().energy.correction_J),
            50.0 * epsilon(box2d()) * 10.0 * 0.5);
}

}  // namespace
}  // namespace carom::test
