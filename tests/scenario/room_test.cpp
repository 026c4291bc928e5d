#include "scenario/room.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

using ::testing::HasSubstr;

Ball ball_of(double radius, const Vec3& position) {
  Ball ball;
  ball.mass = 1.0;
  ball.radius = radius;
  ball.position = position;
  return ball;
}

/// A ball of radius r between x = 0 and x = width.
Scenario gap_of(double width, double radius) {
  Scenario scene = free_scene(2, {ball_of(radius, Vec3(0.5 * width, 0, 0))}, 1.0, 0.01);
  scene.walls = {{Vec3::UnitX(), 0.0}, {-Vec3::UnitX(), -width}};
  return scene;
}

TEST(Room, BallWiderThanItsGap_IsAContradiction) {
  EXPECT_FALSE(lack_of_room(gap_of(0.3, 0.1)));
  ASSERT_TRUE(lack_of_room(gap_of(0.3, 0.2)));
  EXPECT_THAT(*lack_of_room(gap_of(0.3, 0.2)), HasSubstr("ball 0 has a diameter of 0.4 m"));
}

TEST(Room, BallThatFillsItsGap_HasRoom_ButForRounding) {
  // Gaps and radii that are rounded each for itself, anywhere.
  Random random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    const double radius = random.uniform(0.01, 10.0);
    const double left = random.uniform(-100.0, 100.0);
    Scenario scene = gap_of(2.0 * radius, radius);
    scene.walls = {{Vec3::UnitX(), left}, {-Vec3::UnitX(), -(left + 2.0 * radius)}};
    EXPECT_FALSE(lack_of_room(scene)) << trial;
    scene.balls[0].radius *= 1.0 + 1e-9;
    EXPECT_TRUE(lack_of_room(scene)) << trial;
  }
}

TEST(Room, BetweenAWallAndASlab_CountsTheSideOfTheBall) {
  Scenario scene = gap_of(10.0, 0.3);
  scene.slabs = {{Vec3::UnitX(), 0.55, 0.1}};  // leaves 0.5 m on the left
  EXPECT_FALSE(lack_of_room(scene));           // the ball is on the right
  scene.balls[0].position.x() = 0.3;
  EXPECT_TRUE(lack_of_room(scene));
  scene.balls[0].radius = 0.2;
  EXPECT_FALSE(lack_of_room(scene));
}

TEST(Room, WallsThatAreNotParallel_AndImmovableBalls_AreNoContradiction) {
  Scenario wedge = gap_of(0.3, 0.2);
  wedge.walls[1].normal = Vec3(-0.8, 0.6, 0);
  EXPECT_FALSE(lack_of_room(wedge));
  Scenario pillar = gap_of(0.3, 0.2);
  pillar.balls[0].mass = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(lack_of_room(pillar));
}

TEST(Room, IsAskedForEachBall_HoweverManyHaveIt) {
  Scenario scene = gap_of(0.3, 0.1);
  scene.balls.push_back(ball_of(0.2, Vec3(0.15, 1, 0)));
  ASSERT_TRUE(lack_of_room(scene));
  EXPECT_THAT(*lack_of_room(scene), HasSubstr("ball 1 has a diameter of 0.4 m"));
  // As large as one that has room, but on the narrow side of a slab.
  Scenario halves = gap_of(10.0, 0.3);
  halves.slabs = {{Vec3::UnitX(), 0.55, 0.1}};
  halves.balls.push_back(ball_of(0.3, Vec3(0.3, 1, 0)));
  ASSERT_TRUE(lack_of_room(halves));
  EXPECT_THAT(*lack_of_room(halves), HasSubstr("ball 1 has a diameter of 0.6 m"));
}

TEST(Room, SceneFileWithoutRoom_IsAnError) {
  const std::string text =
      "title = \"a\"\ndimension = 2\nduration = 1.0\nstep = 0.1\nframes = 1\n[box]\nmin = [0, 0]\n"
      "max = [0.3, 5]\n[[ball]]\nmass = 1.0\nradius = 0.2\nposition = [0.15, 1]\n";
  try {
    scene_of(text);
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("test.toml:"));
    EXPECT_THAT(error.what(), HasSubstr("stands between surfaces 0.3"));
  }
}

}  // namespace
}  // namespace carom::test
