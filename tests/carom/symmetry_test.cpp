#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "carom/compose.h"
#include "tests/support/scenes.h"

// What must hold for any right engine, without any truth. Where a scene and its image are not rounded alike,
// their rounding errors grow as any disturbance does: the growth is measured with a twin of the scene that is
// disturbed in its first positions, and what it makes of the rounding of every step is allowed.

namespace carom::test {
namespace {

class Symmetry : public testing::TestWithParam<std::tuple<int, std::uint64_t>> {
 protected:
  ScenarioPtr scene() const { return gas(std::get<0>(GetParam()), 30, 0.1, 4.0, std::get<1>(GetParam())); }
  static constexpr std::int64_t kSteps = 60;

  /// By how much the scene multiplies a small disturbance of its positions until the end, at least 1.
  static double growth(const Scenario& scene) {
    constexpr double kDisturbance = 1e-9;
    Scenario disturbed = scene;
    Random random(99);
    for (Ball& ball : disturbed.balls) ball.position += random_vector(random, scene.dimension, kDisturbance);
    const auto a = run(*compose(scene, {"toi", ""}), scene, kSteps);
    const auto b = run(*compose(disturbed, {"toi", ""}), disturbed, kSteps);
    double largest = 1.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      largest = std::max(largest, (a[i].position - b[i].position).norm() / kDisturbance);
      largest = std::max(largest, (a[i].velocity - b[i].velocity).norm() / kDisturbance);
    }
    return largest;
  }

  /// Round-off of a run: in each step a coordinate of up to 4 m, or a speed of a few m/s, is rounded twice.
  static double tolerance_of(const Scenario& scene) {
    return static_cast<double>(kSteps) * 2.0 * 4.0 * kEpsilon * growth(scene);
  }

  /// Runs the scene and its image, and holds the image of the outcome against the outcome of the image.
  static void expect_same(const Scenario& scene, const Scenario& image,
                          const std::function<BallState(const BallState&)>& map, double tolerance) {
    const auto original = compose(scene, {"toi", ""});
    const auto imaged = compose(image, {"toi", ""});
    const auto a = run(*original, scene, kSteps);
    const auto b = run(*imaged, image, kSteps);
    EXPECT_GT(original->tally().impacts, 10);
    EXPECT_EQ(original->tally().impacts, imaged->tally().impacts);
    for (std::size_t i = 0; i < a.size(); ++i) {
      const BallState expected = map(a[i]);
      EXPECT_LE((b[i].position - expected.position).norm(), tolerance) << "ball " << i;
      EXPECT_LE((b[i].velocity - expected.velocity).norm(), tolerance) << "ball " << i;
    }
  }
};

/// The scene with every vector mapped linearly (an isometry).
Scenario mapped(const Scenario& scene, const Eigen::Matrix3d& map) {
  Scenario image = scene;
  for (Ball& ball : image.balls) {
    ball.position = map * ball.position;
    ball.velocity = map * ball.velocity;
  }
  for (Wall& wall : image.walls) wall.normal = map * wall.normal;
  return image;
}

std::function<BallState(const BallState&)> by(const Eigen::Matrix3d& map) {
  return [map](const BallState& s) { return BallState{map * s.position, map * s.velocity, s.spin}; };
}

TEST_P(Symmetry, Mirror_BitForBit) {
  const ScenarioPtr s = scene();
  const Eigen::Matrix3d mirror = Vec3(-1.0, 1.0, 1.0).asDiagonal();
  expect_same(*s, mapped(*s, mirror), by(mirror), 0.0);
}

TEST_P(Symmetry, QuarterTurn) {
  const ScenarioPtr s = scene();
  Eigen::Matrix3d turn;
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  expect_same(*s, mapped(*s, turn), by(turn), tolerance_of(*s));
}

TEST_P(Symmetry, TurnByOneRadian) {
  const ScenarioPtr s = scene();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.0, Vec3::UnitZ()).toRotationMatrix();
  expect_same(*s, mapped(*s, turn), by(turn), tolerance_of(*s));
}

