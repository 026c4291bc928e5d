#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "carom/compose.h"
#include "carom/effects/barrier.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

// What stands in a ball's way: slabs, quantum barriers, and floors that are rough.

namespace carom::test {
namespace {

Ball ball_at(const Vec3& position, const Vec3& velocity, double radius = 0.01) {
  Ball ball;
  ball.radius = radius;
  ball.position = position;
  ball.velocity = velocity;
  return ball;
}

/// Round-off of a flight in steps: each rounds a place of up to `size_m` once in its product and once in its
/// sum, and a few roundings more belong to the impacts.
double rounding_of(std::int64_t steps, double size_m) {
  constexpr double kAroundImpacts = 16.0;
  return (2.0 * static_cast<double>(steps) + kAroundImpacts) * kEpsilon * size_m;
}

// --- slabs

constexpr double kThin_m = 1e-3;
constexpr double kFast_mps = 1000.0;

/// A ball of radius 0.01 m that flies 2 ms at 1000 m/s to the thin slab and 2 ms back.
Scenario shot(int dimension, const Vec3& normal, double restitution) {
  const Vec3 along = 0.3 * normal.unitOrthogonal();
  Scenario scene = free_scene(dimension, {ball_at(-2.0 * normal, kFast_mps * (normal + along))}, 4e-3, 1e-3);
  scene.slabs = {{normal, 0.0, kThin_m}};
  scene.wall_contact.restitution = restitution;
  return scene;
}

/// Where it is at the end: the way along the slab is as it was, that along the normal was turned back at the
/// face.
BallState after_the_shot(const Scenario& scene) {
  const Vec3 normal = scene.slabs[0].normal;
  const Ball& ball = scene.balls[0];
  const double e = scene.wall_contact.restitution;
  const double face = -(0.5 * kThin_m + ball.radius);
  const double impact_s = (face - normal.dot(ball.position)) / kFast_mps;
  const Vec3 along = ball.velocity - normal.dot(ball.velocity) * normal;
  const double back_m = e * kFast_mps * (scene.duration_s - impact_s);
  return {scene.duration_s * along + (face - back_m) * normal, along - e * kFast_mps * normal, Vec3::Zero()};
}

class Shot : public testing::TestWithParam<std::int64_t> {};

TEST_P(Shot, BouncesOffAThinSlab_AtTheRightPlaceAndTime) {
  const std::vector<std::pair<int, Vec3>> cases = {
      {2, Vec3::UnitX()}, {2, Vec3(-3, 4, 0) / 5}, {3, Vec3::UnitX()}, {3, Vec3(2, -3, 6) / 7}};
  for (const auto& [dimension, normal] : cases) {
    for (const double e : {1.0, 0.6}) {
      SCOPED_TRACE(testing::Message() << dimension << "D, normal " << normal.transpose() << ", e " << e);
      const Scenario scene = shot(dimension, normal, e);
      const auto simulation = compose(scene, {"toi", ""});
      const BallState end = run(*simulation, scene, GetParam()).front();
      const BallState expected = after_the_shot(scene);
      EXPECT_EQ(simulation->tally().impacts, 1);
      EXPECT_LE((end.position - expected.position).norm(), rounding_of(GetParam(), 2.5));
      EXPECT_LE((end.velocity - expected.velocity).norm(), 8.0 * kEpsilon * kFast_mps);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Steps, Shot, testing::Values(1, 2, 3, 17, 400, 4001));

/// A ball in discrete detection is caught while its centre is between the face and the middle of the slab.
TEST(StepEvolver, TunnellingByTooLongAStep_JumpsASlabThatToiDoesNot) {
  const Scenario scene = shot(2, Vec3::UnitX(), 1.0);
  const double catching_m = scene.balls[0].radius + 0.5 * kThin_m;
  const auto end_x = [&](const std::string& evolver, std::int64_t steps) {
    const auto simulation = compose(scene, {evolver, ""});
    return run(*simulation, scene, steps).front().position.x();
  };
  const std::int64_t long_steps = 5;  // of 0.8 m each: at -0.4 m, and then at 0.4 m
  const auto short_steps = static_cast<std::int64_t>(std::ceil(kFast_mps * scene.duration_s / catching_m));
  EXPECT_NEAR(end_x("step", long_steps), 2.0, rounding_of(long_steps, 2.0));
  EXPECT_LT(end_x("step", short_steps), -catching_m);
  EXPECT_LT(end_x("toi", long_steps), -catching_m);
}

class Side : public testing::TestWithParam<std::tuple<std::string, int>> {};

/// Balls on a lattice, with random velocities, on both sides of a tilted slab that parts a box.
Scenario parted_gas(int dimension, std::uint64_t seed) {
  Random random(seed);
  Scenario scene = free_scene(dimension, {}, 10.0, 2e-3);
  const double spacing = 0.5;  // m
  const int layers = dimension == 3 ? 4 : 1;
  scene.slabs = {{Vec3(12, 5, 0) / 13, 0.0, kThin_m}};
  constexpr int kColumns = 8;
  constexpr int kRows = 4;
  const Vec3 first_site(-1.75, -0.75, dimension == 3 ? -0.75 : 0.0);
  for (int k = 0; k < kColumns * kRows * layers; ++k) {
    const std::div_t in_plane = std::div(k, kColumns * kRows);
    const std::div_t in_row = std::div(in_plane.rem, kColumns);
    const Vec3 site = first_site + spacing * Vec3(in_row.rem, in_row.quot, in_plane.quot);
    Ball ball = ball_at(site, random_vector(random, dimension, 2.0), random.uniform(0.08, 0.12));
    if (std::abs(scene.slabs[0].normal.dot(site)) > ball.radius + kThin_m) scene.balls.push_back(ball);
  }
  for (int axis = 0; axis < dimension; ++axis) {
    const double half = axis == 0 ? 2.0 : 1.0;
    scene.walls.push_back({Vec3::Unit(axis), -half});
    scene.walls.push_back({-Vec3::Unit(axis), -half});
  }
  return scene;
}

TEST_P(Side, IsKept_InAGasOnBothSides_ForThousandsOfImpacts) {
  const auto& [evolver, dimension] = GetParam();
  const Scenario scene = parted_gas(dimension, 7);
  const Slab& slab = scene.slabs[0];
  const auto simulation = compose(scene, {evolver, ""});
  const std::int64_t steps_a_look = 50;
  // `toi` touches to rounding; `step` moves balls apart one after the other, and may push one back into the
  // slab by what another overlapped it: by no more than two balls close in a step.
  const double fastest = 12.0;  // m/s, six times the root mean square: no ball of a hundred is
  const double depth = evolver == "toi" ? rounding_of(1, 2.0) : 2.0 * fastest * scene.step_s;
  const int looks = dimension == 2 ? 300 : 100;
  for (int look = 0; look < looks; ++look) {
    simulation->advance(scene.step_s, steps_a_look);
    const auto states = states_of(*simulation, scene.balls.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
      const double before = slab.normal.dot(scene.balls[i].position);
      const double now = slab.normal.dot(states[i].position) * (before > 0.0 ? 1.0 : -1.0);
      ASSERT_GE(now, scene.balls[i].radius + 0.5 * kThin_m - depth) << "ball " << i << ", look " << look;
    }
  }
  EXPECT_GT(simulation->tally().impacts, 3000);
  const double energy = kinetic_energy_of(scene, states_of(scene));
  const auto impacts = static_cast<double>(simulation->tally().impacts);
  // An impact rounds two velocities of a few dozen once each.
  EXPECT_NEAR(kinetic_energy_of(scene, states_of(*simulation, scene.balls.size())), energy,
              kEpsilon * energy * impacts);
}

INSTANTIATE_TEST_SUITE_P(Evolvers, Side,
                         testing::Combine(testing::Values("toi", "step"), testing::Values(2, 3)));

TEST(Slab, BouncesWithTheRestitutionOfWalls) {
  const ScenarioPtr scene = scene_of(R"(
title = "slab"
dimension = 2
duration = 2.0
step = 0.01
frames = 1
[contact]
restitution = 0.9
[contact.wall]
restitution = 0.25
[[slab]]
normal = [1, 0]
offset = 1.0
thickness = 0.1
[[ball]]
mass = 3.0
radius = 0.1
position = [0, 0]
velocity = [1, 0.5]
)");
  for (const std::string evolver : {"toi", "step"}) {
    SCOPED_TRACE(evolver);
    const auto simulation = compose(*scene, {evolver, ""});
    EXPECT_EQ(run(*simulation, *scene, 200).front().velocity, Vec3(-0.25, 0.5, 0.0));
    EXPECT_EQ(simulation->tally().external_impulse, Vec3(-3.75, 0.0, 0.0));
  }
}

// --- quantum barriers

using Wide = long double;

/// The textbook's three cases, each as it stands there.
Wide textbook_transmission(Wide mass, Wide speed, Wide height, Wide thickness, Wide hbar) {
  const Wide energy = mass * speed * speed / 2;
  if (energy == height) return 1 / (1 + mass * thickness * thickness * height / (2 * hbar * hbar));
  const Wide k = std::sqrt(2 * mass * std::abs(energy - height)) / hbar;
  const Wide s = energy < height ? std::sinh(k * thickness) : std::sin(k * thickness);
  return 1 / (1 + height * height * s * s / (4 * energy * std::abs(energy - height)));
}

Barrier barrier_of(double height, double thickness, double hbar, std::uint64_t seed = 0) {
  return {Vec3::UnitX(), 0.0, thickness, height, hbar, seed};
}

TEST(Transmission, MatchesTheTextbook_BelowAndAboveTheBarrier) {
  Random random(11);
  for (int trial = 0; trial < 2000; ++trial) {
    const double mass = std::exp2(random.uniform(-3, 3));
    const double speed = std::exp2(random.uniform(-3, 3));
    const double height = std::exp2(random.uniform(-6, 6));
    const double thickness = std::exp2(random.uniform(-4, 2));
    const double hbar = std::exp2(random.uniform(-2, 2));
    SCOPED_TRACE(testing::Message() << "trial " << trial << ": m " << mass << " v " << speed << " V "
                                    << height << " a " << thickness << " hbar " << hbar);
    const Wide exact = textbook_transmission(mass, speed, height, thickness, hbar);
    // As far as the formula itself moves when its inputs are off by a few roundings, and the last ones.
    const Wide off = 1 + 8 * Wide{kEpsilon};
    const Wide tolerance =
        8 * Wide{kEpsilon} * exact +
        std::abs(textbook_transmission(mass, speed * off, height, thickness, hbar) - exact) +
        std::abs(textbook_transmission(mass, speed, height * off, thickness, hbar) - exact) +
        std::abs(textbook_transmission(mass, speed, height, thickness * off, hbar) - exact);
    EXPECT_LE(std::abs(Wide{transmission(barrier_of(height, thickness, hbar), mass, speed)} - exact),
              tolerance);
  }
}

TEST(Transmission, MatchesTheTextbook_AtTheTopOfTheBarrier) {
  // m = 2, v = 3: E = 9 without rounding.
  for (const double thickness : {1e-3, 0.1, 1.0, 7.0, 1e4}) {
    const auto exact = static_cast<double>(textbook_transmission(2, 3, 9, thickness, 1.5));
    EXPECT_NEAR(transmission(barrier_of(9.0, thickness, 1.5), 2.0, 3.0), exact, 8.0 * kEpsilon * exact);
  }
}

TEST(Transmission, OfAllOnes_AtHalfTheHeight) {
  // V²/(4 E (V-E)) = 1 and κa = 1: T = 1/(1 + sinh² 1) = 1/cosh² 1, tabulated as 0.41997.
  const double got = transmission(barrier_of(1.0, 1.0, 1.0), 1.0, 1.0);
  EXPECT_NEAR(got, 1.0 / (std::cosh(1.0) * std::cosh(1.0)), 8.0 * kEpsilon);
  EXPECT_NEAR(got, 0.41997, 5e-6);
}

TEST(Transmission, IsAProbability_AtTheExtremes) {
  const double hbar_Js = 1.054571817e-34;
  for (const double hbar : {hbar_Js, 1e-200, 1.0, 1e200}) {
    for (const double height : {0.0, 1e-300, 0.5, 2.0, 1e300}) {
      for (const double thickness : {1e-100, 1.0, 1e100}) {
        for (const double mass : {9.109e-31, 1.0, 1e30}) {
          for (const double speed : {0.0, 1e-160, 1e-10, 1.0, 2.0, 3e8}) {
            const double got = transmission(barrier_of(height, thickness, hbar), mass, speed);
            ASSERT_TRUE(got >= 0.0 && got <= 1.0) << got << " for hbar " << hbar << ", V " << height << ", a "
                                                  << thickness << ", m " << mass << ", v " << speed;
          }
        }
      }
    }
  }
  // A thing of everyday size never passes what it could not climb, and is not aware of what it can.
  EXPECT_EQ(transmission(barrier_of(1.0, 1.0, hbar_Js), 1.0, 1.0), 0.0);
  EXPECT_NEAR(transmission(barrier_of(1e-12, 1.0, hbar_Js), 1.0, 1.0), 1.0, 1e-20);
}

struct Beam {
  std::string name;
  double speed_mps;  ///< against a barrier of all ones
};

std::ostream& operator<<(std::ostream& out, const Beam& beam) {
  return out << beam.name;
}

class BarriersInBeam : public testing::TestWithParam<std::tuple<std::string, Beam>> {
 protected:
  static std::string evolver() { return std::get<0>(GetParam()); }
  static double speed() { return std::get<1>(GetParam()).speed_mps; }

  static constexpr std::size_t kBalls = 20'000;
  static constexpr double kBeamRadius_m = 0.05;
  static constexpr double kAlong_mps = 0.25;

  /// Balls of 1 kg that go through each other towards a barrier 1 J high and 1 m thick, in a row.
  static Scenario beam(std::uint64_t seed, std::size_t balls = kBalls) {
    std::vector<Ball> row;
    for (std::size_t i = 0; i < balls; ++i) {
      const double start_m = -2.0 - static_cast<double>(i % 64) / 64.0;
      row.push_back(ball_at(Vec3(start_m, 0, 0), Vec3(speed(), kAlong_mps, 0), kBeamRadius_m));
    }
    Scenario scene = free_scene(2, row, 4.0 / speed(), 0.01);
    scene.effects.collisions = false;
    scene.barriers = {barrier_of(1.0, 1.0, 1.0, seed)};
    return scene;
  }

  static std::vector<bool> passed(const std::string& evolver, const Scenario& scene, std::int64_t steps) {
    const auto simulation = compose(scene, {evolver, ""});
    std::vector<bool> outcome;
    for (const BallState& state : run(*simulation, scene, steps)) outcome.push_back(state.position.x() > 0.0);
    return outcome;
  }

  static double share(const std::vector<bool>& outcome) {
    return static_cast<double>(std::count(outcome.begin(), outcome.end(), true)) /
           static_cast<double>(outcome.size());
  }

  static constexpr std::int64_t kSteps = 20;
  static constexpr double kSigmas = 4.0;  // one in 16,000 by chance; the seeds are fixed
};

TEST_P(BarriersInBeam, PassTheShareOfBallsThatTheFormulaGives) {
  const Wide expected = textbook_transmission(1, speed(), 1, 1, 1);
  const double sigma = static_cast<double>(std::sqrt(expected * (1 - expected) / kBalls));
  const auto outcome = passed(evolver(), beam(3), kSteps);
  EXPECT_NEAR(share(outcome), static_cast<double>(expected), kSigmas * sigma);
}

TEST_P(BarriersInBeam, DecideBallByBallAlike_WhateverTheEvolverAndTheStep) {
  const Scenario scene = beam(3);
  const auto outcome = passed(evolver(), scene, kSteps);
  EXPECT_EQ(outcome, passed("toi", scene, 1));
  EXPECT_EQ(outcome, passed("toi", scene, 7));
  EXPECT_EQ(outcome, passed("step", scene, 29));
}

TEST_P(BarriersInBeam, DecideBallByBallAlike_WhateverTheOthersDo) {
  const auto outcome = passed(evolver(), beam(3), kSteps);
  // Every other ball waits; and half as many balls.
  Scenario waiting = beam(3);
  for (std::size_t i = 0; i < kBalls; i += 2) waiting.balls[i].velocity = Vec3::Zero();
  const auto others = passed(evolver(), waiting, kSteps);
  for (std::size_t i = 1; i < kBalls; i += 2) ASSERT_EQ(others[i], outcome[i]) << "ball " << i;
  const auto fewer = passed(evolver(), beam(3, kBalls / 2), kSteps);
  EXPECT_TRUE(std::equal(fewer.begin(), fewer.end(), outcome.begin()));
}

TEST_P(BarriersInBeam, DecideAnew_WithAnotherSeed) {
  const auto one = passed(evolver(), beam(3), kSteps);
  const auto other = passed(evolver(), beam(4), kSteps);
  double different = 0.0;
  for (std::size_t i = 0; i < kBalls; ++i) different += one[i] != other[i] ? 1.0 : 0.0;
  // Independent draws differ with probability 2T(1-T).
  const auto t = static_cast<double>(textbook_transmission(1, speed(), 1, 1, 1));
  const double expected = 2.0 * t * (1.0 - t);
  const double sigma = std::sqrt(expected * (1.0 - expected) / kBalls);
  EXPECT_NEAR(different / kBalls, expected, kSigmas * sigma);
}

TEST_P(BarriersInBeam, KeepTheVelocityOfThoseThatPass_MirrorTheOthers_AndAccountForIt) {
  const Scenario scene = beam(3, 1000);
  const auto simulation = compose(scene, {evolver(), ""});
  const auto states = run(*simulation, scene, kSteps);
  Vec3 angular = Vec3::Zero();
  double reflected = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const bool passes = states[i].position.x() > 0.0;
    EXPECT_EQ(states[i].velocity, Vec3(passes ? speed() : -speed(), kAlong_mps, 0.0)) << "ball " << i;
    reflected += passes ? 0.0 : 1.0;
    angular +=
        states[i].position.cross(states[i].velocity) - scene.balls[i].position.cross(scene.balls[i].velocity);
  }
  const Tally tally = simulation->tally();
  EXPECT_EQ(tally.impacts, 1000);
  const Vec3 impulse(-2.0 * speed() * reflected, 0.0, 0.0);
  EXPECT_LE((tally.external_impulse - impulse).norm(), 1000 * kEpsilon * impulse.norm());
  // Each ball's account is off by its rounding. `step` also moves balls out of what they overlap, which is no
  // impulse and in no account.
  if (evolver() == "toi") {
    EXPECT_LE((tally.external_angular_impulse - angular).norm(), 1000 * rounding_of(kSteps, 4.0 * speed()));
  }
}

TEST_P(BarriersInBeam, LetABallAppearAtTheOtherFace_WhenItPasses) {
  Scenario scene = beam(0, 1);
  scene.barriers[0].height = 0.0;  // nothing in the way: T = 1
  const auto simulation = compose(scene, {evolver(), ""});
  const double jump = scene.barriers[0].thickness + 2.0 * kBeamRadius_m;
  const BallState end = run(*simulation, scene, kSteps).front();
  EXPECT_NEAR(end.position.x(), -2.0 + 4.0 + jump, rounding_of(kSteps, 4.0));
  EXPECT_NEAR(end.position.y(), kAlong_mps * scene.duration_s, rounding_of(kSteps, 4.0));
  EXPECT_EQ(end.velocity, scene.balls[0].velocity);
  EXPECT_EQ(simulation->tally().impacts, 1);
}

INSTANTIATE_TEST_SUITE_P(
    Evolvers, BarriersInBeam,
    testing::Combine(testing::Values("toi", "step"),
                     testing::Values(Beam{"below", 1.0}, Beam{"at_the_top", std::numbers::sqrt2},
                                     Beam{"above", 2.0})),
    [](const auto& info) { return std::get<0>(info.param) + "_" + std::get<1>(info.param).name; });

/// Balls that go through each other in a box that a lying barrier parts, under gravity.
Scenario falling_through_a_barrier(int dimension, std::uint64_t seed, double restitution) {
  Random random(seed);
  Scenario scene = free_scene(dimension, {}, 5.0, 0.01);
  for (int k = 0; k < 30; ++k) {
    Vec3 place = random_vector(random, dimension, 0.8);
    place.y() = random.uniform(0.6, 1.8) * (k % 2 == 0 ? 1.0 : -1.0);
    scene.balls.push_back(ball_at(place, random_vector(random, dimension, 5.0)));
    scene.balls.back().mass = random.uniform(0.5, 2.0);
  }
  scene.effects.collisions = false;
  scene.effects.gravity = Vec3(0.5, -9.81, 0.0);
  scene.wall_contact.restitution = restitution;
  scene.barriers = {{Vec3(5, 12, 0) / 13, 0.0, 0.2, random.uniform(5.0, 20.0), 0.3, seed}};
  for (int axis = 0; axis < dimension; ++axis) {
    const double half = axis == 1 ? 3.0 : 1.0;
    scene.walls.push_back({Vec3::Unit(axis), -half});
    scene.walls.push_back({-Vec3::Unit(axis), -half});
  }
  return scene;
}

class BarriersUnderGravity : public testing::TestWithParam<int> {
 protected:
  static double energy_of(const Scenario& scene, const std::vector<BallState>& states) {
    double sum = kinetic_energy_of(scene, states);
    for (std::size_t i = 0; i < states.size(); ++i) {
      sum -= scene.balls[i].mass * scene.effects.gravity->dot(states[i].position);
    }
    return sum;
  }

  /// What rounding may add up to: each step and each impact rounds each ball's energy a few times, which is
  /// at most its share of what all have against the floor.
  static double rounding_of_energy(const Scenario& scene, double roundings) {
    double scale = 0.0;
    for (const Ball& ball : scene.balls) {
      scale += ball.mass * (0.5 * ball.velocity.squaredNorm() + scene.effects.gravity->norm() * 4.0);
    }
    return 8.0 * std::numeric_limits<double>::epsilon() * roundings * scale;
  }
};

TEST_P(BarriersUnderGravity, KeepTheEnergy_WhereverBallsPass) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const Scenario scene = falling_through_a_barrier(GetParam(), seed, 1.0);
    const auto simulation = compose(scene, {"toi", ""});
    const auto states = run(*simulation, scene, 500);
    const auto impacts = static_cast<double>(simulation->tally().impacts);
    EXPECT_NEAR(energy_of(scene, states), energy_of(scene, states_of(scene)),
                rounding_of_energy(scene, 500.0 + impacts));
    int passed = 0;
    for (std::size_t i = 0; i < states.size(); ++i) {
      const Vec3& normal = scene.barriers[0].normal;
      passed += normal.dot(states[i].position) * normal.dot(scene.balls[i].position) < 0.0 ? 1 : 0;
    }
    EXPECT_GT(passed, 0);
    // What the barrier and the walls have pushed is in the account.
    Vec3 momentum = momentum_of(scene, states_of(scene)) + simulation->tally().external_impulse;
    double scale = 0.0;
    for (const Ball& ball : scene.balls) {
      momentum += scene.duration_s * ball.mass * *scene.effects.gravity;
      scale += ball.mass * (ball.velocity.norm() + 12.0);  // m/s, of a fall through the box
    }
    EXPECT_LE((momentum_of(scene, states) - momentum).norm(),
              8.0 * std::numeric_limits<double>::epsilon() * (500.0 + impacts) * scale);
  }
}

TEST_P(BarriersUnderGravity, NeverGainEnergy_WithLossyWalls) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const Scenario scene = falling_through_a_barrier(GetParam(), seed, 0.5);
    const auto simulation = compose(scene, {"toi", ""});
    double last = energy_of(scene, states_of(scene));
    for (int k = 0; k < 500; ++k) {
      simulation->advance(0.01, 1);
      const double now = energy_of(scene, states_of(*simulation, scene.balls.size()));
      ASSERT_LE(now, last + rounding_of_energy(scene, 4.0)) << "step " << k;
      last = now;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, BarriersUnderGravity, testing::Values(2, 3));

TEST(Barriers, AreMetAgainAndAgain_AlikeAtAnyStep) {
  // In a box, so that each ball is decided on some ten times, also within one step.
  Random random(21);
  std::vector<Ball> balls;
  for (int k = 0; k < 200; ++k) {
    const Vec3 place(random.uniform(-1.8, -0.5), random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9));
    balls.push_back(ball_at(place, random_vector(random, 3, 2.0)));
  }
  Scenario scene = free_scene(3, balls, 20.0, 0.01);
  scene.effects.collisions = false;
  scene.barriers = {barrier_of(1.0, 0.5, 1.0, 5)};
  for (int axis = 0; axis < 3; ++axis) {
    const double half = axis == 0 ? 2.0 : 1.0;
    scene.walls.push_back({Vec3::Unit(axis), -half});
    scene.walls.push_back({-Vec3::Unit(axis), -half});
  }
  const std::int64_t fine = 2000;
  const auto simulation = compose(scene, {"toi", ""});
  std::vector<BallState> before = states_of(scene);
  int passages = 0;
  for (std::int64_t k = 0; k < fine; ++k) {
    simulation->advance(scene.duration_s / fine, 1);
    const auto now = states_of(*simulation, before.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
      passages += before[i].position.x() * now[i].position.x() < 0.0 ? 1 : 0;
    }
    before = now;
  }
  EXPECT_GT(passages, 400);
  for (const std::int64_t steps : {1, 50}) {
    const auto coarse = compose(scene, {"toi", ""});
    const auto states = run(*coarse, scene, steps);
    EXPECT_EQ(coarse->tally().impacts, simulation->tally().impacts);
    for (std::size_t i = 0; i < states.size(); ++i) {
      EXPECT_LE((states[i].position - before[i].position).norm(), rounding_of(fine, 40.0)) << "ball " << i;
      EXPECT_EQ(states[i].velocity, before[i].velocity) << "ball " << i;
    }
  }
}

