// Contacts with friction that hang together (laws/cone.h, evolvers/contact_solver.h).

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "carom/compose.h"
#include "carom/evolvers/contact_solver.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

Ball ball(double mass, double radius, const Vec3& position) {
  Ball made;
  made.mass = mass;
  made.radius = radius;
  made.position = position;
  return made;
}

/// Balls hung at random on each other and on a floor, with masses up to 10⁸ apart, moving and spinning at
/// random.
template <int Dim>
struct RandomCluster {
  explicit RandomCluster(std::uint64_t seed) : random(seed), world(make_balls(), true) {
    for (std::size_t i = 0; i < world.size(); ++i) {
      world.velocity.set(i, flattened<Dim>(random_vector(random, Dim, 1.0)));
      world.spin.set(i, Spin<Dim>::Constant(random.uniform(-1.0, 1.0)));
    }
    for (std::uint32_t i = 0; i < world.size(); ++i) {
      if (random.uniform(0.0, 1.0) < 0.4) add({i, 0, true, Vec<Dim>::UnitX()});
      if (i == 0) continue;
      const auto other = static_cast<std::uint32_t>(random.uniform(0.0, 1.0) * i);
      add({other, i, false, flattened<Dim>(random_vector(random, Dim, 1.0)).normalized()});
    }
    if (contacts.empty()) add({0, 0, true, Vec<Dim>::UnitX()});
  }

  void add(KeptContact<Dim> contact) {
    contact.friction = random.uniform(0.0, 1.0);
    contacts.push_back(contact);
  }

  std::vector<Ball> make_balls() {
    std::vector<Ball> balls;
    const auto count = static_cast<std::size_t>(2.0 + random.uniform(0.0, 8.0));
    balls.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      balls.push_back(ball(std::pow(10.0, random.uniform(0.0, 8.0)), random.uniform(0.5, 2.0), Vec3::Zero()));
    }
    return balls;
  }

  double energy() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < world.size(); ++i) {
      sum += 0.5 * world.velocity[i].squaredNorm() / world.inverse_mass[i];
      sum += 0.5 * world.spin[i].squaredNorm() / world.inverse_inertia[i];
    }
    return sum;
  }

  Random random;
  World<Dim> world;
  std::vector<KeptContact<Dim>> contacts;
};

constexpr double kTolerance_mps = 1e-12;

template <class Solve>
void for_each_random_cluster(const Solve& solve) {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(seed);
    solve(RandomCluster<2>(seed));
    solve(RandomCluster<3>(seed));
  }
}

template <int Dim>
auto response_in(const World<Dim>& world) {
  return [&world](std::uint32_t number) { return world.inverse_mass[number]; };
}

TEST(RoughContacts, NeverGainEnergy_AtMassRatiosTo1e8) {
  const auto check = []<int Dim>(RandomCluster<Dim> cluster, bool openings_only) {
    ContactSolver<Dim, true> solver;
    solver.contacts() = cluster.contacts;
    World<Dim>& world = cluster.world;
    const double before = cluster.energy();
    if (openings_only) {
      solver.solve_openings(world, world.velocity, world.spin, response_in(world), kTolerance_mps);
    } else {
      solver.solve(world, world.velocity, world.spin, response_in(world), kTolerance_mps);
    }
    // A push is a sum over up to 20 contacts, and each rounds the energy of two balls by 8 ε.
    EXPECT_LE(cluster.energy(), before * (1.0 + 20 * 8.0 * kEpsilon));
  };
  for_each_random_cluster([&]<int Dim>(const RandomCluster<Dim>& cluster) {
    check(cluster, false);
    check(cluster, true);
  });
}

TEST(RoughContacts, ObeyCoulombsCone_WhereTheyAreSolved) {
  int unsolved = 0;
  for_each_random_cluster([&]<int Dim>(RandomCluster<Dim> cluster) {
    using Solver = ContactSolver<Dim, true>;
    Solver solver;
    solver.contacts() = cluster.contacts;
    World<Dim>& world = cluster.world;
    if (!solver.solve(world, world.velocity, world.spin, response_in(world), kTolerance_mps)) {
      ++unsolved;
      return;
    }
    for (const KeptContact<Dim>& contact : solver.contacts()) {
      // A light ball is moved by up to 32 impulses of heavy ones, 1e8 times its own momentum of some 1 m/s,
      // and each is rounded: 32 ε × 1e8 = 7e-7.
      const double u_n = Solver::opening(contact, world.velocity);
      EXPECT_GE(u_n, -1e-6);
      EXPECT_GE(contact.push, 0.0);
      EXPECT_LE(contact.drag.norm(), contact.friction * contact.push * (1.0 + 1e-6) + 1e-9);
      EXPECT_LE(contact.drag.dot(Solver::slip(world, contact, world.velocity, world.spin)),
                1e-6 * contact.drag.norm());
    }
  });
  EXPECT_LE(unsolved, 8);  // of 800
}

TEST(ToiEvolver, LightRoughBalls_BearOneAMillionTimesHeavier) {
  const ScenarioPtr scene =
      load_scene(std::string(CAROM_SOURCE_DIR) + "/scenarios/hard/rough-stack-million.toml");
  const auto simulation = compose(*scene, {"toi", ""});
  const auto states = run(*simulation, *scene, 1000);
  for (std::size_t i = 0; i < states.size(); ++i) {
    // See the scene: 2e-10 m.
    EXPECT_LE((states[i].position - scene->balls[i].position).norm(), 5e-10) << "ball " << i;
  }
}

}  // namespace
}  // namespace carom::test
