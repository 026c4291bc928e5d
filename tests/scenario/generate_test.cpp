#include "scenario/generate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <ostream>
#include <string>
#include <vector>

#include "tests/support/numbers.h"

namespace carom::test {

namespace {

using ::testing::HasSubstr;

Scenario boxed(int dimension, double side = 1.0) {
  Scenario scene;
  scene.dimension = dimension;
  Vec3 corner = Vec3::Zero();
  for (int axis = 0; axis < dimension; ++axis) {
    corner[axis] = side;
    scene.walls.push_back({Vec3::Unit(axis), 0.0});
    scene.walls.push_back({-Vec3::Unit(axis), -side});
  }
  scene.box = Box{Vec3::Zero(), corner};
  return scene;
}

Generator gas(std::size_t count, double packing, std::uint64_t seed = 1) {
  Generator generator;
  generator.count = count;
  generator.packing = packing;
  generator.seed = seed;
  return generator;
}

/// Generates and adds what was made to the scene, as the reader of a scene file does.
std::vector<Ball> add(const Generator& generator, Scenario& scene) {
  std::vector<Ball> made = generate(generator, scene);
  scene.balls.insert(scene.balls.end(), made.begin(), made.end());
  return made;
}

/// The deepest overlap of two balls, m, and of a ball with a wall, slab or barrier; negative where there is
/// room. In the order of their lower ends along x only balls whose extents meet are compared.
double deepest_overlap_of(const Scenario& scene) {
  double deepest = -std::numeric_limits<double>::infinity();
  std::vector<Ball> balls = scene.balls;
  const auto low = [](const Ball& ball) { return ball.position.x() - ball.radius; };
  std::sort(balls.begin(), balls.end(), [&](const Ball& a, const Ball& b) { return low(a) < low(b); });
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Ball& a = balls[i];
    for (std::size_t j = i + 1; j < balls.size() && low(balls[j]) <= a.position.x() + a.radius; ++j) {
      deepest = std::max(deepest, a.radius + balls[j].radius - (a.position - balls[j].position).norm());
    }
    for (const Wall& wall : scene.walls) {
      deepest = std::max(deepest, a.radius - (wall.normal.dot(a.position) - wall.offset));
    }
    const auto beside = [&](const auto& sheet) {
      const double distance = std::abs(sheet.normal.dot(a.position) - sheet.offset) - 0.5 * sheet.thickness;
      deepest = std::max(deepest, a.radius - distance);
    };
    for (const Slab& slab : scene.slabs) beside(slab);
    for (const Barrier& barrier : scene.barriers) beside(barrier);
  }
  return deepest;
}

double volume_of(const std::vector<Ball>& balls, int dimension) {
  double volume = 0.0;
  for (const Ball& ball : balls) {
    const double square = std::numbers::pi * ball.radius * ball.radius;
    volume += dimension == 2 ? square : 4.0 / 3.0 * square * ball.radius;
  }
  return volume;
}

/// FNV-1a over the bits of every number of every ball.
std::uint64_t hash_of(const std::vector<Ball>& balls) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto mix = [&](double number) {
    const auto bits = std::bit_cast<std::uint64_t>(number);
    for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (bits >> (8 * byte) & 0xffU)) * 0x100000001b3U;
  };
  for (const Ball& ball : balls) {
    mix(ball.mass);
    mix(ball.radius);
    for (int axis = 0; axis < 3; ++axis) mix(ball.position[axis]);
    for (int axis = 0; axis < 3; ++axis) mix(ball.velocity[axis]);
  }
  return hash;
}

// --- placing
// -------------------------------------------------------------------------------------------------

struct Dense {
  int dimension;
  std::size_t count;
  double packing;
};

std::ostream& operator<<(std::ostream& out, const Dense& dense) {
  return out << dense.count << " balls in " << dense.dimension << "D fill " << dense.packing;
}

class DenseGas : public ::testing::TestWithParam<Dense> {};