// --- friction in contact that lasts

constexpr double kRadius_m = 0.1;
constexpr double kFriction = 0.2;
constexpr double kAroundRolling = 3.5;  // 1 + m r²/I of a solid sphere

/// A solid sphere on a rough plane through the origin, under gravity.
Scenario on_plane(int dimension, const Vec3& normal, const Vec3& gravity, const Vec3& velocity) {
  Scenario scene = free_scene(dimension, {ball_at(kRadius_m * normal, velocity, kRadius_m)}, 1.0, 0.01);
  scene.balls[0].mass = 1.5;
  scene.effects.gravity = gravity;
  scene.effects.spin = true;
  scene.walls = {{normal, 0.0}};
  scene.wall_contact = {0.5, kFriction, 0.0};
  return scene;
}

/// The spin with which a ball rolls: v + ω × (-r n) = 0.
Vec3 rolling_spin(const Vec3& normal, const Vec3& velocity) {
  return normal.cross(velocity) / kRadius_m;
}

class OnRoughPlane : public testing::TestWithParam<std::int64_t> {
 protected:
  static std::int64_t steps() { return GetParam(); }

  /// `toi` is right to rounding whatever its step: so also to that of speeds below 10 m/s, and of spins,
  /// which are these over the radius. `step` is off by what a step brings of the acceleration that acts along
  /// the plane; of a place, for as long as the flight lasts.
  static void expect(const Scenario& scene, const BallState& expected, double acceleration_mps2) {
    for (const std::string evolver : {"toi", "step"}) {
      SCOPED_TRACE(evolver);
      const auto simulation = compose(scene, {evolver, ""});
      const BallState end = run(*simulation, scene, steps()).front();
      const double order_one = acceleration_mps2 * scene.duration_s / static_cast<double>(steps());
      const double off = (evolver == "toi" ? 0.0 : order_one) + rounding_of(steps(), 10.0);
      EXPECT_LE((end.position - expected.position).norm(), off * scene.duration_s);
      EXPECT_LE((end.velocity - expected.velocity).norm(), off);
      EXPECT_LE((end.spin - expected.spin).norm(), off / kRadius_m);
    }
  }
};

