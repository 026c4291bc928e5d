#include "carom/laws/cluster_law.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "carom/laws/complementarity.h"
#include "carom/laws/frictionless.h"
#include "carom/laws/generalized_reflections.h"
#include "carom/laws/simultaneous.h"
#include "core/random.h"

namespace carom::test {
namespace {

/// Of each test: 12 000 clusters in all.
constexpr int kTrials = 300;

template <int Dim>
struct Cluster {
  std::vector<Ball> balls;
  std::vector<Wall> walls;
  std::vector<ClosedContact<Dim>> contacts;
};

template <int Dim>
Vec<Dim> random_vector(Random& random) {
  Vec<Dim> v;
  for (int axis = 0; axis < Dim; ++axis) v[axis] = random.normal();
  return v;
}

/// Gaps this small are closed, m; radii are about 1 m, and places are known to some ε.
constexpr double kClosed_m = 1e-12;

double gap(const Ball& a, const Ball& b) {
  return (b.position - a.position).norm() - a.radius - b.radius;
}

double gap(const Ball& ball, const Wall& wall) {
  return wall.normal.dot(ball.position) - wall.offset - ball.radius;
}

/// The closed contacts by (a, wall, b), as a law gets them. The restitutions are the caller's.
template <int Dim>
std::vector<ClosedContact<Dim>> closed_contacts(const std::vector<Ball>& balls,
                                                const std::vector<Wall>& walls) {
  std::vector<ClosedContact<Dim>> contacts;
  for (std::uint32_t a = 0; a < balls.size(); ++a) {
    for (std::uint32_t b = a + 1; b < balls.size(); ++b) {
      if (gap(balls[a], balls[b]) > kClosed_m) continue;
      const Vec3 normal = (balls[b].position - balls[a].position).normalized();
      contacts.push_back({a, b, false, flattened<Dim>(normal), 1.0, 0.0});
    }
    for (std::uint32_t w = 0; w < walls.size(); ++w) {
      if (gap(balls[a], walls[w]) <= kClosed_m) {
        contacts.push_back({a, w, true, flattened<Dim>(walls[w].normal), 1.0, 0.0});
      }
    }
  }
  return contacts;
}

/// Puts a ball where it touches two others, if there is such a place: triangles, which close loops of
/// contacts.
template <int Dim>
bool nestle(Ball& ball, const Ball& a, const Ball& b, Random& random) {
  const double to_a = a.radius + ball.radius;
  const double to_b = b.radius + ball.radius;
  const double apart = (b.position - a.position).norm();
  const Vec3 along = (b.position - a.position) / apart;
  const double foot = (apart * apart + to_a * to_a - to_b * to_b) / (2.0 * apart);
  if (apart == 0.0 || std::abs(foot) >= to_a) return false;
  Vec3 across = widened<Dim>(random_vector<Dim>(random));
  across = (across - along.dot(across) * along).normalized();
  ball.position = a.position + foot * along + std::sqrt(to_a * to_a - foot * foot) * across;
  return true;
}

/// 2 to 12 balls that hang together, grown one by one: each touches one or two earlier ones or a wall, and
/// overlaps nothing. The first stands in a corner of one or two walls, or is free. Some are at rest together.
template <int Dim>
Cluster<Dim> random_cluster(Random& random) {
  Cluster<Dim> cluster;
  const auto wall_count = static_cast<int>(random.uniform(0.0, 3.0));
  for (int axis = 0; axis < wall_count; ++axis) cluster.walls.push_back({Vec3::Unit(axis), 0.0});
  const auto count = static_cast<std::size_t>(random.uniform(2.0, 13.0));
  const Vec3 common = widened<Dim>(random_vector<Dim>(random));
  while (cluster.balls.size() < count) {
    Ball ball;
    ball.radius = random.uniform(0.5, 1.0);
    ball.mass = std::pow(10.0, random.uniform(-1.0, 1.0));
    if (cluster.balls.empty()) {
      ball.position = ball.radius * widened<Dim>(Vec<Dim>::Ones());
    } else {
      const auto pick = [&]() -> const Ball& {
        return cluster
            .balls[static_cast<std::size_t>(random.uniform() * static_cast<double>(cluster.balls.size()))];
      };
      const Ball& a = pick();
      const Ball& b = pick();
      const bool nestled = random.uniform() < 0.7 && nestle<Dim>(ball, a, b, random);
      if (!nestled) {
        const Vec3 direction = widened<Dim>(random_vector<Dim>(random).normalized());
        ball.position = a.position + (a.radius + ball.radius) * direction;
      }
    }
    const bool fits = std::all_of(cluster.balls.begin(), cluster.balls.end(),
                                  [&](const Ball& other) { return gap(ball, other) > -kClosed_m; }) &&
                      std::all_of(cluster.walls.begin(), cluster.walls.end(),
                                  [&](const Wall& wall) { return gap(ball, wall) > -kClosed_m; });
    if (!fits) continue;
    ball.velocity = random.uniform() < 0.5 ? common : widened<Dim>(random_vector<Dim>(random));
    cluster.balls.push_back(ball);
  }
  cluster.contacts = closed_contacts<Dim>(cluster.balls, cluster.walls);
  return cluster;
}

template <int Dim>
void set_restitution(Cluster<Dim>& cluster, double restitution) {
  for (ClosedContact<Dim>& contact : cluster.contacts) contact.restitution = restitution;
}

template <int Dim>
double opening(const World<Dim>& world, const ClosedContact<Dim>& contact) {
  return contact.normal.dot(contact.wall ? world.velocity[contact.a]
                                         : Vec<Dim>(world.velocity[contact.b] - world.velocity[contact.a]));
}

template <int Dim>
double energy(const std::vector<Ball>& balls, const World<Dim>& world) {
  double sum = 0.0;
  for (std::size_t i = 0; i < balls.size(); ++i) sum += 0.5 * balls[i].mass * world.velocity[i].squaredNorm();
  return sum;
}

/// All that an opening velocity has been made of, m/s: two velocities of the fastest ball's size, and the sum
/// of what was added to balls.
template <int Dim>
double changes(const Cluster<Dim>& before, const std::vector<ClosedContact<Dim>>& after) {
  double sum = 0.0;
  for (const Ball& ball : before.balls) sum = std::max(sum, 2.0 * ball.velocity.norm());
  for (const ClosedContact<Dim>& contact : after) {
    sum += contact.impulse / before.balls[contact.a].mass;
    if (!contact.wall) sum += contact.impulse / before.balls[contact.b].mass;
  }
  return sum;
}

template <template <int> class LawType, int kDimension>
struct Case {
  using Law = LawType<kDimension>;
  static constexpr int kDim = kDimension;
};

template <class C>
class ClusterLawTest : public ::testing::Test {
 protected:
  static constexpr int kDim = C::kDim;
  using Contacts = std::vector<ClosedContact<kDim>>;

