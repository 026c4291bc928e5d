#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/reference/energy.h"
#include "tests/reference/support.h"
#include "tests/reference/switches.h"

namespace carom {
namespace {

using namespace reference_test;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What Bullet, Chipmunk and ODE have in common, in whatever precision: an engine in one dimension. All
/// modules are open in this process throughout.
struct SteppedCase {
  const char* name;
  int dimension;
};

class SteppedEngines : public testing::TestWithParam<SteppedCase> {
 protected:
  const Engine& engine_ = engine(GetParam().name);
  const int dimension_ = GetParam().dimension;

  // A velocity passes through a handful of roundings (itself, the impulse, two updates a side): 8 ε.
  double rounding() const { return 8.0 * epsilon(engine_); }
};

INSTANTIATE_TEST_SUITE_P(Engines, SteppedEngines,
                         testing::Values(SteppedCase{"bullet", 2}, SteppedCase{"bullet", 3},
                                         SteppedCase{"bullet-f64", 2}, SteppedCase{"bullet-f64", 3},
                                         SteppedCase{"chipmunk", 2}, SteppedCase{"ode", 2},
                                         SteppedCase{"ode", 3}),
                         [](const testing::TestParamInfo<SteppedCase>& info) {
                           std::string name = info.param.name;
                           std::erase(name, '-');
                           return name + "_" + std::to_string(info.param.dimension) + "D";
                         });

TEST_P(SteppedEngines, HeadOnVelocity_MatchesExact_From01To100Mps) {
  EXPECT_LE(head_on_sweep_error(engine_, dimension_), rounding());
}

TEST_P(SteppedEngines, HeadOnVelocity_MatchesExact_AnyRadius) {
  for (const double radius : {1e-5, 1e-3, 0.05, 30.0}) {
    EXPECT_LE(head_on_error(engine_, dimension_, 1.0, 1.0, 100.0, radius), rounding()) << radius;
  }
}

TEST_P(SteppedEngines, WallBounce_MatchesExact_AnyRestitutionAndDirection) {
  for (const double restitution : {1.0, 0.5, 0.0}) {
    for (const double angle : {0.0, 0.4, 1.2, 2.0, 3.5, 5.9}) {
      const Vec3 normal = Vec3(std::cos(angle), std::sin(angle), dimension_ == 3 ? angle : 0.0).normalized();
      EXPECT_LE(wall_error(engine_, dimension_, normal, restitution), rounding())
          << restitution << " " << angle;
    }
  }
}

// Sliding: Δv_t = μ (1 + e) v_n. Sticking: Δv_t = (2/7) g_t. The spin changes by (5/2) Δv_t/r.
TEST_P(SteppedEngines, SpinAndFriction_MatchImpactLaw_SlidingAndSticking) {
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

TEST_P(SteppedEngines, Ball_DoesNotRotate_WithoutSpin) {
  const Scenario scene = gas(dimension_, 6, 1.0 / 240.0, 240);
  for (const char* profile : {"faithful", "default"}) {
    const Probe run = after(engine_, scene, profile);
    for (std::size_t i = 0; i < scene.balls.size(); ++i) EXPECT_EQ(run[i].spin, Vec3::Zero());
  }
}

TEST_P(SteppedEngines, Account_ExplainsMomenta_InWalledGas) {
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

TEST_P(SteppedEngines, Account_ExplainsMomentum_WithGravityAndFriction) {
  Scenario scene = gas(dimension_, 6, 1.0 / 240.0, 500);
  scene.effects.gravity = Vec3(0.3, -0.5, 0);
  scene.effects.spin = true;
  scene.ball_contact = scene.wall_contact = {0.9, 0.3, 0.0};
  for (const char* profile : {"faithful", "default"}) {
    const Unexplained rest = unexplained(engine_, scene, profile);
    EXPECT_LE(rest.momentum_Ns, momentum_rounding(engine_, scene, rest.tally)) << profile;
  }
}

// Between two balls Bullet lets friction act at two points, one on each surface, which turns the pair; so the
// account is tested where only walls have friction.
// Between two balls Bullet and Chipmunk let friction act at two points, one on each surface, which turns the
// pair; so the account is tested where only walls have friction.
TEST_P(SteppedEngines, Account_ExplainsAngularMomentum_OfFrictionAtWalls) {
  Scenario scene = gas(dimension_, 6, 1.0 / 240.0, 500);
  scene.effects.spin = true;
  scene.wall_contact = {0.9, 0.3, 0.0};
  const Unexplained rest = unexplained(engine_, scene);
  EXPECT_LE(rest.angular_momentum_Nms, angular_momentum_rounding(engine_, scene));
}

TEST_P(SteppedEngines, Bounces_AreCountedOnce_WhileBallRests) {
  Scenario scene = scene_of(dimension_, 0.004, 2000);
  scene.effects.gravity = Vec3(0, -9.81, 0);
  scene.wall_contact.restitution = 0.0;
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.balls = {ball(1.0, 0.5, Vec3(0, 1.0, 0))};
  EXPECT_EQ(after(engine_, scene).tally().impacts, 1);  // it lands and stays
}

TEST_P(SteppedEngines, ImmovableBall_StandsOrMovesSteadily_AndIsAccountedFor) {
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

TEST_P(SteppedEngines, LinearDrag_IsExponential_AtAnyStep) {
  for (const double step_s : {0.001, 0.1}) {
    Scenario scene = scene_of(dimension_, step_s, std::lround(1.0 / step_s));
    scene.effects.drag = Drag{Drag::Kind::linear, 0.6};
    scene.balls = {ball(2.0, 0.5, Vec3::Zero(), Vec3(3.0, 0, 0))};
    // Each step rounds the velocity twice.
    const double tolerance = 2.0 * epsilon(engine_) * static_cast<double>(scene.frames);
    EXPECT_NEAR(after(engine_, scene)[0].velocity.x() / 3.0, std::exp(-0.3), tolerance);
  }
}

TEST_P(SteppedEngines, QuadraticDragAndMagnus_MatchClosedForms) {
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

TEST_P(SteppedEngines, Balls_PassThroughEachOther_WithoutCollisions) {
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

TEST_P(SteppedEngines, Switches_MakeOneProfileTheOther_AllTogether) {
  EXPECT_THAT(all_switched_is_not_the_other(engine_), testing::IsEmpty());
}

TEST_P(SteppedEngines, Switch_MovesItsOwnSettingOnly) {
  EXPECT_THAT(one_switched_moves_others(engine_), testing::IsEmpty());
}

// Each impulse is rounded in each of the iterations that move it, in each step: 480 of them, all in one
// direction.
TEST_P(SteppedEngines, EnergyAccount_ExplainsEveryJoule_InRoughLossyGas) {
  EXPECT_LE(unexplained_energy_of_gas(engine_, "faithful", dimension_), 480.0 * epsilon(engine_));
}

TEST_P(SteppedEngines, EnergyAccount_BooksAWallImpactAtTheWall) {
  EXPECT_LE(wall_impact_error(engine_, dimension_), 16.0 * epsilon(engine_));
}

}  // namespace
}  // namespace carom
