#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "carom/compose.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

// What a list of pairs has, which of them are due, and how balls are sorted in memory change no bit: beside
// each run stands its slow twin, which looks at all pairs in every step and leaves the balls in their order.

namespace carom::test {
namespace {

constexpr std::uint64_t kSeeds = kPart == 1 ? 2 : 1;
/// Long enough for dozens of lists, and so for balls that are sorted again and again.
constexpr std::int64_t kSteps = kPart == 1 ? 160 : 80;
constexpr double kStep_s = 0.02;

/// A gas in which a ball flies about a fiftieth of its radius in a step.
ScenarioPtr slow_gas(int dimension, std::uint64_t seed, const std::string& more = "") {
  return gas(dimension, 60, 0.2, dimension == 2 ? 25.0 : 12.0, seed, more);
}

/// What balls can be subject to that moves them, or makes them rest, in a way of its own.
std::vector<std::pair<std::string, ScenarioPtr>> scenes_of(int dimension, std::uint64_t seed) {
  const std::string down = dimension == 2 ? "[0.5, -9.81]" : "[0.5, -9.81, 0.25]";
  const std::string along = dimension == 2 ? "[1, 0]" : "[1, 0, 0]";
  const double middle = dimension == 2 ? 12.5 : 6.0;
  std::vector<std::pair<std::string, ScenarioPtr>> scenes;
  scenes.emplace_back("gas", slow_gas(dimension, seed));
  scenes.emplace_back("pile", slow_gas(dimension, seed,
                                       "[effects]\ngravity = " + down + "\nspin = true\n[contact]\n" +
                                           "restitution = 0.6\nfriction = 0.3\n"));
  scenes.emplace_back(
      "smooth pile",
      slow_gas(dimension, seed, "[effects]\ngravity = " + down + "\n[contact]\nrestitution = 0.5\n"));
  scenes.emplace_back(
      "touching law",
      slow_gas(dimension, seed, "[effects]\ngravity = " + down + "\n[contact]\nlaw = \"simultaneous\"\n"));
  scenes.emplace_back("barrier",
                      slow_gas(dimension, seed,
                               "[[barrier]]\nnormal = " + along + "\noffset = " + std::to_string(middle) +
                                   "\nthickness = 0.05\nheight = 0.05\nhbar = 0.05\nseed = 1\n"));
  auto mixed = std::make_shared<Scenario>(*scenes.front().second);
  for (std::size_t i = 0; i < mixed->balls.size(); ++i) mixed->balls[i].radius *= i % 3 == 0 ? 1.0 : 0.05;
  mixed->balls[7].velocity *= 40.0;
  mixed->balls[0].mass = std::numeric_limits<double>::infinity();
  scenes.emplace_back("sizes and speeds", mixed);
  scenes.emplace_back("passing", slow_gas(dimension, seed, "[effects]\ncollisions = false\n"));
  return scenes;
}

void expect_same_bits(const Tally& a, const Tally& b) {
  EXPECT_EQ(a.impacts, b.impacts);
  EXPECT_EQ(a.wall_impacts, b.wall_impacts);
  EXPECT_EQ(a.wall_push_Ns, b.wall_push_Ns);
  EXPECT_EQ(a.external_impulse, b.external_impulse);
  EXPECT_EQ(a.external_angular_impulse, b.external_angular_impulse);
  EXPECT_EQ(a.energy.ball_impacts_J, b.energy.ball_impacts_J);
  EXPECT_EQ(a.energy.wall_impacts_J, b.energy.wall_impacts_J);
  EXPECT_EQ(a.energy.friction_J, b.energy.friction_J);
  EXPECT_EQ(a.energy.correction_J, b.energy.correction_J);
}

void expect_same_bits(const Scenario& scene, const Variant& fast, const Variant& slow,
                      std::int64_t steps = kSteps) {
  const auto one = compose(scene, fast);
  const auto other = compose(scene, slow);
  for (const auto& simulation : {one.get(), other.get()}) {
    simulation->advance(kStep_s, steps / 2);
    simulation->advance(0.5 * kStep_s, steps / 4);
    simulation->advance(kStep_s, steps / 4);
  }
  expect_same_bits(one->tally(), other->tally());
  EXPECT_GT(one->tally().impacts, 0);
  const auto a = states_of(*one, scene.balls.size());
  const auto b = states_of(*other, scene.balls.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].position, b[i].position) << "ball " << i;
    ASSERT_EQ(a[i].velocity, b[i].velocity) << "ball " << i;
    ASSERT_EQ(a[i].spin, b[i].spin) << "ball " << i;
  }
}

class PairListTwin : public testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(PairListTwin, SameBits_AsAllPairs) {
  const auto& [evolver, dimension] = GetParam();
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    for (const auto& [name, scene] : scenes_of(dimension, seed)) {
      SCOPED_TRACE(testing::Message() << name << ", seed " << seed);
      expect_same_bits(*scene, {evolver, "wrapped-grid", Listed::kNear},
                       {evolver, "brute-force", Listed::kAll});
    }
  }
}