struct Floor {
  int dimension;
  Vec3 normal;
};

const std::vector<Floor>& floors() {
  static const std::vector<Floor> floors = {{2, Vec3::UnitY()}, {3, Vec3::UnitZ()}, {3, Vec3(2, -3, 6) / 7}};
  return floors;
}

TEST_P(OnRoughPlane, SlidingBall_RollsAfterTwoSeventhsOfTheWayToItsStop) {
  // Friction slows it by μg and turns it up; it rolls at t = 2 v_0/(7 μ g), v = 5/7 v_0.
  const double v0 = 2.0;
  const double rolls_s = v0 / (kAroundRolling * kFriction * kGravity);
  const double way_m = v0 * rolls_s - 0.5 * kFriction * kGravity * rolls_s * rolls_s;
  for (const auto& [dimension, normal] : floors()) {
    SCOPED_TRACE(testing::Message() << dimension << "D, normal " << normal.transpose());
    const Vec3 along = dimension == 2 ? Vec3(Vec3::UnitX()) : normal.unitOrthogonal();
    const Scenario scene = on_plane(dimension, normal, -kGravity * normal, v0 * along);
    const Vec3 v = 5.0 / 7.0 * v0 * along;
    const Vec3 x = scene.balls[0].position + way_m * along + (scene.duration_s - rolls_s) * v;
    expect(scene, {x, v, rolling_spin(normal, v)}, kFriction * kGravity);
  }
}