// The radii are scaled once so that the fractions add up; a sum of n terms errs by at most n ε.
TEST_P(DenseGas, Balls_AreApartAndFillWhatWasAsked_ForEverySeed) {
  const auto [dimension, count, packing] = GetParam();
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Scenario scene = boxed(dimension);
    add(gas(count, packing, seed), scene);
    ASSERT_EQ(scene.balls.size(), count);
    EXPECT_LE(deepest_overlap_of(scene), 0.0) << "seed " << seed;
    const double rounding = (static_cast<double>(count) + 8.0) * kEpsilon;
    EXPECT_NEAR(volume_of(scene.balls, dimension), packing, packing * rounding) << "seed " << seed;
    EXPECT_TRUE(scene.notes.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Plane, DenseGas,
                         ::testing::Values(Dense{2, 10, 0.5}, Dense{2, 100, 0.5}, Dense{2, 500, 0.5},
                                           Dense{2, 2000, 0.5}));
// So few as ten balls are crowded by the walls: at 0.35 their centres would have a third of the box's width
// left.
INSTANTIATE_TEST_SUITE_P(Space, DenseGas,
                         ::testing::Values(Dense{3, 10, 0.25}, Dense{3, 20, 0.35}, Dense{3, 100, 0.35},
                                           Dense{3, 500, 0.35}, Dense{3, 2000, 0.35}));

TEST(Generate, GasAmongOtherThings_KeepsClearOfAllOfThem) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Scenario scene = boxed(2, 4.0);
    scene.walls.push_back({Vec3(1.0, 1.0, 0.0).normalized(), 1.0});
    scene.slabs.push_back({Vec3(1.0, 0.2, 0.0).normalized(), 2.0, 0.05});
    scene.barriers.push_back({Vec3::UnitY(), 3.0, 0.3, 1.0, 1.0, 0});
    Ball large;
    large.radius = 0.5;
    large.position = Vec3(1.2, 1.2, 0.0);
    scene.balls.push_back(large);
    add(gas(200, 0.2, seed), scene);
    add(gas(20, 0.05, seed), scene);
    EXPECT_LE(deepest_overlap_of(scene), 0.0) << "seed " << seed;
  }
}

TEST(Generate, Polydisperse_OneToTwenty_IsPlaced) {
  for (const int dimension : {2, 3}) {
    Scenario scene = boxed(dimension);
    Generator generator = gas(1000, 0.35, 3);
    generator.radius = {0.05, 1.0};
    add(generator, scene);
    EXPECT_LE(deepest_overlap_of(scene), 0.0);
    const auto [low, high] =
        std::minmax_element(scene.balls.begin(), scene.balls.end(),
                            [](const Ball& a, const Ball& b) { return a.radius < b.radius; });
    EXPECT_GT(high->radius / low->radius, 10.0);
    EXPECT_LE(high->radius / low->radius, 20.0 * (1.0 + 4.0 * kEpsilon));
  }
}

TEST(Generate, HundredThousandBalls_ArePlaced) {
  for (const int dimension : {2, 3}) {
    Scenario scene = boxed(dimension);
    constexpr int kCount = 100'000 / kPart;
    add(gas(kCount, 0.2), scene);
    EXPECT_EQ(scene.balls.size(), static_cast<std::size_t>(kCount));
    EXPECT_LE(deepest_overlap_of(scene), 0.0);
  }
}

TEST(Generate, FarFromTheOrigin_BallsAreStillApart) {
  Scenario scene = boxed(2);
  const Vec3 shift(1e6, -1e6, 0.0);
  scene.box->min += shift;
  scene.box->max += shift;
  for (Wall& wall : scene.walls) wall.offset += wall.normal.dot(shift);
  add(gas(300, 0.4), scene);
  EXPECT_LE(deepest_overlap_of(scene), 0.0);
}