  /// Calls check(cluster) for many clusters; a failure names the cluster.
  template <class Check>
  static void for_random_clusters(std::uint64_t seed, Check check) {
    Random random(seed);
    for (int trial = 0; trial < kTrials; ++trial) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", trial " + std::to_string(trial));
      check(random_cluster<kDim>(random), random);
      if (::testing::Test::HasFailure()) return;
    }
  }

  struct Outcome {
    World<kDim> world;
    Contacts contacts;
  };

  static Outcome resolved(const Cluster<kDim>& cluster) {
    Outcome outcome{World<kDim>(cluster.balls), cluster.contacts};
    typename C::Law().resolve(outcome.world, outcome.contacts);
    return outcome;
  }
};

using Cases = ::testing::Types<Case<Simultaneous, 2>, Case<Simultaneous, 3>, Case<GeneralizedReflections, 2>,
                               Case<GeneralizedReflections, 3>>;
TYPED_TEST_SUITE(ClusterLawTest, Cases);

/// Between different runs of a law on what is the same cluster but for rounding. In the metric of the masses
/// no round makes a difference larger, as reflections and projections are not expanding; back in speeds that
/// is √(m_max/m_min) <= 10. Each round adds its own roundings, of which changes() is the sum: 16 ε per dozen
/// contacts of each of two runs.
double symmetry_error(double changes_mps) {
  return 10.0 * 2.0 * 16.0 * kEpsilon * changes_mps;
}

