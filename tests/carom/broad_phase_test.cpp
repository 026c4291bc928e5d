#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "carom/broad_phase/brute_force.h"
#include "carom/broad_phase/uniform_grid.h"
#include "carom/compose.h"
#include "carom/laws/frictionless.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

/// A broad phase under test, in a dimension; its twin is BruteForce.
template <int Dimension, template <int> class BroadPhase>
struct Case {
  static constexpr int kDim = Dimension;
  using Type = BroadPhase<Dimension>;
};

template <class CaseType>
class BroadPhaseTwin : public testing::Test {};
using Cases = testing::Types<Case<2, UniformGrid>, Case<3, UniformGrid>>;
TYPED_TEST_SUITE(BroadPhaseTwin, Cases);

template <int Dim>
struct Cloud {
  VectorColumn<Dim> position;
  std::vector<double> bound;
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
    result.bound.push_back(0.5 / (1.0 + draw * (ratio - 1.0)));
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

template <class BroadPhase>
std::set<std::size_t> near(const BroadPhase& broad_phase, std::size_t ball) {
  std::set<std::size_t> found;
  broad_phase.for_each_near(ball, [&](std::size_t j) { EXPECT_TRUE(found.insert(j).second); });
  return found;
}

TYPED_TEST(BroadPhaseTwin, FindsSamePairs_AsBruteForce_AnySizeSpread) {
  constexpr int kDim = TypeParam::kDim;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const double ratio : {1.0, 20.0, 1000.0, 1e12}) {
      for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{200}}) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", ratio " << ratio << ", balls " << count);
        const Cloud<kDim> balls = cloud<kDim>(seed, count, ratio);
        typename TypeParam::Type fast;
        BruteForce<kDim> twin;
        fast.build(balls.position, balls.bound);
        twin.build(balls.position, balls.bound);
        EXPECT_EQ(pairs_of(fast), pairs_of(twin));
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
      balls.bound[ball] *= ball % 2 == 0 ? 3.0 : 40.0;
      fast.bound_grew(ball);
      EXPECT_EQ(near(fast, ball), near(twin, ball));
      EXPECT_EQ(near(fast, ball + 1), near(twin, ball + 1));
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
  typename TypeParam::Type fast;
  BruteForce<kDim> twin;
  fast.build(balls.position, balls.bound);
  twin.build(balls.position, balls.bound);
  EXPECT_EQ(pairs_of(fast), pairs_of(twin));
}

class BroadPhaseTrajectory : public testing::TestWithParam<int> {};

TEST_P(BroadPhaseTrajectory, SameBits_WhateverTheBroadPhase) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ScenarioPtr scene = gas(GetParam(), 80, 0.25, 4.0, seed);
    const auto slow = compose<Frictionless>(*scene, BroadPhaseChoice::brute_force);
    const auto fast = compose<Frictionless>(*scene, BroadPhaseChoice::uniform_grid);
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