/// A plane that descends to the right, and the way down it.
struct Incline {
  Vec3 normal;
  Vec3 down;
};

Incline incline(double slope) {
  const double angle = std::atan(slope);
  return {Vec3(std::sin(angle), std::cos(angle), 0), Vec3(std::cos(angle), -std::sin(angle), 0)};
}

TEST_P(OnRoughPlane, BallOnAnIncline_RollsBelowTheCriticalSlope) {
  // It rolls at 5/7 g sin α where 2/7 g sin α <= μ g cos α, so up to the slope 3.5 μ.
  const double slope = 0.9 * kAroundRolling * kFriction;
  const auto [normal, down] = incline(slope);
  const Vec3 gravity(0, -kGravity, 0);
  const double pull = gravity.dot(down);
  for (const int dimension : {2, 3}) {
    SCOPED_TRACE(testing::Message() << dimension << "D");
    const Scenario scene = on_plane(dimension, normal, gravity, Vec3::Zero());
    const double t = scene.duration_s;
    const Vec3 v = 5.0 / 7.0 * pull * t * down;
    expect(scene, {scene.balls[0].position + 0.5 * t * v, v, rolling_spin(normal, v)}, pull);
  }
}

TEST_P(OnRoughPlane, BallOnAnIncline_SlidesAboveTheCriticalSlope) {
  // At g (sin α - μ cos α), and friction turns it by 5/2 μ g cos α/r.
  const double slope = 1.2 * kAroundRolling * kFriction;
  const auto [normal, down] = incline(slope);
  const Vec3 gravity(0, -kGravity, 0);
  const double pull = gravity.dot(down);
  const double drag = -kFriction * gravity.dot(normal);
  for (const int dimension : {2, 3}) {
    SCOPED_TRACE(testing::Message() << dimension << "D");
    const Scenario scene = on_plane(dimension, normal, gravity, Vec3::Zero());
    const double t = scene.duration_s;
    const Vec3 v = (pull - drag) * t * down;
    expect(scene, {scene.balls[0].position + 0.5 * t * v, v, rolling_spin(normal, 2.5 * drag * t * down)},
           pull);
  }
}