TYPED_TEST(ClusterLawTest, ConservesMomentum_WithWallImpulses) {
  this->for_random_clusters(1, [](auto cluster, Random& random) {
    set_restitution(cluster, random.uniform());
    const auto after = TestFixture::resolved(cluster);
    Vec<TypeParam::kDim> momentum = Vec<TypeParam::kDim>::Zero();
    double scale = 0.0;
    for (std::size_t i = 0; i < cluster.balls.size(); ++i) {
      const auto start = flattened<TypeParam::kDim>(cluster.balls[i].velocity);
      momentum += cluster.balls[i].mass * (after.world.velocity[i] - start);
      scale += cluster.balls[i].mass * start.norm();
    }
    for (const auto& contact : after.contacts) {
      if (contact.wall) momentum -= contact.impulse * contact.normal;
      scale += 2.0 * contact.impulse;
    }
    // Velocities are rounded at each of about a dozen changes, ε/2 of what they are then.
    EXPECT_LE(momentum.norm(), 16.0 * kEpsilon * scale);
  });
}

TYPED_TEST(ClusterLawTest, PushesOnly_AndLeavesNothingApproaching) {
  this->for_random_clusters(2, [](auto cluster, Random& random) {
    for (auto& contact : cluster.contacts) contact.restitution = random.uniform();
    const auto after = TestFixture::resolved(cluster);
    // Sixteen roundings of what the velocities have been made of.
    const double error = 16.0 * kEpsilon * changes(cluster, after.contacts);
    for (const auto& contact : after.contacts) {
      EXPECT_GE(contact.impulse, 0.0);
      EXPECT_GE(opening(after.world, contact), -error) << contact.a << " and " << contact.b;
    }
  });
}

TYPED_TEST(ClusterLawTest, NeverGainsEnergy_WhateverTheRestitutions) {
  this->for_random_clusters(3, [](auto cluster, Random& random) {
    for (auto& contact : cluster.contacts)
      contact.restitution = random.uniform() < 0.3 ? 1.0 : random.uniform();
    const double before = energy(cluster.balls, World<TypeParam::kDim>(cluster.balls));
    const auto after = TestFixture::resolved(cluster);
    // A dozen rounded squares and sums, and a velocity off by δ changes the energy by m v δ.
    EXPECT_LE(energy(cluster.balls, after.world), before * (1.0 + 32.0 * kEpsilon));
  });
}

TYPED_TEST(ClusterLawTest, KeepsTheEnergy_WhereAllIsElastic) {
  this->for_random_clusters(4, [](const auto& cluster, Random&) {
    const double before = energy(cluster.balls, World<TypeParam::kDim>(cluster.balls));
    const auto after = TestFixture::resolved(cluster);
    // A velocity off by δ changes the energy by m v δ <= 2 √(2 m E) δ/√2 for each of the balls, the heaviest
    // of 10 kg.
    const double off = 16.0 * kEpsilon * changes(cluster, after.contacts);
    const double error = off * std::sqrt(2.0 * 10.0 * before) * static_cast<double>(cluster.balls.size());
    EXPECT_NEAR(energy(cluster.balls, after.world), before, error + 32.0 * kEpsilon * before);
  });
}

TYPED_TEST(ClusterLawTest, MirroredCluster_DoesTheMirroredThing) {
  this->for_random_clusters(5, [](auto cluster, Random& random) {
    set_restitution(cluster, random.uniform());
    const auto across = random_vector<TypeParam::kDim>(random).normalized().eval();
    const auto mirrored = [&across](const Vec<TypeParam::kDim>& v) -> Vec<TypeParam::kDim> {
      return v - 2.0 * across.dot(v) * across;
    };
    auto image = cluster;
    for (Ball& ball : image.balls) {
      ball.velocity = widened<TypeParam::kDim>(mirrored(flattened<TypeParam::kDim>(ball.velocity)));
    }
    for (auto& contact : image.contacts) contact.normal = mirrored(contact.normal);
    const auto here = TestFixture::resolved(cluster);
    const auto there = TestFixture::resolved(image);
    const double error = symmetry_error(changes(cluster, here.contacts));
    for (std::size_t i = 0; i < cluster.balls.size(); ++i) {
      EXPECT_LE((there.world.velocity[i] - mirrored(here.world.velocity[i])).norm(), error) << "ball " << i;
    }
  });
}

