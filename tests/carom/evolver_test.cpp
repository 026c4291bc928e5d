#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "carom/compose.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

Ball ball(double mass, double radius, const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  Ball made;
  made.mass = mass;
  made.radius = radius;
  made.position = position;
  made.velocity = velocity;
  return made;
}

/// What two balls come to, told from the formulas alone and in long double: touch at the first root of
/// |d + w t| = σ, then J = -(1+e) m (w·n) n.
struct PairOutcome {
  Vec3 position_a;
  Vec3 position_b;
  Vec3 velocity_a;
  Vec3 velocity_b;
};

PairOutcome pair_outcome(const Ball& a, const Ball& b, double e, double duration_s) {
  using Wide = Eigen::Matrix<long double, 3, 1>;
  const Wide xa = a.position.cast<long double>();
  const Wide xb = b.position.cast<long double>();
  const Wide va = a.velocity.cast<long double>();
  const Wide vb = b.velocity.cast<long double>();
  const Wide d = xb - xa;
  const Wide w = vb - va;
  const long double sigma = static_cast<long double>(a.radius) + b.radius;
  const long double half_b = d.dot(w);
  const long double disc = half_b * half_b - w.squaredNorm() * (d.squaredNorm() - sigma * sigma);
  const long double t = (-half_b - std::sqrt(disc)) / w.squaredNorm();
  const Wide n = (d + t * w).normalized();
  const long double reduced = 1.0L / (1.0L / a.mass + 1.0L / b.mass);
  const Wide impulse = -(1.0L + e) * reduced * w.dot(n) * n;
  const Wide va2 = va - impulse / a.mass;
  const Wide vb2 = vb + impulse / b.mass;
  const long double rest = duration_s - t;
  return {(xa + t * va + rest * va2).cast<double>(), (xb + t * vb + rest * vb2).cast<double>(),
          va2.cast<double>(), vb2.cast<double>()};
}

class TwoBalls : public testing::TestWithParam<std::int64_t> {};

/// Random masses (10⁻⁶ to 10⁶), radii, e, and impact parameters up to 0.95 of the sum of the radii, in space.
TEST_P(TwoBalls, AreRightTo1e12_AnyMassesAnyAngle_AtAnyStep) {
  Random random(42);
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    const double sigma = random.uniform(0.1, 0.4);
    const double split = random.uniform(0.2, 0.8);
    const Vec3 along = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    const double offset = trial % 3 == 0 ? 0.0 : random.uniform(0.0, 0.95) * sigma;
    const double speed = random.uniform(0.5, 2.0);
    Ball a = ball(std::pow(10.0, random.uniform(-6.0, 6.0)), split * sigma, Vec3::Zero(), speed * along);
    Ball b = ball(std::pow(10.0, random.uniform(-6.0, 6.0)), (1.0 - split) * sigma,
                  random.uniform(0.6, 1.0) * along + offset * along.unitOrthogonal());
    const double e = trial % 2 == 0 ? 1.0 : random.uniform();
    Scenario scene = free_scene(3, {a, b}, 2.5, 1.0);
    scene.ball_contact.restitution = e;
    const auto simulation = compose(scene, {"toi", ""});
    const auto states = run(*simulation, scene, GetParam());
    const PairOutcome expected = pair_outcome(a, b, e, scene.duration_s);
    ASSERT_EQ(simulation->tally().impacts, 1);
    // Relative to the speed that came in and to the way that it covers.
    const double way = speed * scene.duration_s;
    EXPECT_LE((states[0].velocity - expected.velocity_a).norm(), 1e-12 * speed);
    EXPECT_LE((states[1].velocity - expected.velocity_b).norm(), 1e-12 * speed);
    EXPECT_LE((states[0].position - expected.position_a).norm(), 1e-12 * way);
    EXPECT_LE((states[1].position - expected.position_b).norm(), 1e-12 * way);
  }
}

INSTANTIATE_TEST_SUITE_P(Steps, TwoBalls, testing::Values(1, 2, 3, 10, 77, 1000));

TEST(ToiEvolver, GlancingHit_TurnsByTheRightAngle_InOneLongStep) {
  // b = 0.999: the line of centres stands at asin(0.999) to the path.
  Scenario scene =
      free_scene(2, {ball(1, 0.5, Vec3(-2, 0.999, 0), Vec3(1, 0, 0)), ball(1, 0.5, Vec3::Zero())}, 4, 4);
  const auto simulation = compose(scene, {"toi", ""});
  const auto states = run(*simulation, scene, 1);
  const double sine = 0.999;
  const double cosine = std::sqrt(1.0 - sine * sine);
  // The normal's error is ε over the cosine by which it stands.
  EXPECT_NEAR(states[1].velocity.x(), cosine * cosine, 8.0 * kEpsilon / cosine);
  EXPECT_NEAR(states[1].velocity.y(), -cosine * sine, 8.0 * kEpsilon / cosine);
}