TEST_P(Symmetry, GalileanBoost_WithoutWalls) {
  Scenario s = *scene();
  s.walls.clear();
  for (Ball& ball : s.balls) ball.velocity -= 2.0 * (ball.position - Vec3(2, 2, s.dimension == 3 ? 2 : 0));
  Scenario boosted = s;
  const Vec3 boost(0.7, -0.3, 0.0);
  for (Ball& ball : boosted.balls) ball.velocity += boost;
  expect_same(
      s, boosted,
      [&](const BallState& state) {
        return BallState{state.position + s.duration_s * boost, state.velocity + boost, state.spin};
      },
      tolerance_of(s));
}

TEST_P(Symmetry, UnitScaling_BitForBit) {
  // Lengths by 2¹⁰ and times by 2⁻³: powers of two change no digit.
  const ScenarioPtr s = scene();
  const double length = 1024.0;
  const double time = 0.125;
  Scenario scaled = *s;
  scaled.duration_s *= time;
  for (Ball& ball : scaled.balls) {
    ball.position *= length;
    ball.radius *= length;
    ball.velocity *= length / time;
  }
  for (Wall& wall : scaled.walls) wall.offset *= length;
  expect_same(
      *s, scaled,
      [&](const BallState& state) {
        return BallState{length * state.position, (length / time) * state.velocity, state.spin};
      },
      0.0);
}

TEST_P(Symmetry, Relabelling) {
  const ScenarioPtr s = scene();
  Scenario relabelled = *s;
  std::reverse(relabelled.balls.begin(), relabelled.balls.end());
  const auto original = compose(*s, {"toi", ""});
  const auto image = compose(relabelled, {"toi", ""});
  const auto a = run(*original, *s, kSteps);
  const auto b = run(*image, relabelled, kSteps);
  const double tolerance = tolerance_of(*s);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LE((b[a.size() - 1 - i].position - a[i].position).norm(), tolerance) << "ball " << i;
  }
}

TEST_P(Symmetry, Reversal_ReturnsToTheStart) {
  const ScenarioPtr s = scene();
  const auto forth = compose(*s, {"toi", ""});
  const auto end = run(*forth, *s, kSteps);
  Scenario reversed = *s;
  for (std::size_t i = 0; i < end.size(); ++i) {
    reversed.balls[i].position = end[i].position;
    reversed.balls[i].velocity = -end[i].velocity;
  }
  const auto back = compose(reversed, {"toi", ""});
  const auto start = run(*back, reversed, kSteps);
  const double tolerance = tolerance_of(*s) + tolerance_of(reversed);
  for (std::size_t i = 0; i < start.size(); ++i) {
    EXPECT_LE((start[i].position - s->balls[i].position).norm(), tolerance) << "ball " << i;
    EXPECT_LE((start[i].velocity + s->balls[i].velocity).norm(), tolerance) << "ball " << i;
  }
}

TEST_P(Symmetry, SameBitsTwice_AndStepDoesNotMatterBeyondRounding) {
  const ScenarioPtr s = scene();
  const auto once = compose(*s, {"toi", ""});
  const auto again = compose(*s, {"toi", ""});
  const auto coarse = compose(*s, {"toi", ""});
  const auto a = run(*once, *s, kSteps);
  const auto b = run(*again, *s, kSteps);
  const auto c = run(*coarse, *s, 3);
  const double tolerance = tolerance_of(*s);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].velocity, b[i].velocity);
    EXPECT_LE((a[i].position - c[i].position).norm(), tolerance) << "ball " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Gases, Symmetry,
                         testing::Combine(testing::Values(2, 3), testing::Values(1, 2, 3, 4, 5)),
                         [](const auto& info) {
                           return std::to_string(std::get<0>(info.param)) + "D_seed" +
                                  std::to_string(std::get<1>(info.param));
                         });

}  // namespace
}  // namespace carom::test