TYPED_TEST(ClusterLawTest, RenumberedBalls_DoTheSame) {
  this->for_random_clusters(6, [](auto cluster, Random& random) {
    set_restitution(cluster, random.uniform());
    auto image = cluster;
    std::reverse(image.balls.begin(), image.balls.end());
    image.contacts = closed_contacts<TypeParam::kDim>(image.balls, image.walls);
    set_restitution(image, cluster.contacts.front().restitution);
    const auto here = TestFixture::resolved(cluster);
    const auto there = TestFixture::resolved(image);
    const double error = symmetry_error(changes(cluster, here.contacts));
    const std::size_t last = cluster.balls.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      EXPECT_LE((there.world.velocity[last - i] - here.world.velocity[i]).norm(), error) << "ball " << i;
    }
  });
}

TYPED_TEST(ClusterLawTest, OrderOfContacts_DoesNotMatter) {
  this->for_random_clusters(7, [](auto cluster, Random& random) {
    for (auto& contact : cluster.contacts) contact.restitution = random.uniform();
    auto shuffled = cluster;
    for (std::size_t k = shuffled.contacts.size(); k > 1; --k) {
      const auto other = static_cast<std::size_t>(random.uniform() * static_cast<double>(k));
      std::swap(shuffled.contacts[k - 1], shuffled.contacts[other]);
    }
    const auto here = TestFixture::resolved(cluster);
    const auto there = TestFixture::resolved(shuffled);
    const double error = symmetry_error(changes(cluster, here.contacts));
    for (std::size_t i = 0; i < cluster.balls.size(); ++i) {
      EXPECT_LE((there.world.velocity[i] - here.world.velocity[i]).norm(), error) << "ball " << i;
    }
  });
}

TYPED_TEST(ClusterLawTest, SameCluster_GivesTheSameBits) {
  this->for_random_clusters(8, [](const auto& cluster, Random&) {
    const auto once = TestFixture::resolved(cluster);
    const auto again = TestFixture::resolved(cluster);
    for (std::size_t i = 0; i < cluster.balls.size(); ++i) {
      EXPECT_EQ(once.world.velocity[i], again.world.velocity[i]);
    }
  });
}

TYPED_TEST(ClusterLawTest, SingleContact_ObeysNewtonsRestitution) {
  this->for_random_clusters(9, [](auto cluster, Random& random) {
    cluster.contacts.resize(1);
    set_restitution(cluster, random.uniform());
    const double before = opening(World<TypeParam::kDim>(cluster.balls), cluster.contacts[0]);
    const auto after = TestFixture::resolved(cluster);
    const double expected = before < 0.0 ? -cluster.contacts[0].restitution * before : before;
    EXPECT_NEAR(opening(after.world, after.contacts[0]), expected,
                16.0 * kEpsilon * changes(cluster, after.contacts));
  });
}

TYPED_TEST(ClusterLawTest, WedgedBall_ComesToRestAgainstBothWalls) {
  constexpr int kDim = TypeParam::kDim;
  Ball ball;
  ball.velocity = Vec3(1.0, 2.0, 0.0);
  World<kDim> world({ball});
  std::vector<ClosedContact<kDim>> contacts = {{0, 0, true, Vec<kDim>::UnitX(), 1.0, 0.0},
                                               {0, 1, true, -Vec<kDim>::UnitX(), 1.0, 0.0}};
  typename TypeParam::Law().resolve(world, contacts);
  EXPECT_NEAR(world.velocity[0][0], 0.0, kEpsilon);
  EXPECT_EQ(world.velocity[0][1], 2.0);
}

