#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/random.h"
#include "reference/exact/polynomial.h"
#include "reference/exact/run.h"
#include "tests/support/numbers.h"

namespace carom::exact {
namespace {

using test::kInfinity;

constexpr int kDigits = 60;

Real power_of_ten(int exponent) {
  return pow(Real(10), exponent);
}

carom::Ball random_ball(Random& random, const Vec3& place, double speed_mps) {
  carom::Ball ball;
  ball.mass = random.uniform(0.5, 3.0);
  ball.radius = random.uniform(0.1, 0.2);
  ball.position = place;
  ball.inertia = random.uniform(0.2, 0.6);
  for (int axis = 0; axis < 3; ++axis) {
    ball.velocity[axis] = random.uniform(-speed_mps, speed_mps);
    ball.spin[axis] = random.uniform(-5.0, 5.0);
  }
  return ball;
}

/// 27 balls on a lattice; in a box of 3 m or, without one, all flying towards the middle.
Scenario crowd(bool box, double duration_s, std::uint64_t seed) {
  Random random(seed);
  Scenario scene;
  scene.dimension = 3;
  scene.duration_s = duration_s;
  scene.effects.spin = true;
  for (int n = 0; n < 27; ++n) {
    const Vec3 cell(n % 3 + 0.5, n / 3 % 3 + 0.5, n / 9 + 0.5);
    scene.balls.push_back(random_ball(random, cell, box ? 1.0 : 0.2));
    if (!box) scene.balls.back().velocity += Vec3(1.5, 1.5, 1.5) - cell;
  }
  for (int axis = 0; box && axis < 3; ++axis) {
    scene.walls.push_back({Vec3::Unit(axis), 0.0});
    scene.walls.push_back({-Vec3::Unit(axis), -3.0});
  }
  return scene;
}

struct Sums {
  Real energy_J;
  Vector momentum_Ns;
  Vector angular_momentum_Nms;
};

/// With the potential energy m g·x; immovable balls do not count.
Sums sums_of(const Scenario& scene, const Run& run) {
  const Vector gravity(scene.effects.gravity.value_or(Vec3::Zero()));
  Sums sums;
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    if (std::isinf(scene.balls[i].mass)) continue;
    const Body body = run.state(i);
    const Real mass = scene.balls[i].mass;
    const Real turning = scene.balls[i].inertia * mass * scene.balls[i].radius * scene.balls[i].radius;
    sums.energy_J += mass * dot(body.velocity_mps, body.velocity_mps) / 2;
    sums.energy_J += turning * dot(body.spin_radps, body.spin_radps) / 2;
    sums.energy_J -= mass * dot(gravity, body.position_m);
    sums.momentum_Ns += body.velocity_mps * mass;
    sums.angular_momentum_Nms += cross(body.position_m, body.velocity_mps) * mass + body.spin_radps * turning;
  }
  return sums;
}

/// The rest of a sum of up to a few hundred numbers of size 1 to 10, each rounded some hundred times at most
/// to kDigits: 10⁵ roundings. Where the sum is conserved errors of states, which grow, do not show.
Real rounding() {
  return power_of_ten(5 - kDigits);
}

TEST(ExactRun, ConservesToItsLastDigits_PerfectlyRoughElasticBalls) {
  const Digits digits(kDigits);
  Scenario scene = crowd(false, 2.0, 1);
  // β0 = 1 turns the slip round where the surfaces stick, and they always do: nothing is lost.
  scene.ball_contact = {1.0, 1e6, 1.0};
  Budget budget{1'000'000'000};
  exact::Run run(scene, digits, scene.duration_s, budget);
  ASSERT_TRUE(run.follow({scene.duration_s, 0}));
  const Sums before = sums_of(scene, run);
  ASSERT_TRUE(run.follow({scene.duration_s, 1}));
  const Sums after = sums_of(scene, run);
  EXPECT_GE(run.impacts().size(), 20U);
  EXPECT_LE(abs(after.energy_J - before.energy_J), rounding());
  EXPECT_LE(length(after.momentum_Ns - before.momentum_Ns), rounding());
  EXPECT_LE(length(after.angular_momentum_Nms - before.angular_momentum_Nms), rounding());
}

TEST(ExactRun, ConservesMomentumAndLosesEnergy_RoughLossyBalls) {
  const Digits digits(kDigits);
  Scenario scene = crowd(false, 2.0, 2);
  scene.ball_contact = {0.8, 0.3, 0.4};
  Budget budget{1'000'000'000};
  exact::Run run(scene, digits, scene.duration_s, budget);
  ASSERT_TRUE(run.follow({scene.duration_s, 0}));
  Sums before = sums_of(scene, run);
  const Vector angular_momentum = before.angular_momentum_Nms;
  const Vector momentum = before.momentum_Ns;
  std::size_t impacts = 0;
  for (int k = 1; k <= 50; ++k) {
    ASSERT_TRUE(run.follow({scene.duration_s / 50, k}));
    const Sums now = sums_of(scene, run);
    if (run.impacts().size() > impacts) {
      EXPECT_LT(now.energy_J, before.energy_J);
    }
    impacts = run.impacts().size();
    before = now;
  }
  EXPECT_GE(impacts, 20U);
  EXPECT_LE(length(before.momentum_Ns - momentum), rounding());
  EXPECT_LE(length(before.angular_momentum_Nms - angular_momentum), rounding());
}

TEST(ExactRun, ComesBack_WhenTurnedRound) {
  const Digits digits(kDigits);
  for (const bool gravity : {false, true}) {
    Scenario scene = crowd(true, 8.0, 3);
    scene.ball_contact = scene.wall_contact = {1.0, 1e6, 1.0};
    if (gravity) scene.effects.gravity = Vec3(0.5, -2.0, 0.0);
    Budget budget{1'000'000'000};
    const Moment there{scene.duration_s / 2, 1};
    const Moment back{scene.duration_s / 2, 2};
    exact::Run run(scene, digits, scene.duration_s, budget);
    ASSERT_TRUE(run.follow(there));
    const std::size_t impacts = run.impacts().size();
    EXPECT_GE(impacts, 50U);
    run.turn_round();
    ASSERT_TRUE(run.follow(back));
    EXPECT_EQ(run.impacts().size(), 2 * impacts);
    // A ball has about ten impacts each way, and each costs a digit or two: less than 25 digits are lost.
    for (std::size_t i = 0; i < scene.balls.size(); ++i) {
      EXPECT_LE(length(run.state(i).position_m - Vector(scene.balls[i].position)),
                power_of_ten(25 - kDigits));
      EXPECT_LE(length(run.state(i).velocity_mps + Vector(scene.balls[i].velocity)),
                power_of_ten(25 - kDigits));
    }
  }
}

TEST(ExactRun, BallsFallOnImmovableOnes_KeepEnergyAndDistance) {
  const Digits digits(kDigits);
  Random random(5);
  for (int n = 0; n < 10; ++n) {
    Scenario scene;
    scene.dimension = 3;
    scene.duration_s = 2.0;
    scene.effects.gravity = Vec3(0, -9.81, 0);
    for (const double x : {-0.6, 0.0, 0.6}) {
      carom::Ball peg;
      peg.mass = kInfinity;
      peg.radius = 0.25;
      peg.position = Vec3(x, 0, 0);
      scene.balls.push_back(peg);
    }
    scene.balls.push_back(random_ball(random, Vec3(random.uniform(-0.5, 0.5), 1.0, 0), 0.3));
    scene.walls = {{Vec3::UnitY(), -1.0}};
    Budget budget{1'000'000'000};
    exact::Run run(scene, digits, scene.duration_s, budget);
    ASSERT_TRUE(run.follow({0.01, 0}));
    const Real energy = sums_of(scene, run).energy_J;
    for (int k = 1; k <= 200; ++k) {
      ASSERT_TRUE(run.follow({0.01, k}));
      EXPECT_LE(abs(sums_of(scene, run).energy_J - energy), rounding());
      for (std::size_t peg = 0; peg < 3; ++peg) {
        EXPECT_EQ(run.state(peg).position_m.c[0], scene.balls[peg].position.x());
        const Real distance = length(run.state(3).position_m - run.state(peg).position_m);
        EXPECT_GE(distance, Real(0.25) + scene.balls[3].radius - rounding());
      }
    }
    EXPECT_GE(run.impacts().size(), 2U);
  }
}

TEST(ExactRun, PushOfWalls_AccountsForMomentum) {
  const Digits digits(kDigits);
  Scenario scene = crowd(true, 3.0, 4);
  scene.wall_contact = scene.ball_contact = {0.9, 0.2, 0.3};
  scene.balls[13].mass = kInfinity;
  scene.balls[13].velocity = Vec3::Zero();
  Budget budget{1'000'000'000};
  exact::Run run(scene, digits, scene.duration_s, budget);
  ASSERT_TRUE(run.follow({scene.duration_s, 0}));
  const Sums before = sums_of(scene, run);
  ASSERT_TRUE(run.follow({scene.duration_s, 1}));
  const Sums after = sums_of(scene, run);
  const Tally tally = run.tally();
  // What is left is the rounding of the sums to doubles; they are no larger than 100.
  const double rest = 100.0 * std::numeric_limits<double>::epsilon();
  EXPECT_LE((rounded(after.momentum_Ns - before.momentum_Ns) - tally.external_impulse).norm(), rest);
  EXPECT_LE(
      (rounded(after.angular_momentum_Nms - before.angular_momentum_Nms) - tally.external_angular_impulse)
          .norm(),
      rest);
}

/// When two balls, or a ball and a wall, meet in all digits; nothing before the end.
std::optional<Real> meeting_s(const Setting& setting, const std::vector<Body>& bodies, std::size_t ball,
                              const Prospect& prospect, const Real& end_s) {
  const Slack slack{power_of_ten(-30), power_of_ten(-30)};
  const Body& own = bodies[ball];
  const Vector fall = setting.falls(ball) ? setting.gravity_mps2 : Vector(0, 0, 0);
  if (prospect.wall) {
    const Plane& wall = setting.walls[prospect.partner];
    const Real gap = dot(own.position_m, wall.normal) - wall.offset_m - setting.matter[ball].radius_m;
    return wall_reached(gap, dot(own.velocity_mps, wall.normal), dot(fall, wall.normal), slack);
  }
  const std::size_t k = prospect.partner;
  const Body& other = bodies[k];
  Relative motion{other.position_m - own.position_m,
                  other.velocity_mps - own.velocity_mps,
                  {0, 0, 0},
                  setting.falls(ball) != setting.falls(k)};
  motion.a = (setting.falls(k) ? setting.gravity_mps2 : Vector(0, 0, 0)) - fall;
  return balls_meet(motion, setting.matter[ball].radius_m + setting.matter[k].radius_m, slack, end_s);
}

TEST(ExactShadow, IsNeverTooLate_AndLeavesNobodyOut) {
  const Digits digits(kDigits);
  Random random(7);
  int meetings = 0;
  for (int n = 0; n < 300; ++n) {
    Scenario scene;
    scene.dimension = 3;
    scene.duration_s = 4.0;
    if (n % 2 == 0) scene.effects.gravity = Vec3(0, -1.0, 0.2);
    // Some far from the origin, some very small, some very fast; some immovable.
    const Vec3 origin = n % 3 == 0 ? Vec3(1e6, -1e7, 1e5) : Vec3(0, 0, 0);
    const double size = n % 5 == 0 ? 1e-6 : 1.0;
    for (int k = 0; k < 6; ++k) {
      const Vec3 place(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      carom::Ball ball = random_ball(random, origin + size * place, n % 7 == 0 ? 1e3 * size : size);
      ball.radius *= size;
      if (k == 0) ball.mass = kInfinity;
      scene.balls.push_back(ball);
    }
    scene.walls = {{Vec3(0.6, 0.8, 0.0), Vec3(0.6, 0.8, 0.0).dot(origin) - 3.0 * size}};
    const Setting setting(scene);
    std::vector<Body> bodies;
    Shadow shadow(scene, setting, scene.duration_s);
    for (std::size_t i = 0; i < scene.balls.size(); ++i) {
      const carom::Ball& ball = scene.balls[i];
      bodies.push_back({0, Vector(ball.position), Vector(ball.velocity), Vector(ball.spin)});
      shadow.set(i, bodies.back());
    }
    shadow.advance(0.0);
    std::vector<Prospect> prospects;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      shadow.prospects(i, prospects);
      const auto earliest_s = [&](std::uint32_t partner, bool wall) {
        const auto found = std::find_if(prospects.begin(), prospects.end(), [&](const Prospect& p) {
          return p.partner == partner && p.wall == wall;
        });
        return found == prospects.end() ? kInfinity : found->earliest_s;
      };
      for (std::uint32_t k = 0; k <= bodies.size(); ++k) {
        const bool wall = k == bodies.size();
        if (k == i || (wall && i == 0)) continue;  // nothing stops the immovable one at a wall
        const std::uint32_t partner = wall ? 0 : k;
        const auto time_s = meeting_s(setting, bodies, i, {0.0, partner, wall}, scene.duration_s);
        if (!time_s || *time_s > scene.duration_s) continue;
        EXPECT_LE(earliest_s(partner, wall), *time_s);
        ++meetings;
      }
    }
  }
  EXPECT_GE(meetings, 1000);
}

/// c (x - z_0) (x - z_1) …, by powers.
std::vector<Real> with_zeros(const std::vector<double>& zeros, double factor) {
  std::vector<Real> powers = {Real(factor)};
  for (const double zero : zeros) {
    powers.insert(powers.begin(), Real(0));
    for (std::size_t k = 0; k + 1 < powers.size(); ++k) powers[k] -= powers[k + 1] * zero;
  }
  return powers;
}

TEST(ExactPolynomial, FindsAllZeros_UpToDegreeFour) {
  const Digits digits(kDigits);
  Random random(6);
  for (int n = 0; n < 200; ++n) {
    std::vector<double> zeros;
    zeros.reserve(static_cast<std::size_t>(1 + n % 4));
    for (int k = 0; k < 1 + n % 4; ++k) zeros.push_back(random.uniform(-1.0, 3.0));
    const std::vector<Real> powers = with_zeros(zeros, random.uniform(-2.0, 2.0));
    std::sort(zeros.begin(), zeros.end());
    std::erase_if(zeros, [](double zero) { return zero <= 0.0 || zero >= 2.0; });
    const std::vector<Real> found = sign_changes(powers, 2);
    ASSERT_EQ(found.size(), zeros.size());
    // Zeros of random polynomials are apart by more than 10⁻⁴, and lose so many digits for each other one.
    for (std::size_t k = 0; k < zeros.size(); ++k)
      EXPECT_LE(abs(found[k] - zeros[k]), power_of_ten(16 - kDigits));
  }
}

TEST(ExactPolynomial, FirstFall_IsNotARise) {
  const Digits digits(kDigits);
  const auto fall = first_fall(with_zeros({0.5, 1.0, 1.5}, 1.0), 2);  // rises, falls, rises
  ASSERT_TRUE(fall.has_value());
  EXPECT_LE(abs(*fall - 1), power_of_ten(5 - kDigits));
  EXPECT_FALSE(first_fall(with_zeros({0.5, 1.0}, 1.0), Real(0.4)).has_value());
}

}  // namespace
}  // namespace carom::exact