TEST(Generate, Radii_StayInTheirRange_WithoutPacking) {
  Scenario scene = boxed(2);
  Generator generator = gas(500, 0.1, 5);
  generator.packing.reset();
  generator.radius = {0.004, 0.012};
  double sum = 0.0;
  for (const Ball& ball : add(generator, scene)) {
    EXPECT_GE(ball.radius, 0.004);
    EXPECT_LE(ball.radius, 0.012);
    sum += ball.radius;
  }
  // Uniform over a width w, so the mean of n has the standard deviation w/√(12 n).
  EXPECT_NEAR(sum / 500.0, 0.008, kDeviations * 0.008 / std::sqrt(12.0 * 500.0));
  EXPECT_TRUE(scene.notes.empty());
}

TEST(Generate, PackingAndRadiusThatDisagree_ScaleTheRadiusAndSaySo) {
  Scenario scene = boxed(2);
  Generator generator = gas(100, 0.3);
  generator.radius = {0.01, 0.02};
  add(generator, scene);
  EXPECT_NEAR(volume_of(scene.balls, 2), 0.3, 0.3 * 108.0 * kEpsilon);
  ASSERT_EQ(scene.notes.size(), 1U);
  EXPECT_THAT(scene.notes.front(), HasSubstr("radius"));
}

// A radius rounded to two digits says the packing within a percent, and is then left as it is written.
TEST(Generate, PackingAndRadiusThatAgree_KeepTheRadius) {
  Scenario scene = boxed(2);
  Generator generator = gas(100, 0.126);
  generator.radius = {0.02, 0.02};
  for (const Ball& ball : add(generator, scene)) EXPECT_EQ(ball.radius, 0.02);
  EXPECT_TRUE(scene.notes.empty());
}

TEST(Generate, MassAndInertia_AreThoseAskedFor) {
  Scenario plane = boxed(2);
  Generator generator = gas(10, 0.1);
  generator.inertia = 0.5;
  for (const Ball& ball : add(generator, plane)) {
    EXPECT_EQ(ball.mass, 1.0);
    EXPECT_EQ(ball.inertia, 0.5);
  }
  generator.mass = 2.5;
  EXPECT_EQ(generate(generator, plane).front().mass, 2.5);
}

// Mass is density times area in the plane, times volume in space; a handful of roundings.
TEST(Generate, Density_GivesMassByAreaOrVolume) {
  for (const int dimension : {2, 3}) {
    Scenario scene = boxed(dimension);
    Generator generator = gas(50, 0.1);
    generator.radius = {1.0, 3.0};
    generator.density = 7.0;
    for (const Ball& ball : add(generator, scene)) {
      const double mass = 7.0 * volume_of({ball}, dimension);
      EXPECT_NEAR(ball.mass, mass, 8.0 * kEpsilon * mass);
    }
  }
}

// --- the same bits
// -------------------------------------------------------------------------------------------

Generator golden_generator() {
  Generator generator = gas(200, 0.3, 42);
  generator.radius = {1.0, 2.0};
  generator.density = 3.0;
  generator.speed = 1.5;
  return generator;
}

/// The bits of two gases, recorded once: a compiler, processor or library that makes others shows up here.
TEST(Generate, SameSeed_GivesTheSameBits_OnEveryMachine) {
  Scenario plane = boxed(2);
  EXPECT_EQ(hash_of(generate(golden_generator(), plane)), 8823172082124493404U);
  Scenario space = boxed(3);
  EXPECT_EQ(hash_of(generate(golden_generator(), space)), 13974960274543901764U);
}

TEST(Generate, OtherSeed_GivesOtherBalls) {
  std::vector<std::uint64_t> hashes;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Scenario scene = boxed(2);
    Generator generator = golden_generator();
    generator.seed = seed;
    hashes.push_back(hash_of(generate(generator, scene)));
    Scenario again = boxed(2);
    EXPECT_EQ(hash_of(generate(generator, again)), hashes.back());
  }
  std::sort(hashes.begin(), hashes.end());
  EXPECT_EQ(std::adjacent_find(hashes.begin(), hashes.end()), hashes.end());
}

