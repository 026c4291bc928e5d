#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/reference/support.h"
#include "tests/reference/switches.h"
#include "tests/support/numbers.h"

namespace carom::test {
namespace {

using namespace reference_test;

/// One precision of Bullet in one dimension. Both modules are open in this process throughout.
struct Case {
  const char* name;
  int dimension;
};

class Bullet : public testing::TestWithParam<Case> {
 protected:
  const Engine& bullet_ = engine(GetParam().name);
  const int dimension_ = GetParam().dimension;

  // A velocity passes through a handful of roundings (itself, the impulse, two updates a side): 8 ε.
  double rounding() const { return 8.0 * epsilon(bullet_); }
};

INSTANTIATE_TEST_SUITE_P(Precisions, Bullet,
                         testing::Values(Case{"bullet", 2}, Case{"bullet", 3}, Case{"bullet-f64", 2},
                                         Case{"bullet-f64", 3}),
                         [](const testing::TestParamInfo<Case>& info) {
                           const bool single = std::string_view(info.param.name) == "bullet";
                           return (single ? "Single" : "Double") + std::to_string(info.param.dimension) + "D";
                         });

TEST_P(Bullet, Info_NamesPrecisionAndProfiles) {
  const EngineInfo info = bullet_.info();
  EXPECT_EQ(info.name, GetParam().name);
  EXPECT_EQ(info.precision, info.name == "bullet" ? "float32" : "float64");
  ASSERT_EQ(info.profiles.size(), 2U);
  EXPECT_EQ(info.profiles[0].name, "faithful");
  EXPECT_EQ(info.profiles[1].name, "default");
}

// By default Bullet also pushes shallow overlaps apart through the velocity, by erp2 = 0.2 of them in a step.
TEST_P(Bullet, PairCoefficients_AreTheScenes_InBothProfiles) {
  const Contact low = {0.5, 0.1, 0.0};
  const Contact high = {1.0, 0.3, 0.0};
  // Rounding of the surface speeds, up to 50 m/s, shows in coefficients taken from 10 m/s and less.
  const double tolerance = 10.0 * rounding();
  constexpr double kPush = 0.2 * kHitOverlap_m / (kHitStep_s * kHitSpeed_mps);
  for (const auto& [profile, push] : {std::pair{"faithful", 0.0}, {"default", kPush}}) {
    for (const auto& [balls, walls] : {std::pair{low, high}, {high, low}}) {
      const Measured ball = ball_on_ball(bullet_, profile, dimension_, balls, walls);
      EXPECT_NEAR(ball.restitution, balls.restitution + push, tolerance) << profile;
      EXPECT_NEAR(ball.friction, balls.friction, tolerance) << profile;
      const Measured wall = ball_on_wall(bullet_, profile, dimension_, balls, walls);
      EXPECT_NEAR(wall.restitution, walls.restitution + push, tolerance) << profile;
      EXPECT_NEAR(wall.friction, walls.friction, tolerance) << profile;
    }
  }
}

// Elastic: Bullet reflects the velocity from before gravity was added, which retraces its own path.
TEST_P(Bullet, DroppedBall_KeepsItsApex_Over100Bounces) {
  constexpr double kHeight_m = 10.0;
  Scenario scene = scene_of(dimension_, 1e-3, 300000);
  scene.effects.gravity = Vec3(0, -9.81, 0);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.balls = {ball(1.0, 0.5, Vec3(0, 0.5 + kHeight_m, 0))};
  Probe run(bullet_, scene);
  double apex_m = 0.0;
  while (run.tally().impacts <= 100) {
    if (run.tally().impacts == 100) apex_m = std::max(apex_m, run[0].position.y() - 0.5);
    run.advance(1);
  }
  // The exact apex lies up to half a step's fall, g h²/8, above the highest sample: 1e-6 m. Single precision
  // rounds the position at 10 m by up to 5e-7 m in each of 286,000 steps; as a random walk 2.5e-4 m at most.
  EXPECT_NEAR(apex_m / kHeight_m, 1.0, 1e-4);
}

TEST_P(Bullet, PlaneScene_StaysInItsPlane) {
  if (dimension_ == 3) return;
  Scenario scene = gas(2, 8, 1.0 / 240.0, 480);
  scene.effects.spin = true;
  scene.ball_contact = scene.wall_contact = {0.9, 0.3, 0.0};
  for (const char* profile : {"faithful", "default"}) {
    const Probe run = after(bullet_, scene, profile);
    for (std::size_t i = 0; i < scene.balls.size(); ++i) {
      EXPECT_EQ(run[i].position.z(), 0.0);
      EXPECT_EQ(run[i].velocity.z(), 0.0);
      EXPECT_EQ(run[i].spin.head<2>(), Eigen::Vector2d::Zero());
    }
  }
}

TEST_P(Bullet, FastBall_HitsBall_AtStepsLongerThanItsRadius) {
  for (const double radii_per_step : {0.7, 1.0, 3.3, 8.0}) {
    Scenario scene = scene_of(dimension_, radii_per_step * 0.5 / 10.0, 6);
    scene.balls = {ball(1.0, 0.5, Vec3(-0.5, 0, 0), Vec3(10.0, 0, 0)), ball(1.0, 0.5, Vec3(0.8, 0, 0))};
    const Probe run = after(bullet_, scene);
    EXPECT_NEAR(run[1].velocity.x(), 10.0, 10.0 * rounding()) << radii_per_step;
    EXPECT_EQ(run.tally().impacts, 1);
  }
}

TEST_P(Bullet, DefaultProfile_LosesSlowBounces) {
  Scenario scene = scene_of(dimension_, 0.01, 200);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.balls = {ball(1.0, 0.5, Vec3(0, 0.6, 0), Vec3(0, -0.15, 0))};  // below its threshold of 0.2 m/s
  EXPECT_LT(after(bullet_, scene, "default")[0].velocity.y(), 0.01);
  EXPECT_NEAR(after(bullet_, scene)[0].velocity.y(), 0.15, rounding());
}

TEST_P(Bullet, Refuses_WhatItsSettingsCannotExpress) {
  Scenario scene = scene_of(dimension_, 0.01, 1);
  scene.effects.spin = true;
  scene.balls = {ball(1.0, 0.5, Vec3::Zero())};
  EXPECT_EQ(bullet_.refuses(scene, "faithful"), "");
  scene.balls[0].spin = Vec3(0, 0, 200.0);  // 2 rad a step
  EXPECT_NE(bullet_.refuses(scene, "faithful"), "");
  scene.balls[0].spin = Vec3::Zero();
  scene.effects.drag = Drag{Drag::Kind::linear, 40.0};  // e^-40 is beyond either precision
  EXPECT_NE(bullet_.refuses(scene, "faithful"), "");
}

// Two worlds side by side in each of two modules that share their libraries' symbol names.
TEST(BulletModules, SingleAndDouble_RunSideBySide_InOneProcess) {
  const Scenario scene = gas(3, 4, 1.0 / 240.0, 240);
  Scenario lossy = scene;
  lossy.ball_contact.restitution = 0.5;
  Probe single(engine("bullet"), scene);
  Probe twice(engine("bullet-f64"), scene);
  Probe other(engine("bullet-f64"), lossy);
  const double energy = twice.kinetic_energy();
  for (std::int64_t k = 0; k < scene.frames; ++k) {
    single.advance(1);
    twice.advance(1);
    other.advance(1);
  }
  EXPECT_NEAR(single.kinetic_energy() / energy, 1.0, 1e-6);
  EXPECT_NEAR(twice.kinetic_energy() / energy, 1.0, 1e-14);
  EXPECT_LT(other.kinetic_energy() / energy, 0.99);
}

// What really changes the energy of a dropped ball in the default profile, one cause at a time. Bullet's
// target for the velocity after an impact at the speed v is e v, less d/h for a surface that is still d away
// (so that the ball just reaches it in the step h), plus erp2 δ/h for one that overlaps by δ.
TEST_P(Bullet, DefaultContactAtADistance_TakesDistanceOverStepFromTheBounce) {
  constexpr double kSpeed_mps = 2.0;
  constexpr double kDistance_m = 1e-3;
  Scenario scene = scene_of(dimension_, 1e-3, 1);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.balls = {ball(1.0, 0.1, Vec3(0, 0.1 + kDistance_m, 0), Vec3(0, -kSpeed_mps, 0))};
  // The place is off by a rounding, which 1/h makes a thousand times larger.
  const double tolerance = 8.0 * epsilon(bullet_) * (kSpeed_mps + 0.1 / scene.step_s);
  EXPECT_NEAR(after(bullet_, scene, "default")[0].velocity.y(), kSpeed_mps - kDistance_m / scene.step_s,
              tolerance);
  const auto cured =
      bullet_.create_switched(scene, "default", std::vector<std::string>{"contact_processing_threshold_m"});
  // Nothing has touched yet.
  EXPECT_EQ(states_after(*cured, scene)[0].velocity.y(), -kSpeed_mps);
}

TEST_P(Bullet, DefaultContacts_BeginNearAWall_ButNotNearABall) {
  const double reach_m = 0.02 * std::sqrt(3.0) * 0.1;
  for (const double share : {0.99, 1.01}) {
    Scenario scene = scene_of(dimension_, 1e-3, 1);
    scene.balls = {ball(1.0, 0.1, Vec3(0, 0.1 + share * reach_m, 0), Vec3(0, -2.0, 0))};
    scene.walls = {{Vec3::UnitY(), 0.0}};
    const double at_wall = after(bullet_, scene, "default")[0].velocity.y();
    EXPECT_EQ(at_wall == -2.0, share > 1.0) << at_wall;
    scene.walls.clear();
    scene.balls.push_back(ball(1.0, 0.1, Vec3(0, -0.1, 0)));
    EXPECT_EQ(after(bullet_, scene, "default")[0].velocity.y(), -2.0);
  }
}

TEST_P(Bullet, DefaultErp_AddsAFifthOfTheOverlapOverTheStepToTheBounce) {
  constexpr double kSpeed_mps = 2.0;
  constexpr double kOverlap_m = 1e-3;
  Scenario scene = scene_of(dimension_, 1e-3, 1);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.balls = {ball(1.0, 0.1, Vec3(0, 0.1 - kOverlap_m, 0), Vec3(0, -kSpeed_mps, 0))};
  const double tolerance = 8.0 * epsilon(bullet_) * (kSpeed_mps + 0.1 / scene.step_s);
  EXPECT_NEAR(after(bullet_, scene, "default")[0].velocity.y(), kSpeed_mps + 0.2 * kOverlap_m / scene.step_s,
              tolerance);
  const auto cured = bullet_.create_switched(scene, "default", std::vector<std::string>{"erp2"});
  EXPECT_NEAR(states_after(*cured, scene)[0].velocity.y(), kSpeed_mps, tolerance);
}

}  // namespace
}  // namespace carom::test
