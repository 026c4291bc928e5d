#include "scenario/place_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

/// A box with balls at random in it, a few of them fixed outside of it; some taken out and put in again.
struct Crowd {
  Crowd(Random& random, int axes, const Vec3& corner, const Vec3& sides, std::size_t count, double smallest,
        double largest)
      : dimension(axes), box{corner, corner + sides}, cells(box, axes, count, largest) {
    for (std::uint32_t i = 0; i < count; ++i) {
      balls.push_back({somewhere(random), random.uniform(smallest, largest)});
      cells.insert(i, balls);
    }
    for (std::uint32_t i = 0; i < count; i += 3) {
      cells.remove(i, balls);
      balls[i].position = somewhere(random);
      balls[i].size *= 0.5;
      cells.insert(i, balls);
    }
  }

  /// Mostly in the box, now and then beside it.
  Vec3 somewhere(Random& random) const {
    Vec3 at = box.min;
    for (int axis = 0; axis < dimension; ++axis) {
      at[axis] += random.uniform(-0.05, 1.05) * (box.max[axis] - box.min[axis]);
    }
    return at;
  }

  Vec3 inside(Random& random) const { return somewhere(random).cwiseMax(box.min).cwiseMin(box.max); }

  bool holds(std::uint32_t ball) const {
    const Vec3& at = balls[ball].position;
    return (at.array() >= box.min.array()).all() && (at.array() <= box.max.array()).all();
  }

  int dimension;
  Box box;
  Column<Placed> balls;
  Cells cells;
};

constexpr double kLargest = 0.3;

/// Boxes near and far from zero, wide, full, flat and thin, with balls of one size and of sizes mixed 1:30,
/// in metres and in a unit whose square single precision does not know.
std::vector<Crowd> crowds(Random& random, double unit_m) {
  std::vector<Crowd> all;
  for (const Vec3& sides :
       {Vec3(10.0, 10.0, 10.0), Vec3(3.0, 3.0, 3.0), Vec3(40.0, 30.0, 0.5), Vec3(300.0, 0.5, 0.6)}) {
    for (const Vec3& corner : {Vec3(Vec3::Zero()), Vec3(-3e4, 1e5, 7e3)}) {
      for (const double smallest : {0.25, 0.01}) {
        for (const int dimension : {2, 3}) {
          const Vec3 from = dimension == 2 ? Vec3(corner.x(), corner.y(), 0.0) : corner;
          const Vec3 along = dimension == 2 ? Vec3(sides.x(), sides.y(), 0.0) : sides;
          all.emplace_back(random, dimension, unit_m * from, unit_m * along, 300, unit_m * smallest,
                           unit_m * kLargest);
        }
      }
    }
  }
  return all;
}

class CellsOf : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Units, CellsOf, testing::Values(1.0, 1e-24));

TEST_P(CellsOf, NearVisitsAllThatALookAtEveryBallFinds_OrEndsAtOneThatOverlaps) {
  Random random(31);
  int through = 0;
  int ended = 0;
  for (Crowd& crowd : crowds(random, GetParam())) {
    const auto count = static_cast<std::uint32_t>(crowd.balls.size());
    for (std::uint32_t ball = 0; ball < count; ball += 2) {
      const double size = crowd.balls[ball].size;
      const double room = GetParam() * std::min(kLargest, random.uniform(0.0, 1.2 * kLargest));
      const Cells::Spot spot = crowd.cells.spot(crowd.inside(random), room);
      crowd.cells.remove(ball, crowd.balls);
      std::set<std::uint32_t> visited;
      const bool all = crowd.cells.near(spot, size, room, [&](std::uint32_t other) {
        visited.insert(other);
        return true;
      });
      crowd.cells.insert(ball, crowd.balls);
      EXPECT_EQ(visited.count(ball), 0U);
      bool overlaps = false;
      for (std::uint32_t other = 0; other < count; ++other) {
        if (other == ball) continue;
        const double far = (crowd.balls[other].position - spot.at).norm();
        overlaps = overlaps || far < size + crowd.balls[other].size;
        const bool within = far - crowd.balls[other].size <= room;
        EXPECT_TRUE(!all || !within || visited.count(other) == 1) << other;
      }
      EXPECT_TRUE(all || overlaps);
      ++(all ? through : ended);
    }
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(through, 100);
  EXPECT_GT(ended, 100);
}

TEST_P(CellsOf, AroundVisitsWhoALookAtEveryBallInTheBoxFinds) {
  Random random(32);
  std::size_t found = 0;
  for (const Crowd& crowd : crowds(random, GetParam())) {
    for (int trial = 0; trial < 20; ++trial) {
      const double width = GetParam() * random.uniform(0.5, 3.0);
      const Grid other(crowd.box, crowd.dimension, width, trial % 2 == 0 ? 64.0 : 5.0);
      const Vec3 at = crowd.somewhere(random);
      std::multiset<std::uint32_t> visited;
      crowd.cells.around(at, other, crowd.balls, [&](std::uint32_t ball) {
        EXPECT_TRUE(other.beside(other.place(at), crowd.balls[ball].position));
        if (crowd.holds(ball)) visited.insert(ball);
      });
      std::multiset<std::uint32_t> beside;
      for (std::uint32_t ball = 0; ball < crowd.balls.size(); ++ball) {
        if (crowd.holds(ball) && other.beside(other.place(at), crowd.balls[ball].position))
          beside.insert(ball);
      }
      EXPECT_EQ(visited, beside);
      found += beside.size();
    }
  }
  EXPECT_GT(found, 1000U);
}

}  // namespace
}  // namespace carom::test
