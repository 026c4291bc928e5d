#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "carom/compose.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

/// How often a ball that starts at x with the velocity v meets the sides of its way of length l in a time t:
/// unfolded, how many multiples of l lie on its straight way.
double meetings(double x, double v, double l, double t) {
  return std::abs(std::floor((x + v * t) / l) - std::floor(x / l));
}

class WallAccount : public testing::TestWithParam<const char*> {};

TEST_P(WallAccount, CountsEveryImpactOnAWall_AndAddsUpTheirPushes) {
  for (const int dimension : {2, 3}) {
    SCOPED_TRACE(testing::Message() << dimension << "D, seed 7");
    Scenario scene = *gas(dimension, 40, 0.2, 4.0, 7);
    scene.effects.collisions = false;
    scene.duration_s = 5.0;
    double impacts = 0.0;
    double push_Ns = 0.0;
    for (const Ball& ball : scene.balls) {
      for (int axis = 0; axis < dimension; ++axis) {
        const double hits = meetings(ball.position[axis] - ball.radius, ball.velocity[axis],
                                     4.0 - 2.0 * ball.radius, scene.duration_s);
        impacts += hits;
        push_Ns += hits * 2.0 * ball.mass * std::abs(ball.velocity[axis]);
      }
    }
    const auto simulation = compose(scene, {GetParam(), ""});
    simulation->advance(0.001, 5000);
    const Tally tally = simulation->tally();
    EXPECT_TRUE(tally.walls_known);
    EXPECT_EQ(tally.wall_impacts, tally.impacts);
    // `step` finds an impact up to a step late, and so may have the last of some balls still before it: each
    // has at most `dimension` of them under way, with the chance step/time between.
    const double late = std::string_view(GetParam()) == "step" ? 2.0 : 0.0;
    EXPECT_NEAR(static_cast<double>(tally.wall_impacts), impacts, late);
    const double fastest_push_Ns = 2.0 * 4.0;
    EXPECT_NEAR(tally.wall_push_Ns, push_Ns, 8.0 * kEpsilon * push_Ns * impacts + late * fastest_push_Ns);
  }
}

TEST_P(WallAccount, LeavesOutImpactsOfBallAndBall) {
  Scenario scene;
  scene.dimension = 2;
  scene.duration_s = 1.0;
  scene.walls = {{Vec3::UnitX(), 0.0}};
  Ball ball;
  ball.radius = 0.5;
  ball.position = Vec3(1.0, 0, 0);
  ball.velocity = Vec3(-1.0, 0, 0);
  Ball other = ball;
  other.position = Vec3(3.5, 0, 0);
  scene.balls = {
      ball, other};  // the first turns at 0.5 s and meets the second at 1.25 s; that one comes back at 2 s
  const auto simulation = compose(scene, {GetParam(), ""});
  simulation->advance(0.01, 100);
  EXPECT_EQ(simulation->tally().wall_impacts, 1);
  simulation->advance(0.01, 50);
  EXPECT_EQ(simulation->tally().impacts, 2);
  EXPECT_EQ(simulation->tally().wall_impacts, 1);
  EXPECT_NEAR(simulation->tally().wall_push_Ns, 2.0, 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Evolvers, WallAccount, testing::Values("event", "toi", "step"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace carom::test