TYPED_TEST(ClusterLawTest, ImmovableBall_StaysAndTurnsTheOthersRound) {
  constexpr int kDim = TypeParam::kDim;
  std::vector<Ball> balls(3);
  balls[1].mass = std::numeric_limits<double>::infinity();
  balls[0].velocity = Vec3(1.0, 0.0, 0.0);
  balls[2].velocity = Vec3(-3.0, 1.0, 0.0);
  World<kDim> world(balls);
  std::vector<ClosedContact<kDim>> contacts = {{0, 1, false, Vec<kDim>::UnitX(), 0.5, 0.0},
                                               {1, 2, false, Vec<kDim>::UnitX(), 1.0, 0.0}};
  typename TypeParam::Law().resolve(world, contacts);
  EXPECT_EQ(world.velocity[0][0], -0.5);
  EXPECT_EQ(world.velocity[1], Vec<kDim>(Vec<kDim>::Zero()));
  EXPECT_EQ(world.velocity[2][0], 3.0);
  EXPECT_EQ(world.velocity[2][1], 1.0);
}

// --- known answers

/// Touching balls in a row along x, and their contacts.
struct Row {
  World<2> world;
  std::vector<ClosedContact<2>> contacts;
};

Row row_of(const std::vector<double>& speeds_mps, double restitution = 1.0) {
  std::vector<Ball> balls(speeds_mps.size());
  std::vector<ClosedContact<2>> contacts;
  for (std::uint32_t i = 0; i < balls.size(); ++i) {
    balls[i].velocity[0] = speeds_mps[i];
    if (i > 0) contacts.push_back({i - 1, i, false, Vec<2>::UnitX(), restitution, 0.0});
  }
  return {World<2>(balls), contacts};
}

std::vector<double> speeds_along_x(const World<2>& world) {
  std::vector<double> speeds;
  for (std::size_t i = 0; i < world.size(); ++i) speeds.push_back(world.velocity[i].x());
  return speeds;
}

template <template <int> class Law>
std::vector<double> speeds_after(Row row) {
  Law<2>().resolve(row.world, row.contacts);
  return speeds_along_x(row.world);
}

/// @param error_mps  by default some roundings of speeds of 1 m/s
void expect_near(const std::vector<double>& found, const std::vector<double>& expected,
                 double error_mps = 16.0 * kEpsilon) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], expected[i], error_mps) << "ball " << i;
  }
}

TEST(SimultaneousLaw, FiveTouching_FlyBackAndOnTogether) {
  expect_near(speeds_after<Simultaneous>(row_of({1.0, 0.0, 0.0, 0.0, 0.0})), {-0.6, 0.4, 0.4, 0.4, 0.4});
}

TEST(GeneralizedReflectionsLaw, FiveTouching_OnlyTheLastLeaves) {
  expect_near(speeds_after<GeneralizedReflections>(row_of({1.0, 0.0, 0.0, 0.0, 0.0})),
              {0.0, 0.0, 0.0, 0.0, 1.0});
}

TEST(GeneralizedReflectionsLaw, TwoIntoFive_TwoLeave) {
  expect_near(speeds_after<GeneralizedReflections>(row_of({1.0, 1.0, 0.0, 0.0, 0.0})),
              {0.0, 0.0, 0.0, 1.0, 1.0});
}

TEST(ClusterLaws, BothEndsIntoThree_ThrowBothBack) {
  expect_near(speeds_after<GeneralizedReflections>(row_of({1.0, 0.0, -1.0})), {-1.0, 0.0, 1.0});
  expect_near(speeds_after<Simultaneous>(row_of({1.0, 0.0, -1.0})), {-1.0, 0.0, 1.0});
}

TEST(ClusterLaws, Inelastic_RowsMoveOnAsOne) {
  const std::vector<double> together(5, 0.2);
  expect_near(speeds_after<Simultaneous>(row_of({1.0, 0.0, 0.0, 0.0, 0.0}, 0.0)), together);
  // Here by ever smaller impacts: each of four contacts may be left approaching by sixteen roundings of what
  // its velocities were made of, 2 m/s.
  expect_near(speeds_after<GeneralizedReflections>(row_of({1.0, 0.0, 0.0, 0.0, 0.0}, 0.0)), together,
              4.0 * 16.0 * kEpsilon * 2.0);
}