INSTANTIATE_TEST_SUITE_P(Steps, OnRoughPlane, testing::Values(1, 7, 100, 3000));

TEST(RoughBox, LeavesSpinAboutItsNormals) {
  // Dropped on its lowest point with a spin about the vertical: nothing there slips.
  for (const std::string evolver : {"toi", "step"}) {
    SCOPED_TRACE(evolver);
    Scenario scene = on_plane(3, Vec3::UnitZ(), Vec3(0, 0, -kGravity), Vec3::Zero());
    scene.walls.push_back({Vec3::UnitX(), -1.0});
    scene.walls.push_back({-Vec3::UnitX(), -1.0});
    scene.duration_s = 3.0;
    scene.balls[0].position.z() = 1.0;
    scene.balls[0].spin = Vec3(0, 0, 20.0);
    const auto simulation = compose(scene, {evolver, ""});
    const BallState end = run(*simulation, scene, 600).front();
    EXPECT_GT(simulation->tally().impacts, 3);
    EXPECT_EQ(end.spin, scene.balls[0].spin);
    EXPECT_EQ(end.position.head<2>(), scene.balls[0].position.head<2>());
    EXPECT_NEAR(end.position.z(), kRadius_m, 1e-4);
  }
}

}  // namespace
}  // namespace carom::test