// --- speeds
// --------------------------------------------------------------------------------------------------

std::vector<Ball> warm(int dimension, std::size_t count, std::uint64_t seed, bool polydisperse) {
  Scenario scene = boxed(dimension);
  Generator generator = gas(count, 0.1, seed);
  if (polydisperse) {
    generator.radius = {1.0, 3.0};
    generator.density = 1.0;
  }
  generator.speed = 2.0;
  return generate(generator, scene);
}

// Each of the n momenta that are summed, and the sums of momentum and mass, err by at most n ε/2 of Σ m|v|;
// the mean taken out, the subtraction and the scaling add three roundings. With d components: √d (n + 3) ε Σ
// m|v|.
TEST(Generate, TotalMomentum_IsZeroToRoundOff) {
  for (const std::size_t count : {2U, 3U, 10U, 1000U}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      Vec3 momentum = Vec3::Zero();
      double scale = 0.0;
      for (const Ball& ball : warm(3, count, seed, true)) {
        momentum += ball.mass * ball.velocity;
        scale += ball.mass * ball.velocity.norm();
      }
      const double rounding = std::sqrt(3.0) * (static_cast<double>(count) + 3.0) * kEpsilon;
      EXPECT_LE(momentum.norm(), rounding * scale) << count << " balls, seed " << seed;
    }
  }
}

// A mean of n squares errs by at most (n + 4) ε/2, here and in the generator, and its root by half of that.
TEST(Generate, RootMeanSquareSpeed_IsExactToRoundOff) {
  for (const std::size_t count : {2U, 10U, 1000U}) {
    double square = 0.0;
    for (const Ball& ball : warm(2, count, 1, true)) square += ball.velocity.squaredNorm();
    const double speed = std::sqrt(square / static_cast<double>(count));
    EXPECT_NEAR(speed, 2.0, 2.0 * (static_cast<double>(count) + 4.0) * kEpsilon) << count;
  }
}

TEST(Generate, Plane_HasNoVelocityAlongZ) {
  for (const Ball& ball : warm(2, 100, 1, false)) {
    EXPECT_EQ(ball.position.z(), 0.0);
    EXPECT_EQ(ball.velocity.z(), 0.0);
    EXPECT_EQ(ball.spin, Vec3(0.0, 0.0, 0.0));
  }
}

// Equipartition: the mean of m v² per component is the same for the lighter and the heavier half and along
// each axis. A mean of n squares of normal deviates has the relative standard deviation √(2/n), a ratio of
// two of them √(4/n).
TEST(Generate, Speeds_AreThoseOfOneTemperature_WhateverTheMass) {
  constexpr std::size_t kCount = 20'000;
  std::vector<Ball> balls = warm(2, kCount, 11, true);
  std::sort(balls.begin(), balls.end(), [](const Ball& a, const Ball& b) { return a.mass < b.mass; });
  ASSERT_GT(balls.back().mass / balls.front().mass, 8.0);
  const auto mean = [&](std::size_t first, std::size_t last, int axis) {
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) sum += balls[i].mass * std::pow(balls[i].velocity[axis], 2);
    return sum / static_cast<double>(last - first);
  };
  const double bound = kDeviations * std::sqrt(4.0 / (kCount / 2.0));
  for (const int axis : {0, 1}) {
    EXPECT_NEAR(mean(0, kCount / 2, axis) / mean(kCount / 2, kCount, axis), 1.0, bound) << axis;
  }
  EXPECT_NEAR(mean(0, kCount, 0) / mean(0, kCount, 1), 1.0, kDeviations * std::sqrt(4.0 / kCount));
}

