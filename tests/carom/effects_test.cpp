#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include "carom/compose.h"
#include "carom/effects/list.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

Scenario thrown(const Vec3& velocity) {
  Ball ball;
  ball.mass = 2.0;
  ball.radius = 0.1;
  ball.velocity = velocity;
  return free_scene(2, {ball}, 1.0, 0.01);
}

BallState flown(const Scenario& scene, std::int64_t steps) {
  const auto simulation = compose(scene, {"toi", ""});
  return run(*simulation, scene, steps).front();
}

TEST(Effects, NotNamed_LeaveNothingBehind) {
  Scenario scene = thrown(Vec3::UnitX());
  EXPECT_EQ(make_flight<2>(scene), nullptr);
  EXPECT_TRUE(World<2>(scene.balls).inverse_inertia.empty());
  EXPECT_EQ(World<2>(scene.balls).spin.size(), 0U);
  scene.effects.gravity = Vec3::UnitY();
  EXPECT_NE(make_flight<2>(scene), nullptr);
  EXPECT_FALSE((FlightModel<3, Gravity<3>>::kDamps));
  EXPECT_TRUE((FlightModel<3, Gravity<3>, LinearDrag<3>>::kDamps));
  EXPECT_FALSE((FlightModel<3, Gravity<3>, LinearDrag<3>>::kTurns));
  EXPECT_TRUE((FlightModel<3, Magnus<3>>::kTurns));
}

TEST(Effects, TheSceneChooses_ExactlyWhatItNames) {
  const auto chosen = [](const Scenario& scene) {
    return with_effects(scene, EffectSlots<2>{}, [](auto... effects) -> std::string {
      std::string names = (std::string() + ... +
                           (std::is_same_v<decltype(effects), Gravity<2>>      ? "g"
                            : std::is_same_v<decltype(effects), LinearDrag<2>> ? "l"
                            : std::is_same_v<decltype(effects), Magnus<2>>     ? "m"
                                                                               : "q"));
      return names;
    });
  };
  Scenario scene = thrown(Vec3::Zero());
  EXPECT_EQ(chosen(scene), "");
  scene.effects.gravity = Vec3::UnitY();
  EXPECT_EQ(chosen(scene), "g");
  scene.effects.drag = Drag{Drag::Kind::linear, 1.0};
  EXPECT_EQ(chosen(scene), "gl");
  scene.effects.drag = Drag{Drag::Kind::quadratic, 1.0};
  EXPECT_EQ(chosen(scene), "gq");
  scene.effects.gravity.reset();
  EXPECT_EQ(chosen(scene), "q");
  scene.effects.magnus = 0.1;
  EXPECT_EQ(chosen(scene), "qm");
}

TEST(Gravity, Flight_IsExactAtAnyStep) {
  Scenario scene = thrown(Vec3(3.0, 4.0, 0.0));
  scene.effects.gravity = Vec3(0.5, -9.81, 0.0);
  for (const std::int64_t steps : {1, 7, 1000}) {
    const BallState state = flown(scene, steps);
    const double rounding = 8.0 * kEpsilon * (10.0 + static_cast<double>(steps));
    EXPECT_NEAR(state.position.x(), 3.25, rounding);
    EXPECT_NEAR(state.position.y(), 4.0 - 0.5 * 9.81, rounding);
    EXPECT_NEAR(state.velocity.y(), 4.0 - 9.81, rounding);
  }
}

/// The order p in error ~ hᵖ, from two step counts.
double order_of(double error, double error_at_half_the_step) {
  return std::log2(error / error_at_half_the_step);
}

TEST(LinearDrag, ErrorFallsWithOrderTwo_WhenStepHalves) {
  Scenario scene = thrown(Vec3(3.0, 4.0, 0.0));
  scene.effects.gravity = Vec3(0.0, -9.81, 0.0);
  scene.effects.drag = Drag{Drag::Kind::linear, 1.5};
  // v = v_T + (v_0 - v_T) e^{-kt}, v_T = g/k, k = c/m; x is its integral.
  const double k = 0.75;
  const Vec3 terminal = *scene.effects.gravity / k;
  const Vec3 exact = terminal + (scene.balls[0].velocity - terminal) * (-std::expm1(-k) / k);
  const auto error = [&](std::int64_t steps) { return (flown(scene, steps).position - exact).norm(); };
  EXPECT_NEAR(order_of(error(64), error(128)), 2.0, 0.02);
  EXPECT_LT(error(1024), 1e-6);
}

TEST(QuadraticDrag, ErrorFallsWithOrderTwo_WhenStepHalves) {
  Scenario scene = thrown(Vec3(3.0, 4.0, 0.0));
  scene.effects.drag = Drag{Drag::Kind::quadratic, 0.8};
  // Straight on: x = (m/c) ln(1 + c v_0 t/m) along v_0.
  const double rate = 0.8 / 2.0;
  const double exact = std::log1p(rate * 5.0) / rate;
  const auto error = [&](std::int64_t steps) {
    return std::abs(flown(scene, steps).position.norm() - exact);
  };
  EXPECT_NEAR(order_of(error(256), error(512)), 2.0, 0.05);
  EXPECT_LT(error(1024), 1e-5);
}

TEST(QuadraticDrag, Fall_SettlesAtTheTerminalVelocity) {
  Scenario scene = thrown(Vec3::Zero());
  scene.duration_s = 20.0;
  scene.effects.gravity = Vec3(0.0, -9.81, 0.0);
  scene.effects.drag = Drag{Drag::Kind::quadratic, 0.8};
  // v_t = √(m g/c) is a fixed point of the step as well, so only rounding is left.
  EXPECT_NEAR(flown(scene, 2000).velocity.y(), -std::sqrt(2.0 * 9.81 / 0.8), 1e-12);
}

TEST(Drag, IsStable_HoweverLongTheStep) {
  Scenario scene = thrown(Vec3(3.0, 4.0, 0.0));
  scene.duration_s = 1000.0;
  for (const Drag::Kind kind : {Drag::Kind::linear, Drag::Kind::quadratic}) {
    scene.effects.drag = Drag{kind, 1e3};
    const BallState state = flown(scene, 10);
    EXPECT_LE(state.velocity.norm(), 5.0);
    EXPECT_LE(state.position.norm(), 5.0 * 1000.0);
  }
}

TEST(Drag, TwoBallsUnderDifferentDrag_MeetWithoutOverlap) {
  Ball light;
  light.mass = 0.1;
  light.radius = 0.1;
  light.position = Vec3(-1.0, 0.05, 0.0);
  light.velocity = Vec3(4.0, 0.0, 0.0);
  Ball heavy;
  heavy.mass = 10.0;
  heavy.radius = 0.2;
  Scenario scene = free_scene(2, {light, heavy}, 1.0, 0.02);
  scene.effects.drag = Drag{Drag::Kind::linear, 0.2};
  const auto simulation = compose(scene, {"toi", ""});
  for (int k = 0; k < 50; ++k) {
    simulation->advance(0.02, 1);
    const auto states = states_of(*simulation, 2);
    EXPECT_GE((states[1].position - states[0].position).norm(), 0.3 - 4.0 * kEpsilon);
  }
  EXPECT_EQ(simulation->tally().impacts, 1);
}

}  // namespace
}  // namespace carom::test
