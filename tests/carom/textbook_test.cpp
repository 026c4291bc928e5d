#include "carom/textbook/textbook.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "carom/textbook/program.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

using testing::HasSubstr;
using textbook::Program;
using textbook::ProgramBall;

constexpr float kFloat = std::numeric_limits<float>::epsilon();

Ball ball(double mass, double radius, const Vec3& position, const Vec3& velocity) {
  Ball made;
  made.mass = mass;
  made.radius = radius;
  made.position = position;
  made.velocity = velocity;
  return made;
}

/// The program after one update that lasts a second, so that m/s are metres per update.
Program updated(int dimension, std::vector<Ball> balls) {
  Program program(free_scene(dimension, std::move(balls), 1.0, 1.0));
  program.update();
  return program;
}

/// Velocities from the law in double precision, at places in which the program has moved the balls: it rounds
/// n, s, p and both products, each by ε of the speeds, and squares in n double that.
TEST(TextbookImpulse, IsTheElasticLaw_ToSinglePrecision_AnyPair) {
  Random random(5);
  int hit = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Vec3 direction = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    const Ball a = ball(random.uniform(0.1, 10.0), random.uniform(0.2, 1.0), Vec3::Zero(),
                        {random.normal(), random.normal(), random.normal()});
    Ball b = ball(random.uniform(0.1, 10.0), random.uniform(0.2, 1.0), Vec3::Zero(),
                  {random.normal(), random.normal(), random.normal()});
    b.position = 0.9 * (a.radius + b.radius) * direction - b.velocity + a.velocity;
    const Vec3& n = direction;
    const double v_n = n.dot(b.velocity - a.velocity);
    const std::vector<ProgramBall> after = updated(3, {a, b}).balls();
    const double j = v_n < 0.0 ? -2.0 * v_n / (1.0 / a.mass + 1.0 / b.mass) : 0.0;
    hit += v_n < 0.0 ? 1 : 0;
    // Places are rounded at speeds and radii of a few metres, and d is at least 0.36 m.
    const double tolerance = 64.0 * kFloat * (a.velocity.norm() + b.velocity.norm() + 1.0);
    EXPECT_LE((after[0].v.cast<double>() - (a.velocity - j / a.mass * n)).norm(), tolerance) << trial;
    EXPECT_LE((after[1].v.cast<double>() - (b.velocity + j / b.mass * n)).norm(), tolerance) << trial;
  }
  EXPECT_GT(hit, 300);
}

/// With R = r₁ + r₂ the first ball is moved by the overlap, the second by R/d of it: the gap is that, too.
TEST(TextbookOverlap, MovesTheSecondFurther_AndLeavesAGap) {
  for (const double d : {0.1, 0.5, 0.9}) {
    const Program program = updated(
        2, {ball(1.0, 0.4, {0.0, 0.0, 0.0}, Vec3::Zero()), ball(1e3, 0.6, {d, 0.0, 0.0}, Vec3::Zero())});
    const double overlap = 1.0 - d;
    const double first = -static_cast<double>(program.balls()[0].x.x());
    const double second = static_cast<double>(program.balls()[1].x.x()) - d;
    EXPECT_NEAR(first, overlap, 8.0 * kFloat) << d;
    EXPECT_NEAR(second, overlap / d, 8.0 * kFloat / d) << d;
  }
}

TEST(TextbookOverlap, OfTwoBallsWithOneCentre_IsNotANumber) {
  const Vec3 place(0.25, 0.5, 0.0);
  const Program program =
      updated(2, {ball(1.0, 0.1, place, {1.0, 0.0, 0.0}), ball(1.0, 0.1, place, {1.0, 0.0, 0.0}),
                  ball(1.0, 0.1, {1.25, 0.5, 0.0}, {0.25, 0.0, 0.0})});
  EXPECT_FALSE(program.balls()[0].x.allFinite());
  EXPECT_FALSE(program.balls()[1].x.allFinite());
  // No comparison with NaN holds: the third ball does not see them.
  EXPECT_EQ(program.balls()[2].x, textbook::Vec3f(1.5F, 0.5F, 0.0F));
}