// Maxwell: z = v √m of each component is normal. Over n of them z̄⁴/(z̄²)² is 3 with the standard deviation
// √(24/n), z̄³/(z̄²)^(3/2) is 0 with √(6/n).
TEST(Generate, Speeds_AreMaxwells) {
  for (const int dimension : {2, 3}) {
    std::vector<double> z;
    for (const Ball& ball : warm(dimension, 10'000, 12, true)) {
      for (int axis = 0; axis < dimension; ++axis) z.push_back(std::sqrt(ball.mass) * ball.velocity[axis]);
    }
    const auto n = static_cast<double>(z.size());
    const auto moment = [&](int power) {
      return std::accumulate(z.begin(), z.end(), 0.0,
                             [&](double sum, double x) { return sum + std::pow(x, power); }) /
             n;
    };
    EXPECT_NEAR(moment(4) / std::pow(moment(2), 2), 3.0, kDeviations * std::sqrt(24.0 / n));
    EXPECT_NEAR(moment(3) / std::pow(moment(2), 1.5), 0.0, kDeviations * std::sqrt(6.0 / n));
  }
}

TEST(Generate, Velocity_IsAddedToTheThermalOne) {
  Scenario scene = boxed(2);
  Generator generator = gas(50, 0.1);
  generator.velocity = Vec3(3.0, -1.0, 0.0);
  for (const Ball& ball : generate(generator, scene)) EXPECT_EQ(ball.velocity, *generator.velocity);
}

// --- lattices and lines
// --------------------------------------------------------------------------------------

Generator row(Generator::Kind kind, std::size_t count, double radius) {
  Generator generator;
  generator.kind = kind;
  generator.count = count;
  generator.radius = {radius, radius};
  return generator;
}

// Coordinates of about 1 m that are sums of a few terms: touching balls and walls may overlap by a few ε.
constexpr double kTouching = 16.0 * kEpsilon;

TEST(Generate, LatticeInABox_StandsClearInside_ForEveryCount) {
  for (const int dimension : {2, 3}) {
    for (const std::size_t count : {1U, 2U, 7U, 27U, 64U, 100U}) {
      Scenario scene = boxed(dimension);
      add(row(Generator::Kind::lattice, count, 0.04), scene);
      EXPECT_EQ(scene.balls.size(), count);
      EXPECT_LE(deepest_overlap_of(scene), kTouching) << dimension << "D, " << count;
    }
  }
}

TEST(Generate, LatticeThatJustFits_IsPlaced_AndOneBallMoreIsNot) {
  Scenario scene = boxed(2);
  add(row(Generator::Kind::lattice, 16, 0.125), scene);
  EXPECT_LE(deepest_overlap_of(scene), kTouching);
  Scenario again = boxed(2);
  EXPECT_THROW(generate(row(Generator::Kind::lattice, 17, 0.125), again), DoesNotFit);
}

TEST(Generate, LatticeWithoutBox_IsASquareOrCubeWithTheGapAsked) {
  Scenario open;
  open.dimension = 3;
  Generator generator = row(Generator::Kind::lattice, 8, 0.5);
  generator.gap = 0.25;
  generator.position = Vec3(1.0, 2.0, 3.0);
  const std::vector<Ball> balls = generate(generator, open);
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3 cell(static_cast<double>(i & 1U), static_cast<double>(i >> 1U & 1U),
                    static_cast<double>(i >> 2U));
    EXPECT_EQ(balls[i].position, Vec3(*generator.position + 1.25 * cell)) << i;
  }
}

TEST(Generate, LineInABox_IsSpreadEvenly) {
  Scenario scene = boxed(2);
  add(row(Generator::Kind::line, 4, 0.05), scene);
  // Four diameters of 0.1 leave 0.6 for five gaps.
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(scene.balls[i].position.x(), 0.17 + 0.22 * static_cast<double>(i), kTouching) << i;
    EXPECT_EQ(scene.balls[i].position.y(), 0.5);
  }
}

