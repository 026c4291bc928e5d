#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "carom/broad_phase/brute_force.h"
#include "carom/broad_phase/count.h"
#include "carom/broad_phase/sort_and_sweep.h"
#include "carom/broad_phase/tree.h"
#include "carom/broad_phase/uniform_grid.h"
#include "carom/broad_phase/wrapped_grid.h"
#include "carom/compose.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

/// A broad phase under test, in a dimension; its twin is BruteForce.
template <template <int, class> class BroadPhase, int Dimension>
struct In {
  static constexpr int kDim = Dimension;
  using Type = BroadPhase<Dimension, NoCount>;
  using Counted = BroadPhase<Dimension, CountTests>;
};

template <class CaseType>
class BroadPhaseTwin : public testing::Test {};
using Cases =
    testing::Types<In<UniformGrid, 2>, In<UniformGrid, 3>, In<Tree, 2>, In<Tree, 3>, In<SortAndSweep, 2>,
                   In<SortAndSweep, 3>, In<WrappedGrid, 2>, In<WrappedGrid, 3>>;
TYPED_TEST_SUITE(BroadPhaseTwin, Cases);

template <int Dim>
struct Cloud {
  VectorColumn<Dim> position;
  std::vector<float> bound;
};

/// Balls all over a cube, some on the seams of any grid; bounds spread over `ratio`.
template <int Dim>
Cloud<Dim> cloud(std::uint64_t seed, std::size_t count, double ratio) {
  Random random(seed);
  Cloud<Dim> result{VectorColumn<Dim>(count), {}};
  for (std::size_t i = 0; i < count; ++i) {
    Vec<Dim> x;
    for (int axis = 0; axis < Dim; ++axis) {
      x[axis] = i % 3 == 0 ? std::floor(random.uniform(-8.0, 8.0)) : random.uniform(-8.0, 8.0);
    }
    result.position.set(i, x);
    // Small ones are common and large ones rare, so that not everything overlaps.
    const double draw = random.uniform();
    result.bound.push_back(rounded_up(0.5 / (1.0 + draw * (ratio - 1.0))));
  }
  return result;
}

using PairSet = std::set<std::pair<std::size_t, std::size_t>>;

template <class BroadPhase>
PairSet pairs_of(const BroadPhase& broad_phase) {
  PairSet pairs;
  broad_phase.for_each_pair([&](std::size_t i, std::size_t j) {
    EXPECT_LT(i, j);
    EXPECT_TRUE(pairs.emplace(i, j).second) << "pair " << i << ", " << j << " is reported twice";
  });
  return pairs;
}

/// Who may meet a ball, the ball itself included, of those that a broad phase names.
template <class Case, class BroadPhase>
std::set<std::size_t> near(const BroadPhase& broad_phase, const Cloud<Case::kDim>& balls, std::size_t ball) {
  const auto reach_of = [&](std::size_t i) { return Reach<Case::kDim>{balls.position[i], balls.bound[i]}; };
  std::set<std::size_t> named;
  broad_phase.for_each_near(reach_of(ball), [&](std::size_t j) {
    EXPECT_TRUE(named.insert(j).second) << "ball " << j << " is named twice";
  });
  std::erase_if(named, [&](std::size_t j) { return !may_meet(reach_of(ball), reach_of(j)); });
  return named;
}

/// Expects the pairs of brute force, and the neighbours of some balls; returns how many pairs there are.
template <class Case>
std::size_t expect_same_as_twin(const Cloud<Case::kDim>& balls) {
  typename Case::Type fast;
  BruteForce<Case::kDim> twin;
  fast.build(balls.position, balls.bound);
  twin.build(balls.position, balls.bound);
  const PairSet pairs = pairs_of(twin);
  EXPECT_EQ(pairs_of(fast), pairs);
  for (std::size_t ball = 0; ball < balls.bound.size(); ball += 1 + balls.bound.size() / 10) {
    EXPECT_EQ(near<Case>(fast, balls, ball), near<Case>(twin, balls, ball)) << "ball " << ball;
  }
  return pairs.size();
}

TYPED_TEST(BroadPhaseTwin, FindsSamePairs_AsBruteForce_AnySizeSpread) {
  constexpr int kDim = TypeParam::kDim;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const double ratio : {1.0, 20.0, 1000.0, 1e12}) {
      for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{200}}) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", ratio " << ratio << ", balls " << count);
        expect_same_as_twin<TypeParam>(cloud<kDim>(seed, count, ratio));
      }
    }
  }
}

TYPED_TEST(BroadPhaseTwin, FindsSameNeighbours_AsBruteForce_AfterBoundsGrew) {
  constexpr int kDim = TypeParam::kDim;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Cloud<kDim> balls = cloud<kDim>(seed, 200, 50.0);
    typename TypeParam::Type fast;
    BruteForce<kDim> twin;
    fast.build(balls.position, balls.bound);
    twin.build(balls.position, balls.bound);
    for (std::size_t ball = 0; ball < 200; ball += 7) {
      balls.bound[ball] *= ball % 2 == 0 ? 3.0F : 40.0F;
      fast.bound_grew(ball);
      for (const std::size_t each : {ball, ball + 1}) {
        EXPECT_EQ(near<TypeParam>(fast, balls, each), near<TypeParam>(twin, balls, each)) << "ball " << each;
      }
    }
  }
}

