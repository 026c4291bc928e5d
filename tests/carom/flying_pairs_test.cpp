#include "carom/broad_phase/flying_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "carom/broad_phase/calendar.h"
#include "carom/broad_phase/listed_neighbours.h"
#include "core/random.h"

// What tells in which step a pair of balls is looked at. That no pair is looked at too late shows as well
// where evolvers run beside the twin that looks at all of them (pair_list_test.cpp).

namespace carom::test {
namespace {

/// Pairs a few radii apart that fly as it comes, looked at through many small steps of time.
TEST(Approach, IsNeverLaterThanTheTouch_NorMuchEarlier) {
  constexpr double kWithin_s = 4.0;
  constexpr int kSteps = 4000;
  Random random(5);
  int touching = 0;
  for (int pair = 0; pair < 1000; ++pair) {
    Vec<3> d;
    Vec<3> w;
    for (double& x : d) x = random.uniform(-2.0, 2.0);
    for (double& x : w) x = random.uniform(-1.5, 1.5);
    const Approach<3> approach(d, w, 1.0);
    const double due_s = approach.first_touch_s();
    int first = 0;
    while (first <= kSteps && (d + (first * kWithin_s / kSteps) * w).norm() > 1.0) ++first;
    SCOPED_TRACE(testing::Message() << "pair " << pair << " is due at " << due_s << " s");
    if (first > kSteps) {
      // Not seen to touch: it does not, or for less than a step of time.
      if (due_s < kWithin_s) {
        EXPECT_GE((d + due_s * w).norm(), 1.0 - 1e-14);
      }
      continue;
    }
    ++touching;
    EXPECT_TRUE(approach.may_touch_within(kWithin_s));
    EXPECT_LE(due_s, first * kWithin_s / kSteps);
    if (first > 0) {
      EXPECT_GT(due_s, (first - 1) * kWithin_s / kSteps);
    }
  }
  EXPECT_GT(touching, 100);
}

TEST(Approach, IsNever_WhereBallsPart) {
  EXPECT_EQ(Approach<2>({2.0, 0.0}, {1.0, 0.0}, 1.0).first_touch_s(), kNever);
  EXPECT_FALSE(Approach<2>({2.0, 0.0}, {1.0, 0.0}, 1.0).may_touch_within(1e9));
  EXPECT_EQ(Approach<2>({0.5, 0.0}, {1.0, 0.0}, 1.0).first_touch_s(), 0.0) << "they overlap";
}

/// Steps that end where days do, shorter ones, and longer ones.
TEST(Calendar, HandsOutEachPairOnce_InTheStepInWhichItIsDue) {
  constexpr double kDay_s = 0.1;
  constexpr double kEnd_s = 30.0;
  for (const double step_s : {kDay_s, 0.3 * kDay_s, 2.5 * kDay_s}) {
    SCOPED_TRACE(testing::Message() << "steps of " << step_s << " s");
    Random random(3);
    Calendar calendar;
    calendar.begin(kDay_s, kEnd_s);
    std::vector<double> due_s;
    for (std::uint32_t k = 0; k < 500; ++k) {
      due_s.push_back(random.uniform(0.0, kEnd_s));
      calendar.put({k, k + 1}, due_s.back());
    }
    std::vector<bool> taken(due_s.size(), false);
    double now_s = 0.0;
    while (now_s < kEnd_s) {
      now_s += step_s;
      std::vector<BallPair> due;
      calendar.take(now_s, due);
      for (const BallPair& pair : due) {
        EXPECT_FALSE(taken[pair.first]) << pair.first;
        taken[pair.first] = true;
        // No earlier than a day before, and no later than the step.
        EXPECT_LT(due_s[pair.first], now_s + kDay_s);
        EXPECT_GT(due_s[pair.first], now_s - step_s - 1e-12);
      }
      for (std::size_t k = 0; k < due_s.size(); ++k) {
        if (due_s[k] <= now_s) {
          ASSERT_TRUE(taken[k]) << "pair " << k << " at " << now_s << " s";
        }
      }
    }
  }
}

TEST(Calendar, HandsOutAtOnce_WhatIsOverdue) {
  Calendar calendar;
  calendar.begin(1.0, 10.0);
  std::vector<BallPair> due;
  calendar.take(5.0, due);
  EXPECT_TRUE(due.empty());
  calendar.put({1, 2}, 3.0);
  calendar.take(5.5, due);
  EXPECT_EQ(due, (std::vector<BallPair>{{1, 2}}));
}

TEST(ListedNeighbours, AreThoseOfThePairs_HoweverManyThreads) {
  constexpr std::uint32_t kBalls = 100;
  Random random(11);
  std::vector<BallPair> pairs;
  for (std::uint32_t b = 1; b < kBalls; ++b) {
    for (std::uint32_t a = 0; a < b; ++a) {
      if (random.uniform() < 0.1) pairs.emplace_back(a, b);
    }
  }
  for (const std::size_t count : {1U, 3U}) {
    const Threads threads(count);
    ListedNeighbours neighbours;
    const std::size_t later = pairs.size() / 4;
    neighbours.note(kBalls, std::span(pairs).subspan(later), threads);
    for (const auto& [a, b] : pairs) neighbours.add(a, b);  // most of them are noted
    for (std::uint32_t ball = 0; ball < kBalls; ++ball) {
      std::vector<std::uint32_t> expected;
      for (const auto& [a, b] : pairs) {
        if (a == ball) expected.push_back(b);
        if (b == ball) expected.push_back(a);
      }
      std::vector<std::uint32_t> found;
      neighbours.for_each(ball, [&](std::uint32_t other) { found.push_back(other); });
      std::sort(expected.begin(), expected.end());
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, expected) << "ball " << ball << ", " << count << " threads";
    }
  }
}

}  // namespace
}  // namespace carom::test