TEST(Generate, LineWithoutBox_StartsWhereToldAlongItsDirection) {
  Scenario open;
  Generator generator = row(Generator::Kind::line, 3, 0.5);
  generator.gap = 0.0;
  generator.position = Vec3(1.0, 1.0, 0.0);
  generator.direction = Vec3(0.0, -3.0, 0.0);
  const std::vector<Ball> balls = generate(generator, open);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(balls[i].position, Vec3(1.0, 1.0 - static_cast<double>(i), 0.0)) << i;
  }
}

TEST(Generate, LineOfUnequalBalls_HasEqualGapsBetweenSurfaces) {
  Scenario scene = boxed(2);
  Generator generator = row(Generator::Kind::line, 6, 0.0);
  generator.radius = {0.01, 0.05};
  generator.gap = 0.02;
  const std::vector<Ball> balls = add(generator, scene);
  for (std::size_t i = 1; i < balls.size(); ++i) {
    const double between = (balls[i].position - balls[i - 1].position).norm();
    EXPECT_NEAR(between - balls[i].radius - balls[i - 1].radius, 0.02, kTouching) << i;
  }
}

// --- close packings
// ---------------------------------------------------------------------------------------

Generator close_packed(std::size_t count, double radius) {
  Generator generator = row(Generator::Kind::lattice, count, radius);
  generator.arrangement = Generator::Arrangement::close;
  return generator;
}

/// How many others each ball touches, within rounding.
std::vector<std::size_t> touching(const std::vector<Ball>& balls) {
  std::vector<std::size_t> counts(balls.size(), 0);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    for (std::size_t j = 0; j < balls.size(); ++j) {
      const double gap = (balls[i].position - balls[j].position).norm() - balls[i].radius - balls[j].radius;
      if (i != j && std::abs(gap) <= kTouching) ++counts[i];
    }
  }
  return counts;
}

// In the densest packings a ball inside touches 6 others in the plane and 12 in space, and none is nearer.
TEST(Generate, ClosePacking_GivesEveryInnerBallAsManyNeighboursAsThereCanBe) {
  for (const int dimension : {2, 3}) {
    Scenario scene = boxed(dimension);
    Generator generator = close_packed(dimension == 2 ? 80 : 300, 0.05);
    generator.gap = 0.0;
    const std::vector<Ball> balls = add(generator, scene);
    EXPECT_LE(deepest_overlap_of(scene), kTouching);
    const std::vector<std::size_t> counts = touching(balls);
    const std::size_t most = dimension == 2 ? 6 : 12;
    EXPECT_EQ(*std::max_element(counts.begin(), counts.end()), most);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      // Inside: two rows from the walls, and below the last row begun.
      const Vec3& x = balls[i].position;
      const double top = balls.back().position[dimension - 1] - 0.15;
      bool inside = x[dimension - 1] < top;
      for (int axis = 0; axis < dimension; ++axis) inside = inside && x[axis] > 0.15 && x[axis] < 0.75;
      if (inside) {
        EXPECT_EQ(counts[i], most) << dimension << "D, ball " << i;
      }
    }
  }
}

TEST(Generate, ClosePackingInABox_StandsClearInside_ForEveryCount) {
  for (const int dimension : {2, 3}) {
    for (const std::size_t count : {1U, 2U, 7U, 32U, 64U, 100U}) {
      Scenario scene = boxed(dimension);
      add(close_packed(count, 0.04), scene);
      EXPECT_EQ(scene.balls.size(), count);
      EXPECT_LE(deepest_overlap_of(scene), kTouching) << dimension << "D, " << count;
    }
  }
}

// Where random placement and the cubic lattice (0.785 and 0.524) end, walls included.
TEST(Generate, ClosePacking_FillsMoreThanAnyOther) {
  Scenario plane = boxed(2);
  add(close_packed(400, std::sqrt(0.8 / (400.0 * std::numbers::pi))), plane);
  EXPECT_LE(deepest_overlap_of(plane), kTouching);
  Scenario space = boxed(3);
  add(close_packed(500, std::cbrt(0.6 * 0.75 / (500.0 * std::numbers::pi))), space);
  EXPECT_LE(deepest_overlap_of(space), kTouching);
}

