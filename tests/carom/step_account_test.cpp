#include <gtest/gtest.h>

#include <limits>

#include "carom/compose.h"
#include "tests/support/scenes.h"

// The account of the evolver `step`: with what it books, momentum and angular momentum are kept to round-off,
// although its correction of positions moves balls that have momentum.

namespace carom::test {
namespace {

class StepAccount : public testing::TestWithParam<int> {
 protected:
  /// A dense gas at a step so long that balls overlap by a large part of their radii.
  static Scenario coarse_gas(std::uint64_t seed) {
    Scenario scene = *gas(GetParam(), 60, 0.3, 4.0, seed);
    scene.duration_s = 2.0;
    scene.step_s = 0.02;
    return scene;
  }

  static void expect_accounted(const Scenario& scene) {
    const auto simulation = compose(scene, {"step", ""});
    constexpr std::int64_t kSteps = 100;
    const auto states = run(*simulation, scene, kSteps);
    const Tally tally = simulation->tally();
    EXPECT_GT(tally.impacts, 50);
    // In each step each ball's place, and each impact, rounds a moment a few times. The gas keeps its size
    // and, as no energy is gained, the scale of its speeds.
    const double roundings = 8.0 * static_cast<double>(kSteps) + static_cast<double>(tally.impacts);
    const Vec3 moment = angular_momentum_of(scene, states_of(scene)) + tally.external_angular_impulse;
    EXPECT_LE((angular_momentum_of(scene, states) - moment).norm(),
              roundings * kEpsilon * angular_momentum_scale(scene));
    const Vec3 momentum = momentum_of(scene, states_of(scene)) + tally.external_impulse;
    double scale = 0.0;
    for (const Ball& ball : scene.balls) scale += ball.mass * ball.velocity.norm();
    EXPECT_LE((momentum_of(scene, states) - momentum).norm(), roundings * kEpsilon * scale);
    EXPECT_GT(tally.external_angular_impulse.norm(), 0.0);
  }

  static constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
};

TEST_P(StepAccount, KeepsAngularMomentum_SmoothBallsInABox) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    expect_accounted(coarse_gas(seed));
  }
}

TEST_P(StepAccount, KeepsAngularMomentum_OverlappingBallsWithoutWalls) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Scenario scene = coarse_gas(seed);
    scene.walls.clear();
    const Vec3 middle(2, 2, scene.dimension == 3 ? 2 : 0);
    for (Ball& ball : scene.balls) ball.velocity -= 3.0 * (ball.position - middle);
    expect_accounted(scene);
  }
}

TEST_P(StepAccount, KeepsAngularMomentum_RoughLossyBallsOfManyMasses) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Scenario scene = coarse_gas(seed);
    Random random(seed);
    scene.effects.spin = true;
    scene.ball_contact = {0.9, 0.3, 0.4};
    scene.wall_contact = {0.8, 0.2, 0.1};
    for (Ball& ball : scene.balls) {
      ball.mass = random.uniform(0.1, 10.0);
      ball.spin = scene.dimension == 2 ? Vec3(0, 0, random.uniform(-4, 4)) : random_vector(random, 3, 4.0);
    }
    expect_accounted(scene);
  }
}

TEST_P(StepAccount, KeepsAngularMomentum_UnderALawForSeveralContactsAtOnce) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    Scenario scene = coarse_gas(seed);
    scene.multi_contact = MultiContact::simultaneous;
    expect_accounted(scene);
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, StepAccount, testing::Values(2, 3));

}  // namespace
}  // namespace carom::test