TEST(ToiEvolver, ImpactsWithinAStep_AreInOrderOfTime) {
  // The first ball reaches the second only because the third has not yet been there; all within one step.
  Scenario scene = free_scene(2,
                              {ball(1, 0.1, Vec3(0, 0, 0), Vec3(1, 0, 0)), ball(1, 0.1, Vec3(1, 0, 0)),
                               ball(1, 0.1, Vec3(2, 0, 0)), ball(1, 0.1, Vec3(3, 0, 0))},
                              5.0, 5.0);
  const auto simulation = compose(scene, {"toi", ""});
  const auto states = run(*simulation, scene, 1);
  EXPECT_EQ(simulation->tally().impacts, 3);
  EXPECT_EQ(states[0].velocity.x(), 0.0);
  EXPECT_EQ(states[1].velocity.x(), 0.0);
  EXPECT_EQ(states[2].velocity.x(), 0.0);
  EXPECT_EQ(states[3].velocity.x(), 1.0);
  // Three gaps of 0.8 are crossed one after the other, the fourth ball goes on with what is left of 5 s.
  EXPECT_NEAR(states[3].position.x(), 3.0 + (5.0 - 3 * 0.8), 16 * kEpsilon);
}

TEST(ToiEvolver, GalperinsBalls_CountTheDigitsOfPi) {
  // ⌈π/θ⌉ - 1 impacts, θ = arctan √(m/M). G. Galperin, Regul. Chaotic Dyn. 8, 375 (2003).
  const std::vector<std::pair<double, std::int64_t>> counts = {{1e0, 3}, {1e2, 31}, {1e4, 314}, {1e6, 3141}};
  for (const auto& [ratio, impacts] : counts) {
    Scenario scene =
        free_scene(2, {ball(1, 0.1, Vec3(1, 0, 0)), ball(ratio, 0.1, Vec3(2, 0, 0), Vec3(-1, 0, 0))}, 20, 1);
    scene.walls.push_back({Vec3::UnitX(), 0.0});
    const auto simulation = compose(scene, {"toi", ""});
    run(*simulation, scene, 20);
    EXPECT_EQ(simulation->tally().impacts, impacts) << "M/m = " << ratio;
  }
}

TEST(ToiEvolver, Gas_ConservesEnergyAndAccountsForTheWalls) {
  for (const int dimension : {2, 3}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(testing::Message() << dimension << "D, seed " << seed);
      const ScenarioPtr scene = gas(dimension, 100, 0.2, 4.0, seed);
      const auto simulation = compose(*scene, {"toi", ""});
      const auto states = run(*simulation, *scene, 50);
      const double before = kinetic_energy_of(*scene, states_of(*scene));
      const auto impacts = static_cast<double>(simulation->tally().impacts);
      // An impact changes two velocities and rounds each once: 4 ε of the energy of two balls of a hundred.
      EXPECT_NEAR(kinetic_energy_of(*scene, states), before,
                  4.0 * kEpsilon * before * (1.0 + impacts / 50.0));
      const Vec3 expected = momentum_of(*scene, states_of(*scene)) + simulation->tally().external_impulse;
      EXPECT_LE((momentum_of(*scene, states) - expected).norm(),
                4.0 * kEpsilon * 100.0 * (1.0 + impacts / 100.0));
      EXPECT_GT(impacts, 20.0);
    }
  }
}

TEST(ToiEvolver, InelasticGas_NeverGainsEnergy) {
  for (const double e : {0.0, 0.3, 0.9}) {
    const std::string contact = "[contact]\nrestitution = " + std::to_string(e);
    const ScenarioPtr scene = gas(2, 60, 0.3, 4.0, 9, contact);
    const auto simulation = compose(*scene, {"toi", ""});
    double last = kinetic_energy_of(*scene, states_of(*scene));
    for (int k = 0; k < 200; ++k) {
      simulation->advance(0.01, 1);
      const double now = kinetic_energy_of(*scene, states_of(*simulation, scene->balls.size()));
      EXPECT_LE(now, last * (1.0 + 64.0 * kEpsilon)) << "e = " << e << ", step " << k;
      last = now;
    }
  }
}

Scenario dropped(double height, double e, double duration_s) {
  Scenario scene = free_scene(2, {ball(1, 0.1, Vec3(0, height + 0.1, 0))}, duration_s, 0.001);
  scene.effects.gravity = Vec3(0, -9.81, 0);
  scene.wall_contact.restitution = e;
  scene.walls.push_back({Vec3::UnitY(), 0.0});
  return scene;
}