// Ten diameters and a half take rows of ten, every other one half a ball to the side; all exact in binary.
TEST(Generate, ClosePacking_TakesABoxThatJustFits_AndOneBallMoreDoesNot) {
  const double height = 0.25 + 3.0 * 0.125 * std::numbers::sqrt3 + kTouching;
  const auto box = [&] {
    Scenario scene = boxed(2);
    scene.box->max = Vec3(2.625, height, 0.0);
    scene.walls[1].offset = -2.625;
    scene.walls[3].offset = -height;
    return scene;
  };
  Scenario full = box();
  const std::vector<Ball> balls = add(close_packed(40, 0.125), full);
  EXPECT_LE(deepest_overlap_of(full), kTouching * height);
  EXPECT_NEAR(balls[0].position.x(), 0.125, kTouching);
  EXPECT_NEAR(balls[10].position.x(), 0.25, kTouching);
  EXPECT_NEAR(balls[39].position.x(), 2.5, kTouching);
  Scenario again = box();
  EXPECT_THROW(generate(close_packed(41, 0.125), again), DoesNotFit);
}

// Without a box the smallest block of full rows: 2 × 2 in the plane, face-centred cubes of edge √2 in space.
TEST(Generate, ClosePackingWithoutBox_StartsWhereTold) {
  Scenario open;
  open.dimension = 2;
  Generator generator = close_packed(4, 0.5);
  generator.gap = 0.0;
  generator.position = Vec3(1.0, 2.0, 0.0);
  const std::vector<Ball> balls = generate(generator, open);
  const double row_height = 0.5 * std::numbers::sqrt3;
  const Vec3 sites[] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.5, row_height, 0.0}, {1.5, row_height, 0.0}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LE((balls[i].position - *generator.position - sites[i]).norm(), kTouching) << i;
  }
  open.dimension = 3;
  generator.count = 14;  // the corners and face centres of one cube, of three sites along each edge
  double farthest = 0.0;
  for (const Ball& ball : generate(generator, open)) {
    farthest = std::max(farthest, (ball.position - *generator.position).cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(farthest, std::numbers::sqrt2, kTouching);
}

// --- what does not fit
// ---------------------------------------------------------------------------------------

std::string refusal(const Generator& generator, Scenario scene) {
  try {
    generate(generator, scene);
  } catch (const DoesNotFit& error) {
    return error.what();
  }
  return "fits";
}

TEST(Generate, GasThatDoesNotFit_SaysHowFarItCame) {
  EXPECT_THAT(refusal(gas(100, 0.95), boxed(2)), HasSubstr("of 100 balls fit"));
  EXPECT_THAT(refusal(gas(100, 0.8), boxed(3)), HasSubstr("of 100 balls fit"));
}

TEST(Generate, BallsOnTopOfOthers_DoNotFit) {
  Scenario scene;
  scene.balls.push_back(Ball{});
  const std::string words = "overlap";
  EXPECT_THAT(refusal(row(Generator::Kind::line, 2, 0.5), scene), HasSubstr(words));
  EXPECT_THAT(refusal(row(Generator::Kind::lattice, 4, 0.5), scene), HasSubstr(words));
}

TEST(Generate, BallsInASlabOrBarrier_DoNotFit) {
  Scenario slab;
  slab.slabs.push_back({Vec3::UnitX(), 0.0, 0.1});
  EXPECT_THROW(generate(row(Generator::Kind::line, 2, 0.5), slab), DoesNotFit);
  Scenario barrier;
  barrier.barriers.push_back({Vec3::UnitY(), 0.0, 0.1, 1.0, 1.0, 0});
  Generator lattice = row(Generator::Kind::lattice, 4, 0.5);
  lattice.position = Vec3::Zero();
  EXPECT_THROW(generate(lattice, barrier), DoesNotFit);
}

}  // namespace

}  // namespace carom::test