/// So many that their pairs are sorted into stretches; some so fast that they hurry ahead in the list.
TEST_P(PairListTwin, SameBits_AsAllPairs_ManyBallsAndSomeFast) {
  const auto& [evolver, dimension] = GetParam();
  const int balls = 3'000;
  Scenario scene = *gas(dimension, balls, 0.2, dimension == 2 ? 68.0 : 11.0, 3);
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    const std::size_t share = i % 200;
    scene.balls[i].velocity *= share == 0 ? 3.0 : 0.5 + 0.005 * static_cast<double>(share);
  }
  for (const bool mixed : {false, true}) {
    SCOPED_TRACE(testing::Message() << (mixed ? "mixed" : "equal"));
    if (mixed) {
      for (std::size_t i = 0; i < scene.balls.size(); ++i) scene.balls[i].radius *= i % 3 == 0 ? 1.0 : 0.05;
    }
    expect_same_bits(scene,
                     {evolver,
                      !mixed           ? "wrapped-grid"
                      : dimension == 2 ? "quadtree"
                                       : "octree",
                      Listed::kNear},
                     {evolver, "uniform-grid", Listed::kAll}, 24 / kPart);
  }
}

/// Beside a lattice of balls that all fly as fast, in the same direction, a few light ones that a heavy one
/// meets at once, each in a row of its own: they fly on three times as fast, or 1.8 times, at another light
/// one that comes, from nearer in one row and from farther in the next.
Scenario light_balls_that_are_hit(int dimension) {
  // Where more than one ball in fifty hurries the list ends.
  constexpr int kRows = 20 / kPart;
  constexpr bool kFewer = kPart > 1;
  const int side = dimension == 2 ? (kFewer ? 24 : 48) : (kFewer ? 9 : 13);
  const double width = 3.0 * side;
  Scenario scene = *gas(dimension, 2, 0.1, 2.0 * width + 40.0, 1);
  scene.balls.clear();
  const auto add = [&](const Vec3& place, const Vec3& velocity, double mass) {
    Ball ball;
    ball.radius = 0.5;
    ball.position = place + Vec3(10.0, 10.0, dimension == 2 ? 0.0 : 10.0);
    ball.velocity = velocity;
    ball.mass = mass;
    scene.balls.push_back(ball);
  };
  for (int k = 0; k < (dimension == 2 ? side * side : side * side * side); ++k) {
    add(3.0 * Vec3(k % side, k / side % side, k / side / side), Vec3::UnitY(), 1.0);
  }
  for (int row = 0; row < kRows; ++row) {
    const double gap = 0.2 * (row + 1);
    const Vec3 place(width + 5.0, 3.0 * row, 0.0);
    add(place, Vec3::UnitX(), 1.0);
    add(place + 1.01 * Vec3::UnitX(), (row % 2 == 0 ? -1.0 : 0.2) * Vec3::UnitX(), 1e-6);
    add(place + (2.01 + gap) * Vec3::UnitX(), -Vec3::UnitX(), 1e-6);
  }
  return scene;
}

/// Those that they get to before the list ends are not listed with them when it is made.
TEST_P(PairListTwin, SameBits_AsAllPairs_WhereImpactsMakeBallsFast) {
  const auto& [evolver, dimension] = GetParam();
  expect_same_bits(light_balls_that_are_hit(dimension), {evolver, "wrapped-grid", Listed::kNear},
                   {evolver, "uniform-grid", Listed::kAll}, 80 / kPart);
}

/// In a step that is as long as many flights a ball that is hit turns round, and is hit again where it began:
/// from there it meets whom it meets in short steps, though nobody was near the place of its first impact.
TEST(PairList, FindsWhomABallMeets_ThatIsHitAgainAndAgainInAStep) {
  const auto ball = [](double x, double y, double v_x, double v_y) {
    return fmt::format("[[ball]]\nposition = [{}, {}]\nvelocity = [{}, {}]\nradius = 0.1\nmass = 1.0\n", x, y,
                       v_x, v_y);
  };
  // The first goes right, is hit by the second at 0.5 s and turns, is hit by the third at 0.75 s where it
  // began, and flies 5.9 m/s fast at the fourth, which it touches 1.1 m farther on.
  const ScenarioPtr scene =
      scene_of("title = \"hit again\"\ndimension = 2\nduration = 1.0\nstep = 1.0\nframes = 1\n" +
               ball(0.0, 0.0, 1.0, 0.0) + ball(1.7, 0.0, -2.0, 0.0) + ball(3.164, 3.164, -4.03, -4.03) +
               ball(-1.114, -0.671, 0.0, 0.0));
  for (const Listed listed : {Listed::kNear, Listed::kAll}) {
    const auto at_once = compose(*scene, {"toi", "wrapped-grid", listed});
    const auto in_short_steps = compose(*scene, {"toi", "brute-force", Listed::kAll});
    at_once->advance(1.0, 1);
    in_short_steps->advance(1.0 / 512.0, 512);
    EXPECT_EQ(in_short_steps->tally().impacts, 3);
    EXPECT_EQ(at_once->tally().impacts, 3);
  }
}

INSTANTIATE_TEST_SUITE_P(Evolvers, PairListTwin,
                         testing::Combine(testing::Values("step", "toi"), testing::Values(2, 3)),
                         [](const auto& info) {
                           return std::get<0>(info.param) + std::to_string(std::get<1>(info.param)) + "D";
                         });

}  // namespace
}  // namespace carom::test