TEST(ToiEvolver, DroppedBall_KeepsItsApex_Over100Bounces) {
  const double height = 10.0;
  const double fall = std::sqrt(2.0 * height / 9.81);
  const Scenario scene = dropped(height, 1.0, 200.0 * fall);
  const auto simulation = compose(scene, {"toi", ""});
  const std::int64_t steps = 285'000;
  const auto states = run(*simulation, scene, steps);
  EXPECT_EQ(simulation->tally().impacts, 100);
  const double energy = 0.5 * states[0].velocity.squaredNorm() + 9.81 * (states[0].position.y() - 0.1);
  // Each step rounds height and speed once; were all roundings of one sign, they would add up to steps × ε.
  EXPECT_NEAR(energy / (9.81 * height), 1.0, static_cast<double>(steps) * kEpsilon);
}

TEST(ToiEvolver, LossyBall_ComesToRestAtTheRightTime_AndStays) {
  const double e = 0.8;
  const double fall = std::sqrt(2.0 * 10.0 / 9.81);
  const double rest_time = fall * (1.0 + e) / (1.0 - e);
  Scenario scene = dropped(10.0, e, rest_time + 5.0);
  const auto simulation = compose(scene, {"toi", ""});
  const auto states = run(*simulation, scene, 20'000);
  // Bounces shorter than 1/1000 of the step are left out; none is higher than g (step/1000)²/8.
  EXPECT_NEAR(states[0].position.y(), 0.1, 1e-12);
  EXPECT_NEAR(states[0].velocity.y(), 0.0, 1e-12);
  // What bears it from then on is in the account.
  EXPECT_NEAR(simulation->tally().external_impulse.y(), 9.81 * scene.duration_s, 1e-9);
}

TEST(ToiEvolver, BallOnTheFloor_DoesNotSink_InAMillionSteps) {
  Scenario scene = dropped(0.0, 0.5, 1000.0);
  scene.balls[0].velocity = Vec3(0.001, 0, 0);
  const auto simulation = compose(scene, {"toi", ""});
  const auto states = run(*simulation, scene, 1'000'000);
  EXPECT_NEAR(states[0].position.y(), 0.1, 1e-13);
  EXPECT_NEAR(states[0].position.x(), 1.0, 1e-10);
  EXPECT_EQ(simulation->tally().impacts, 0);
}

TEST(ToiEvolver, TwoBallsOnEachOther_StayInPlace) {
  Scenario scene = dropped(0.0, 0.5, 2.0);
  scene.ball_contact.restitution = 0.5;
  scene.balls.push_back(ball(2, 0.1, Vec3(0, 0.3 + 1e-3, 0)));
  const auto simulation = compose(scene, {"toi", ""});
  const auto states = run(*simulation, scene, 480);
  EXPECT_NEAR(states[0].position.y(), 0.1, 1e-9);
  EXPECT_NEAR(states[1].position.y(), 0.3, 1e-9);
}

TEST(ToiEvolver, BallInATiltedCorner_ComesToRestInIt) {
  Scenario scene = free_scene(2, {ball(1, 0.1, Vec3(0, 0.5, 0))}, 3.0, 0.01);
  scene.effects.gravity = Vec3(0, -9.81, 0);
  scene.wall_contact.restitution = 0.5;
  const double tilt = 0.65;
  scene.walls = {{Vec3(std::sin(tilt), std::cos(tilt), 0), 0.0},
                 {Vec3(-std::cos(tilt), std::sin(tilt), 0), 0.0}};
  const auto simulation = compose(scene, {"toi", ""});
  const auto states = run(*simulation, scene, 300);
  for (const Wall& wall : scene.walls) {
    // Rebounds that are left out are lower than g (step/1000)²/8 = 1.2e-10 m.
    EXPECT_NEAR(wall.normal.dot(states[0].position), 0.1, 2e-10);
  }
  const Vec3 weight(0, -9.81 * scene.duration_s, 0);
  const Vec3 unexplained = states[0].velocity - weight - simulation->tally().external_impulse;
  EXPECT_LE(unexplained.norm(), 1e-10);
}

TEST(ToiEvolver, RestingBallUnderDrag_IsBorneByItsWholeWeight) {
  Scenario scene = dropped(0.0, 0.5, 2.0);
  scene.effects.drag = Drag{Drag::Kind::linear, 3.0};
  const auto simulation = compose(scene, {"toi", ""});
  run(*simulation, scene, 200);
  EXPECT_NEAR(simulation->tally().external_impulse.y(), 9.81 * scene.duration_s, 1e-12);
}

TEST(ToiEvolver, StackThatIsHit_AccountsForTheFloor) {
  Scenario scene = dropped(0.0, 0.5, 1.0);
  scene.ball_contact.restitution = 0.5;
  scene.balls.push_back(ball(1, 0.1, Vec3(0, 0.3, 0)));
  scene.balls.push_back(ball(2, 0.1, Vec3(0.02, 1.0, 0)));
  const auto simulation = compose(scene, {"toi", ""});
  const auto states = run(*simulation, scene, 240);
  const Vec3 expected = Vec3(0, -9.81 * 4.0 * scene.duration_s, 0) + simulation->tally().external_impulse;
  EXPECT_LE((momentum_of(scene, states) - expected).norm(), 1e-9);
}

TEST(ToiEvolver, Pile_SettlesWithoutSinkingOrGainingEnergy) {
  const ScenarioPtr scene =
      gas(2, 20, 0.3, 2.0, 5, "[effects]\ngravity = [0, -9.81]\n[contact]\nrestitution = 0.3\n");
  const auto simulation = compose(*scene, {"toi", ""});
  const auto energy = [&](const std::vector<BallState>& states) {
    double sum = kinetic_energy_of(*scene, states);
    for (std::size_t i = 0; i < states.size(); ++i)
      sum += 9.81 * scene->balls[i].mass * states[i].position.y();
    return sum;
  };
  double last = energy(states_of(*scene));
  const double scale = last;
  for (int k = 0; k < 300; ++k) {
    simulation->advance(0.005, 1);
    const auto states = states_of(*simulation, scene->balls.size());
    // Contacts that are held a little apart, or together, move a ball by at most a hundredth of ½ g h² in a
    // step.
    EXPECT_LE(energy(states), last + 1e-5 * scale) << "step " << k;
    last = energy(states);
    for (std::size_t i = 0; i < states.size(); ++i) {
      EXPECT_GE(states[i].position.y(), scene->balls[i].radius - 1e-5) << "ball " << i << ", step " << k;
    }
  }
}

TEST(ToiEvolver, InelasticCollapse_Ends) {
  // Three balls with e < 7 - 4√3 collide infinitely often in finite time. S. McNamara, W. R. Young, Phys.
  // Fluids A 4, 496 (1992).
  Scenario scene = free_scene(2,
                              {ball(1, 0.1, Vec3(-1, 0, 0), Vec3(1, 0, 0)), ball(1, 0.1, Vec3::Zero()),
                               ball(1, 0.1, Vec3(1, 0, 0), Vec3(-1, 0, 0))},
                              3.0, 0.01);
  scene.ball_contact.restitution = 0.05;
  const auto simulation = compose(scene, {"toi", ""});
  const auto states = run(*simulation, scene, 300);
  EXPECT_NEAR(momentum_of(scene, states).x(), 0.0, 8.0 * kEpsilon);
  EXPECT_LT(simulation->tally().impacts, 1000);
}

TEST(ToiEvolver, ImmovableBalls_StayAndPushBack_AndIgnoreEachOther) {
  const double inf = std::numeric_limits<double>::infinity();
  Scenario scene = free_scene(2,
                              {ball(inf, 0.5, Vec3(2, 0, 0)), ball(inf, 0.5, Vec3(2.5, 0, 0)),
                               ball(2, 0.1, Vec3::Zero(), Vec3(1, 0, 0))},
                              3.0, 0.1);
  const auto simulation = compose(scene, {"toi", ""});
  const auto states = run(*simulation, scene, 30);
  EXPECT_EQ(states[0].position, Vec3(2, 0, 0));
  EXPECT_EQ(states[1].position, Vec3(2.5, 0, 0));
  EXPECT_EQ(states[2].velocity.x(), -1.0);
  EXPECT_NEAR(simulation->tally().external_impulse.x(), -4.0, 8 * kEpsilon);
}

TEST(ToiEvolver, WithoutCollisions_BallsPassThroughEachOther) {
  Scenario scene =
      free_scene(2, {ball(1, 0.1, Vec3(-1, 0, 0), Vec3(1, 0, 0)), ball(1, 0.1, Vec3::Zero())}, 2, 0.1);
  scene.effects.collisions = false;
  const auto simulation = compose(scene, {"toi", ""});
  const auto states = run(*simulation, scene, 20);
  EXPECT_NEAR(states[0].position.x(), 1.0, 32 * kEpsilon);
  EXPECT_EQ(states[1].position.x(), 0.0);
  EXPECT_EQ(simulation->tally().impacts, 0);
}

}  // namespace
}  // namespace carom::test
