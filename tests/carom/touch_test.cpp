#include "carom/evolvers/touch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "carom/evolvers/touch_clusters.h"
#include "core/random.h"
#include "scenario/scenario.h"
#include "tests/support/numbers.h"

// How the contacts of a step are told apart, held against a look at every two of them.

namespace carom::test {
namespace {

constexpr std::uint32_t kBalls = 30;
constexpr std::uint32_t kPlanes = 4;

std::uint32_t below(Random& random, std::uint32_t count) {
  return static_cast<std::uint32_t>(random.uniform() * count);
}

/// So few that some balls have none, some one, and some more of them; in the order of what they rank.
std::vector<Touch> random_contacts(Random& random) {
  std::set<Touch> contacts;
  const std::uint32_t count = below(random, kBalls / 2);
  while (contacts.size() < count) {
    const std::uint32_t a = below(random, kBalls);
    const std::uint32_t b = below(random, kBalls);
    if (a < b) contacts.insert(Touch::of_balls(a, b, a, b));
    if (a > b) contacts.insert(Touch::of_plane(a, b % kPlanes, a));
  }
  return {contacts.begin(), contacts.end()};
}

bool has(const Touch& touch, std::uint32_t ball) {
  return touch.a == ball || (!touch.plane() && touch.b == ball);
}

TEST(Touch, RanksPairsByTheirBalls_BeforePlanes) {
  const std::vector<Touch> in_order = {Touch::of_balls(7, 8, 0, 1), Touch::of_balls(5, 6, 0, 2),
                                       Touch::of_balls(3, 4, 1, 2), Touch::of_balls(1, 2, 0x7fffffff, 0),
                                       Touch::of_plane(9, 0, 0),    Touch::of_plane(2, 0, 5),
                                       Touch::of_plane(1, 3, 1)};
  EXPECT_TRUE(std::is_sorted(in_order.begin(), in_order.end()));
  for (std::size_t k = 0; k < in_order.size(); ++k) {
    EXPECT_EQ(in_order[k].plane(), k >= 4) << "contact " << k;
    EXPECT_EQ(std::count(in_order.begin(), in_order.end(), in_order[k]), 1) << "contact " << k;
  }
}

TEST(TouchedBalls, AreNotedOnce_AndAContactIsIsolatedWhereItSharesNone) {
  Random random(1);
  TouchedBalls touched(kBalls);
  int isolated = 0;
  int shared = 0;
  for (int step = 0; step < 300; ++step) {
    SCOPED_TRACE(testing::Message() << "step " << step);
    const std::vector<Touch> contacts = random_contacts(random);
    touched.note(contacts);
    std::set<std::uint32_t> expected;
    for (std::uint32_t ball = 0; ball < kBalls; ++ball) {
      if (std::any_of(contacts.begin(), contacts.end(), [&](const Touch& each) { return has(each, ball); })) {
        expected.insert(ball);
      }
    }
    EXPECT_EQ(touched.balls().size(), expected.size());
    EXPECT_EQ(std::set<std::uint32_t>(touched.balls().begin(), touched.balls().end()), expected);
    for (const Touch& touch : contacts) {
      const auto shares = [&](const Touch& other) {
        return !(other == touch) && (has(other, touch.a) || (!touch.plane() && has(other, touch.b)));
      };
      const bool alone = std::none_of(contacts.begin(), contacts.end(), shares);
      EXPECT_EQ(touched.is_isolated(touch), alone) << touch.a << ", " << touch.b;
      ++(alone ? isolated : shared);
    }
  }
  EXPECT_GT(isolated, 300);
  EXPECT_GT(shared, 300);
}

// --- clusters

/// Every fifth ball is immovable.
World<2> some_balls() {
  std::vector<Ball> balls(kBalls);
  for (std::uint32_t i = 0; i < kBalls; ++i) balls[i].mass = i % 5 == 0 ? kInfinity : 1.0;
  return World<2>(balls);
}

/// The number of each contact's cluster: all of one, and then whatever two that share a movable ball have is
/// made the same, until nothing changes.
std::vector<std::size_t> clusters_of(const World<2>& world, const std::vector<Touch>& contacts) {
  std::vector<std::size_t> cluster(contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k) cluster[k] = k;
  const auto hang_together = [&](const Touch& one, const Touch& other) {
    for (std::uint32_t ball = 0; ball < kBalls; ++ball) {
      if (world.inverse_mass[ball] > 0.0 && has(one, ball) && has(other, ball)) return true;
    }
    return false;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (cluster[l] <= cluster[k] || !hang_together(contacts[k], contacts[l])) continue;
        cluster[l] = cluster[k];
        changed = true;
      }
    }
  }
  return cluster;
}

TEST(TouchClusters, AreWhatHangsTogetherByMovableBalls_EachInTheOrderOfItsContacts) {
  Random random(2);
  const World<2> world = some_balls();
  TouchClusters<2> clusters;
  int larger = 0;
  for (int step = 0; step < 300; ++step) {
    SCOPED_TRACE(testing::Message() << "step " << step);
    std::vector<Touch> contacts = random_contacts(random);
    // The evolver has no contact of balls none of which can move.
    std::erase_if(contacts, [&](const Touch& touch) {
      return world.inverse_mass[touch.a] + (touch.plane() ? 0.0 : world.inverse_mass[touch.b]) == 0.0;
    });
    const std::vector<std::size_t> cluster = clusters_of(world, contacts);
    std::set<std::vector<std::uint64_t>> expected;
    for (std::size_t first = 0; first < contacts.size(); ++first) {
      std::vector<std::uint64_t> ranks;
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        if (cluster[k] == first) ranks.push_back(contacts[k].rank);
      }
      if (!ranks.empty()) expected.insert(ranks);
    }
    std::set<std::vector<std::uint64_t>> found;
    clusters.for_each(world, contacts, [&](std::span<const Touch> together) {
      std::vector<std::uint64_t> ranks;
      for (const Touch& touch : together) ranks.push_back(touch.rank);
      found.insert(ranks);
      if (ranks.size() > 1) ++larger;
    });
    EXPECT_EQ(found, expected);
  }
  EXPECT_GT(larger, 100);
}

}  // namespace
}  // namespace carom::test