/// 0.1 v/r an update, whatever the update's length: v is per update, too.
TEST(TextbookSpin, IsATenthOfRolling_AtAnyFrameRate) {
  for (const int rate : {16, 64, 256}) {
    const Scenario scene = free_scene(2, {ball(1.0, 0.5, Vec3::Zero(), {2.0, 1.0, 0.0})}, 1.0, 1.0);
    Program program(scene);
    program.set_update(1.0 / rate);
    for (int k = 0; k < rate; ++k) program.update();
    // A sum of `rate` terms, each rounded to ε of it.
    EXPECT_NEAR(program.balls()[0].angle_x, 0.4, 0.4 * rate * kFloat);
    EXPECT_NEAR(program.balls()[0].angle_y, 0.2, 0.4 * rate * kFloat);
  }
}

TEST(TextbookEngine, SaysWhatItCannot) {
  const auto engine = make_textbook_engine();
  const Ball at_rest = ball(1.0, 0.1, Vec3::Zero(), Vec3::Zero());
  Scenario scene = free_scene(2, {at_rest, at_rest}, 1.0, 1.0);
  scene.balls[1].position.x() = 1.0;
  EXPECT_EQ(unsupported_reason(*engine, scene, "faithful"), "");
  scene.ball_contact.restitution = 0.9;
  EXPECT_THAT(unsupported_reason(*engine, scene, "faithful"), HasSubstr("restitution 1, not 0.9"));
  scene.effects.collisions = false;
  EXPECT_EQ(unsupported_reason(*engine, scene, "faithful"), "");
  scene.wall_contact.restitution = 0.8;
  scene.walls.push_back({Vec3::UnitY(), -1.0});
  EXPECT_THAT(unsupported_reason(*engine, scene, "faithful"), HasSubstr("not 0.8"));
  scene.balls[0].mass = std::numeric_limits<double>::infinity();
  EXPECT_THAT(unsupported_reason(*engine, scene, "faithful"), HasSubstr("not a number"));
}

/// In the profile "default" an update lasts as long as all steps of a frame.
TEST(TextbookEngine, DefaultProfile_UpdatesOnceAFrame) {
  const auto engine = make_textbook_engine();
  const Scenario scene = free_scene(2, {ball(1.0, 0.1, Vec3::Zero(), {3.0, 0.0, 0.0})}, 1.0, 0.125);
  const auto impacts_seen = [&](std::string_view profile, std::vector<std::string> switched) {
    const auto simulation = engine->create_switched(scene, profile, switched);
    simulation->advance(0.125, 4);
    EXPECT_EQ(states_of(*simulation, 1)[0].position.x(), 1.5);
    EXPECT_EQ(states_of(*simulation, 1)[0].velocity.x(), 3.0);
    return std::get<double>(simulation->settings().at("update_s"));
  };
  EXPECT_EQ(impacts_seen("faithful", {}), 0.125);
  EXPECT_EQ(impacts_seen("default", {}), 0.5);
  EXPECT_EQ(impacts_seen("default", {"one_update_per"}), 0.125);
}

/// Walls turn the sign of a velocity; their pushes and its energy are in the accounts.
TEST(TextbookEngine, Accounts_AddUp_AmongWallsUnderGravity) {
  Scenario scene = *gas(2, 40, 0.3, 20.0, 7, "[effects]\ngravity = [0, -0.5]\n");
  scene.duration_s = 8.0;
  const auto simulation = make_textbook_engine()->create(scene, "faithful");
  const std::vector<BallState> before = states_of(scene);
  const std::vector<BallState> after = run(*simulation, scene, 2000);
  const Tally tally = simulation->tally();
  ASSERT_GT(tally.impacts, 50);
  ASSERT_GT(tally.wall_impacts, 20);
  const Vec3 gained = momentum_of(scene, after) - momentum_of(scene, before);
  const Vec3 fallen(0.0, -0.5 * scene.duration_s * static_cast<double>(scene.balls.size()), 0.0);
  // 2000 updates and a few hundred impacts, each rounding 40 balls' momenta of about 1 kg m/s to single
  // precision.
  EXPECT_LE((gained - fallen - tally.external_impulse).norm(), 40 * 2000 * kFloat);
  EXPECT_LE(std::abs(tally.energy.wall_impacts_J), static_cast<double>(tally.wall_impacts) * 8.0 * kFloat);
  EXPECT_NE(tally.energy.correction_J, 0.0);
}

}  // namespace
}  // namespace carom::test