TYPED_TEST(BroadPhaseTwin, FindsSamePairs_AsBruteForce_FarFromTheOriginAndFarApart) {
  constexpr int kDim = TypeParam::kDim;
  Cloud<kDim> balls = cloud<kDim>(5, 100, 4.0);
  for (std::size_t i = 0; i < 100; ++i) {
    const double where = i < 50 ? 1e8 : -1e15;
    balls.position.set(i, balls.position[i] + Vec<kDim>::Constant(where));
  }
  EXPECT_GT(expect_same_as_twin<TypeParam>(balls), 0U);
}

TYPED_TEST(BroadPhaseTwin, FindsSamePairs_AsBruteForce_CoincidentCentres) {
  constexpr int kDim = TypeParam::kDim;
  Cloud<kDim> balls = cloud<kDim>(6, 150, 1e6);
  for (std::size_t i = 0; i < 100; ++i) balls.position.set(i, balls.position[i < 50 ? 0 : 50]);
  EXPECT_GE(expect_same_as_twin<TypeParam>(balls), 2U * (50U * 49U / 2U));
}

TYPED_TEST(BroadPhaseTwin, FindsSamePairs_AsBruteForce_AllCentresTheSame) {
  constexpr int kDim = TypeParam::kDim;
  Cloud<kDim> balls = cloud<kDim>(7, 50, 1000.0);
  for (std::size_t i = 0; i < 50; ++i) balls.position.set(i, Vec<kDim>::Constant(0.3));
  EXPECT_EQ(expect_same_as_twin<TypeParam>(balls), 50U * 49U / 2U);
}

TYPED_TEST(BroadPhaseTwin, FindsSamePairs_AsBruteForce_AllOnALine) {
  constexpr int kDim = TypeParam::kDim;
  for (int line = 0; line <= kDim; ++line) {  // along each axis, and the diagonal
    SCOPED_TRACE(testing::Message() << "line " << line);
    const Vec<kDim> along = line < kDim ? Vec<kDim>(Vec<kDim>::Unit(line)) : Vec<kDim>(Vec<kDim>::Ones());
    Cloud<kDim> balls = cloud<kDim>(8, 400, 20.0);
    for (std::size_t i = 0; i < 400; ++i) balls.position.set(i, (static_cast<double>(i) * 0.25) * along);
    EXPECT_GT(expect_same_as_twin<TypeParam>(balls), 0U);
  }
}

/// Reaches that touch exactly, in numbers that doubles hold: |x_i - x_j| = bound_i + bound_j.
TYPED_TEST(BroadPhaseTwin, FindsSamePairs_AsBruteForce_ExactlyTouching) {
  constexpr int kDim = TypeParam::kDim;
  Cloud<kDim> balls{VectorColumn<kDim>(400), std::vector<float>(400, 0.5F)};
  for (std::size_t i = 0; i < 400; ++i) {
    const std::size_t row = i / 20;
    Vec<kDim> place = Vec<kDim>::Constant(1e6);
    place[0] += static_cast<double>(i % 20);
    place[kDim - 1] += static_cast<double>(row);
    balls.position.set(i, place);
  }
  EXPECT_EQ(expect_same_as_twin<TypeParam>(balls), 2U * 19U * 20U);
}

TYPED_TEST(BroadPhaseTwin, FindsSamePairs_AsBruteForce_OneGiantAmongThousandsOfDwarfs) {
  constexpr int kDim = TypeParam::kDim;
  Cloud<kDim> balls = cloud<kDim>(9, 3000, 1.0);
  std::fill(balls.bound.begin(), balls.bound.end(), 0.005F);
  balls.bound[1234] = 5.0F;
  EXPECT_GT(expect_same_as_twin<TypeParam>(balls), 100U);
}

/// One broad phase takes scene after scene, larger and smaller ones.
TYPED_TEST(BroadPhaseTwin, FindsSamePairs_AsBruteForce_WhenBuiltAgain) {
  constexpr int kDim = TypeParam::kDim;
  typename TypeParam::Type fast;
  BruteForce<kDim> twin;
  for (const std::size_t count : {100U, 300U, 0U, 1U, 200U}) {
    SCOPED_TRACE(testing::Message() << "balls " << count);
    const Cloud<kDim> balls = cloud<kDim>(10, count, 20.0);
    fast.build(balls.position, balls.bound);
    twin.build(balls.position, balls.bound);
    EXPECT_EQ(pairs_of(fast), pairs_of(twin));
  }
}

template <class CaseType>
class TreeCells : public testing::Test {};
using Trees = testing::Types<In<Tree, 2>, In<Tree, 3>>;
TYPED_TEST_SUITE(TreeCells, Trees);