TEST(PairByPair, BothEndsIntoThree_IsNotSymmetric) {
  // What the other laws are for: equal balls from both sides, and the middle one's fate is the order's. With
  // e = ½ the pair that goes first leaves the other one a different impact.
  Row row = row_of({1.0, 0.0, -1.0}, 0.5);
  const Contact surface{0.5, 0.0, 0.0};
  for (bool approaching = true; approaching;) {
    approaching = false;
    for (const ClosedContact<2>& contact : row.contacts) {
      if (opening(row.world, contact) > -16.0 * kEpsilon) continue;
      Frictionless::between<2>(row.world, contact.a, contact.b, contact.normal, surface);
      approaching = true;
    }
  }
  expect_near(speeds_along_x(row.world), {-23.0 / 64.0, 3.0 / 64.0, 20.0 / 64.0});
  expect_near(speeds_after<GeneralizedReflections>(row_of({1.0, 0.0, -1.0}, 0.5)), {-0.5, 0.0, 0.5});
  expect_near(speeds_after<Simultaneous>(row_of({1.0, 0.0, -1.0}, 0.5)), {-0.5, 0.0, 0.5});
}

TEST(SimultaneousLaw, LongRow_IsSolvedToRounding) {
  // Of N touching balls hit by their own kind at v the first leaves at (2/N - 1) v and the others at 2/N v.
  for (const std::size_t count : {std::size_t{20}, std::size_t{33}, std::size_t{34}, std::size_t{150}}) {
    std::vector<double> speeds(count, 0.0);
    speeds[0] = 1.0;
    const double share = 2.0 / static_cast<double>(count);
    const std::vector<double> found = speeds_after<Simultaneous>(row_of(speeds));
    // The impulses are a solution of N equations whose matrix has the condition (2 N/π)², but errors of the
    // impulses along its soft directions do not move the balls: a rounding for each ball is left.
    const double error = 4.0 * kEpsilon * static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_NEAR(found[i], i == 0 ? share - 1.0 : share, error);
  }
}

TEST(Complementarity, PivotingAndSweeps_FindTheSameMotion) {
  Random random(10);
  for (int trial = 0; trial < 500; ++trial) {
    SCOPED_TRACE("seed 10, trial " + std::to_string(trial));
    // Random normals, some more than can be independent: redundant contacts. A motion y that closes all of
    // them can be turned round, so there is a solution.
    const Eigen::Index rows = 6;
    const Eigen::Index contacts = 2 + trial % 9;
    Eigen::VectorXd y(rows);
    for (double& entry : y) entry = random.normal();
    Eigen::MatrixXd normals(rows, contacts);
    Eigen::VectorXd w(contacts);
    for (Eigen::Index c = 0; c < contacts; ++c) {
      for (double& entry : normals.col(c)) entry = random.normal();
      if (normals.col(c).dot(y) > 0.0) normals.col(c) *= -1.0;
      w[c] = random.uniform() * normals.col(c).dot(y);
    }
    const Eigen::VectorXd rounding = Eigen::VectorXd::Constant(contacts, 64.0 * kEpsilon);
    const Eigen::SparseMatrix<double> sparse = normals.sparseView();
    const Complementary pivoted = solve_by_pivoting(sparse, w, rounding);
    const Complementary swept = solve_by_sweeps(sparse, w, rounding);
    const double error = 256.0 * kEpsilon * (normals.norm() * normals.norm()) *
                         std::max(pivoted.impulse.sum(), swept.impulse.sum());
    EXPECT_GE(pivoted.impulse.minCoeff(), 0.0);
    EXPECT_GE(swept.impulse.minCoeff(), 0.0);
    EXPECT_GE((w + pivoted.change).minCoeff(), -error);
    EXPECT_NEAR(pivoted.impulse.dot(w + pivoted.change), 0.0, error * (1.0 + pivoted.impulse.sum()));
    EXPECT_LE((pivoted.change - swept.change).norm(), error);
  }
}

TEST(MakeClusterLaw, GivesWhatTheSceneNames_AndNothingForPairByPair) {
  Scenario scene;
  EXPECT_EQ(make_cluster_law<2>(scene), nullptr);
  EXPECT_EQ(make_cluster_law<3>(scene), nullptr);
  scene.multi_contact = MultiContact::simultaneous;
  EXPECT_EQ(make_cluster_law<2>(scene)->name(), "simultaneous");
  scene.multi_contact = MultiContact::generalized_reflections;
  EXPECT_EQ(make_cluster_law<3>(scene)->name(), "generalized-reflections");
}

}  // namespace
}  // namespace carom::test
