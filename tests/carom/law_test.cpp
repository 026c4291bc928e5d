#include <gtest/gtest.h>

#include <cmath>

#include "carom/laws/frictionless.h"
#include "core/random.h"

namespace carom::test {
namespace {

/// Two balls that approach along a random normal, masses up to 10¹² apart.
struct RandomPair {
  World<3> world;
  Vec<3> normal;
  double mass_a;
  double mass_b;
};

RandomPair random_pair(Random& random) {
  Ball a;
  Ball b;
  a.mass = std::pow(10.0, random.uniform(-6.0, 6.0));
  b.mass = std::pow(10.0, random.uniform(-6.0, 6.0));
  Vec3 normal(random.normal(), random.normal(), random.normal());
  normal.normalize();
  a.velocity = Vec3(random.normal(), random.normal(), random.normal());
  b.velocity = a.velocity - random.uniform(0.01, 2.0) * normal + 0.3 * normal.unitOrthogonal();
  return {World<3>({a, b}), normal, a.mass, b.mass};
}

/// A few roundings of velocities of this size.
double velocity_error(double speeds_mps) {
  return 16.0 * kEpsilon * speeds_mps;
}

TEST(FrictionlessImpact, ConservesMomentum_AnyMassRatio) {
  Random random(1);
  for (int trial = 0; trial < 5000; ++trial) {
    RandomPair pair = random_pair(random);
    World<3>& world = pair.world;
    const double scale = pair.mass_a * world.velocity[0].norm() + pair.mass_b * world.velocity[1].norm();
    const Vec<3> before = pair.mass_a * world.velocity[0] + pair.mass_b * world.velocity[1];
    Frictionless::between<3>(world, 0, 1, pair.normal, random.uniform());
    const Vec<3> after = pair.mass_a * world.velocity[0] + pair.mass_b * world.velocity[1];
    // Each of the two velocities is rounded after its change, the masses once more by their inverses: 8 ε.
    EXPECT_LE((after - before).norm(), 8.0 * kEpsilon * scale) << "trial " << trial;
  }
}

TEST(FrictionlessImpact, TurnsTheNormalVelocityByMinusE_AndLeavesTheRest) {
  Random random(2);
  for (int trial = 0; trial < 5000; ++trial) {
    RandomPair pair = random_pair(random);
    World<3>& world = pair.world;
    const double e = random.uniform();
    const Vec<3> before = world.velocity[1] - world.velocity[0];
    const double speeds = world.velocity[0].norm() + world.velocity[1].norm();
    const Vec<3> impulse = Frictionless::between<3>(world, 0, 1, pair.normal, e);
    const Vec<3> after = world.velocity[1] - world.velocity[0];
    EXPECT_NEAR(after.dot(pair.normal), -e * before.dot(pair.normal), velocity_error(speeds))
        << "trial " << trial;
    EXPECT_LE(after.cross(pair.normal).norm(), before.cross(pair.normal).norm() + velocity_error(speeds));
    EXPECT_GT(impulse.dot(pair.normal), 0.0);
  }
}

TEST(FrictionlessImpact, LosesExactlyWhatTheFormulaSays) {
  Random random(3);
  for (int trial = 0; trial < 5000; ++trial) {
    RandomPair pair = random_pair(random);
    World<3>& world = pair.world;
    const double e = random.uniform();
    const auto energy = [&] {
      return 0.5 *
             (pair.mass_a * world.velocity[0].squaredNorm() + pair.mass_b * world.velocity[1].squaredNorm());
    };
    const double before = energy();
    const double v_n = pair.normal.dot(world.velocity[1] - world.velocity[0]);
    const double reduced = pair.mass_a * pair.mass_b / (pair.mass_a + pair.mass_b);
    Frictionless::between<3>(world, 0, 1, pair.normal, e);
    const double lost = 0.5 * reduced * (1.0 - e * e) * v_n * v_n;
    EXPECT_NEAR(before - energy(), lost, 16.0 * kEpsilon * before) << "trial " << trial;
  }
}

TEST(FrictionlessImpact, MovesOnlyTheMovableBall_AgainstAnImmovableOne) {
  Ball wall;
  wall.mass = std::numeric_limits<double>::infinity();
  Ball ball;
  ball.velocity = Vec3(-2.0, 1.0, 0.0);
  World<2> world({wall, ball});
  Frictionless::between<2>(world, 0, 1, Vec<2>::UnitX(), 0.5);
  EXPECT_EQ(world.velocity[0], Vec<2>(0.0, 0.0));
  EXPECT_EQ(world.velocity[1], Vec<2>(1.0, 1.0));
}

TEST(FrictionlessImpact, OnAWall_IsTheLimitOfAHeavyBall) {
  Ball ball;
  ball.mass = 3.0;
  ball.velocity = Vec3(-2.0, 1.0, 0.0);
  World<2> world({ball});
  const Vec<2> impulse = Frictionless::on_wall<2>(world, 0, Vec<2>::UnitX(), 0.5);
  EXPECT_EQ(world.velocity[0], Vec<2>(1.0, 1.0));
  EXPECT_EQ(impulse, Vec<2>(9.0, 0.0));
}

}  // namespace
}  // namespace carom::test