TYPED_TEST(TreeCells, AreCubesInsideTheFirst_AndHoldEveryBallOnce) {
  constexpr int kDim = TypeParam::kDim;
  const Cloud<kDim> balls = cloud<kDim>(11, 1000, 1000.0);
  typename TypeParam::Type tree;
  tree.build(balls.position, balls.bound);
  // Corners are centre ± half width in coordinates of at most 8 m: a few roundings of that size.
  const double tolerance = 8.0 * kEpsilon * 8.0;
  std::size_t held = 0;
  std::vector<std::pair<Vec<kDim>, Vec<kDim>>> cells;
  tree.for_each_cell([&](const Vec<kDim>& low, const Vec<kDim>& high, std::size_t kept) {
    cells.emplace_back(low, high);
    held += kept;
    const Vec<kDim> sides = high - low;
    EXPECT_LE(sides.maxCoeff() - sides.minCoeff(), tolerance);
    EXPECT_GE((low - cells.front().first).minCoeff(), -tolerance);
    EXPECT_LE((high - cells.front().second).maxCoeff(), tolerance);
  });
  EXPECT_EQ(held, balls.bound.size());
  EXPECT_GT(cells.size(), kDim == 2 ? 100U : 50U);
}

template <class CaseType>
class BroadPhaseGrowth : public testing::Test {};
using Linear = testing::Types<In<UniformGrid, 2>, In<UniformGrid, 3>, In<Tree, 2>, In<Tree, 3>,
                              In<WrappedGrid, 2>, In<WrappedGrid, 3>>;
TYPED_TEST_SUITE(BroadPhaseGrowth, Linear);

/// Pair tests for equal balls that fill a tenth of a cube.
template <class Counted, int Dim>
double pair_tests(std::size_t count) {
  Cloud<Dim> balls{VectorColumn<Dim>(count), std::vector<float>(count, 0.5F)};
  const double volume = static_cast<double>(count) * (Dim == 2 ? 0.25 : 1.0 / 6.0) * std::numbers::pi;
  const double side = std::pow(10.0 * volume, 1.0 / Dim);
  Random random(count);
  for (std::size_t i = 0; i < count; ++i) {
    Vec<Dim> x;
    for (double& coordinate : x) coordinate = random.uniform(0.0, side);
    balls.position.set(i, x);
  }
  Counted broad_phase;
  broad_phase.build(balls.position, balls.bound);
  broad_phase.for_each_pair([](std::size_t, std::size_t) {});
  return static_cast<double>(broad_phase.count().pair_tests());
}

/// A number of tests per ball that does not grow makes the exponent 1. In a tree it goes up and down with the
/// filling of the last cells, which is the same again for 2^Dim times as many balls: such numbers are
/// compared.
///
/// What is allowed above 1 is the surface. A ball that looks for others as far as h along each axis misses a
/// quarter of them, averaged over the outermost h, at each of the 2 Dim faces of a cube with side L: a share
/// 2 Dim h / (4 L) of all tests. It is largest for the octree, with h = 4 m, the reach of 1 m and a cell of 3
/// m, the width that holds 5 balls: 35 % for 1000 balls, L = 17 m, and 17 % for 8000, which adds ln(0.83 /
/// 0.65) / ln 8 = 0.12. The rest is for the scatter of a cloud.
TYPED_TEST(BroadPhaseGrowth, PairTestsGrowAsBalls_FromAThousandToTwentyThousand) {
  constexpr int kDim = TypeParam::kDim;
  using Counted = typename TypeParam::Counted;
  const std::size_t times = kDim == 2 ? 4 * 4 : 8;
  for (std::size_t few = 1000; times * few <= 20000; few += 250) {
    const double growth = pair_tests<Counted, kDim>(times * few) / pair_tests<Counted, kDim>(few);
    const double exponent = std::log(growth) / std::log(static_cast<double>(times));
    EXPECT_LE(exponent, 1.15) << "from " << few << " to " << times * few << " balls";
  }
}

TEST(BruteForceGrowth, PairTestsAreAllPairs) {
  EXPECT_EQ((pair_tests<BruteForce<2, CountTests>, 2>(1000)), 1000.0 * 999.0 / 2.0);
  EXPECT_EQ((pair_tests<BruteForce<3, CountTests>, 3>(1000)), 1000.0 * 999.0 / 2.0);
}

class BroadPhaseTrajectory : public testing::TestWithParam<int> {};

TEST_P(BroadPhaseTrajectory, SameBits_WhateverTheBroadPhase) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ScenarioPtr scene = gas(GetParam(), 80, 0.25, 4.0, seed);
    const auto slow = compose(*scene, {"toi", "brute-force"});
    const auto fast = compose(*scene, {"toi", "uniform-grid"});
    const auto a = run(*slow, *scene, 40);
    const auto b = run(*fast, *scene, 40);
    EXPECT_GT(slow->tally().impacts, 50);
    EXPECT_EQ(slow->tally().impacts, fast->tally().impacts);
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].position, b[i].position);
      EXPECT_EQ(a[i].velocity, b[i].velocity);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, BroadPhaseTrajectory, testing::Values(2, 3));

}  // namespace
}  // namespace carom::test
