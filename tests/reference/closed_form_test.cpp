#include "reference/closed_form/closed_form.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "reference/closed_form/motion.h"
#include "tests/support/numbers.h"

namespace carom::test {
namespace {

Ball ball(const Vec3& position, const Vec3& velocity = Vec3::Zero(), double mass = 1.0, double radius = 0.1) {
  return {.mass = mass, .radius = radius, .position = position, .velocity = velocity};
}

Ball on_x(double x, double v = 0.0, double mass = 1.0, double radius = 0.1) {
  return ball({x, 0, 0}, {v, 0, 0}, mass, radius);
}

Scenario scene(std::vector<Ball> balls, double duration_s = 10.0) {
  Scenario s;
  s.duration_s = duration_s;
  s.balls = std::move(balls);
  return s;
}

/// A ball whose lowest point is `height` over the floor y = 0.
Scenario drop(double height, double e, double vy = 0.0, double duration_s = 10.0) {
  Scenario s = scene({ball({0.3, height + 0.1, 0}, {0.25, vy, 0}, 2.0)}, duration_s);
  s.effects.gravity = Vec3(0, -kGravity, 0);
  s.walls = {{Vec3::UnitY(), 0.0}};
  s.wall_contact.restitution = e;
  return s;
}

/// A scene at one moment, reached in equal pieces.
struct Moment {
  std::vector<BallState> balls;
  Tally tally;
  double uncertainty_m = 0.0;
  std::string family;
};

Moment at(const Scenario& s, double time_s, std::int64_t pieces = 1) {
  const auto engine = make_closed_form_engine();
  const std::string reason = unsupported_reason(*engine, s, "faithful");
  EXPECT_EQ(reason, "");
  Moment moment;
  moment.balls.resize(s.balls.size());
  if (!reason.empty()) return moment;
  const auto simulation = engine->create(s, "faithful");
  if (time_s > 0.0) simulation->advance(time_s / static_cast<double>(pieces), pieces);
  simulation->snapshot(moment.balls);
  moment.tally = simulation->tally();
  moment.uncertainty_m = simulation->uncertainty_m();
  moment.family = std::get<std::string>(simulation->settings().at("family"));
  return moment;
}

std::string refusal(const Scenario& s) {
  return unsupported_reason(*make_closed_form_engine(), s, "faithful");
}

template <class Balls>
double energy(const Scenario& s, const Balls& states) {
  double sum = 0.0;
  for (std::size_t i = 0; i < s.balls.size(); ++i) {
    if (std::isfinite(s.balls[i].mass)) sum += 0.5 * s.balls[i].mass * states[i].velocity.squaredNorm();
  }
  return sum;
}

template <class Balls>
Vec3 momentum(const Scenario& s, const Balls& states) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < s.balls.size(); ++i) {
    if (std::isfinite(s.balls[i].mass)) sum += s.balls[i].mass * states[i].velocity;
  }
  return sum;
}

template <class Balls>
Vec3 angular_momentum(const Scenario& s, const Balls& states) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < s.balls.size(); ++i) {
    if (std::isfinite(s.balls[i].mass)) {
      sum += s.balls[i].mass * states[i].position.cross(states[i].velocity);
    }
  }
  return sum;
}

/// What rounding leaves of a sum of a few products of numbers no larger than `scale`, eight roundings.
double rounding(double scale) {
  return 8.0 * kEpsilon * scale;
}

// ---------------------------------------------------------------------------------------------- two balls

TEST(ClosedFormPair, HeadOnVelocities_AreExchanged_EqualMasses) {
  const Scenario s = scene({on_x(-1.0, 3.0), on_x(1.0, -2.0)});
  const Moment end = at(s, 10.0);
  EXPECT_EQ(end.balls[0].velocity, Vec3(-2.0, 0, 0));
  EXPECT_EQ(end.balls[1].velocity, Vec3(3.0, 0, 0));
  EXPECT_EQ(end.tally.impacts, 1);
  // The gap of 1.8 m closes at 5 m/s; equal balls go on as if they had passed through each other, and each is
  // a contact distance, 0.2 m, behind the one it stands for.
  EXPECT_NEAR(end.balls[0].position.x(), 1.0 - 20.0 - 0.2, end.uncertainty_m);
  EXPECT_NEAR(end.balls[1].position.x(), -1.0 + 30.0 + 0.2, end.uncertainty_m);
}

TEST(ClosedFormPair, EnergyLost_IsHalfReducedMassTimesNormalSpeed_AnyRestitution) {
  for (const double e : {0.0, 0.3, 0.9, 1.0}) {
    Scenario s = scene({ball({-1, 0, 0}, {2, 0, 0}, 3.0, 0.2), ball({1, 0.25, 0}, {-1, 0, 0}, 0.5, 0.3)});
    s.ball_contact.restitution = e;
    const Moment end = at(s, 10.0);
    const double reduced = 3.0 * 0.5 / 3.5;
    const double normal = 3.0 * std::sqrt(1.0 - 0.25);  // impact parameter 0.25 of a contact distance 0.5
    EXPECT_EQ(end.family, "two balls");
    EXPECT_NEAR(energy(s, s.balls) - energy(s, end.balls), 0.5 * reduced * (1 - e * e) * normal * normal,
                rounding(energy(s, s.balls)));
  }
}

TEST(ClosedFormPair, Directions_AreSixtyAndThirtyDegrees_AtHalfTheContactDistance) {
  const Scenario s = scene({ball({-2, 0.1, 0}, {1, 0, 0}), ball({0, 0, 0})});
  const Moment end = at(s, 10.0);
  const double root3 = std::numbers::sqrt3;
  EXPECT_LT((end.balls[0].velocity - Vec3(0.25, root3 / 4, 0)).norm(), rounding(1.0));
  EXPECT_LT((end.balls[1].velocity - Vec3(0.75, -root3 / 4, 0)).norm(), rounding(1.0));
}

TEST(ClosedFormPair, ImmovableBall_ReflectsTheOther_AndItsPushIsCounted) {
  for (const double wall_speed : {0.0, 0.5}) {
    Scenario s = scene({on_x(-1, 2, 3.0), on_x(1, -wall_speed, kInfinity)});
    s.balls[0].position.y() = s.balls[1].position.y() = 0.7;
    s.ball_contact.restitution = 0.5;
    s.balls[1].velocity.z() = 0.125;  // off the line, so that this family has to take it
    s.balls[1].position.z() = -0.125 * 1.8 / (2.0 + wall_speed);
    s.dimension = 3;
    const Moment end = at(s, 10.0);
    EXPECT_EQ(end.family, "two balls");
    EXPECT_NEAR(end.balls[0].velocity.x(), 2.0 - 1.5 * (2.0 + wall_speed), rounding(2.5));
    EXPECT_EQ(end.balls[1].velocity, s.balls[1].velocity);
    EXPECT_LT((momentum(s, end.balls) - momentum(s, s.balls) - end.tally.external_impulse).norm(),
              rounding(12.0));
    EXPECT_LT(
        (angular_momentum(s, end.balls) - angular_momentum(s, s.balls) - end.tally.external_angular_impulse)
            .norm(),
        rounding(30.0 * 6.0));
  }
}

TEST(ClosedFormPair, RelativeMotion_IsTheSame_WithAndWithoutGravity) {
  Scenario s = scene({ball({-1, 0, 0}, {2, 0, 0}), ball({1, 0.1, 0}, {-1, 0, 0}, 5.0)}, 3.0);
  const Moment free = at(s, 3.0);
  s.effects.gravity = Vec3(1, -kGravity, 0);
  const Moment falling = at(s, 3.0);
  const Vec3 apart = free.balls[1].position - free.balls[0].position;
  EXPECT_LT((falling.balls[1].position - falling.balls[0].position - apart).norm(),
            2.0 * (free.uncertainty_m + falling.uncertainty_m));
}

/// Two random balls that often meet; the seed is that of the test.
Scenario random_pair(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&](double size) -> Vec3 {
    return Vec3{unit(random), unit(random), unit(random)} * size;
  };
  Scenario s = scene({}, 4.0);
  s.dimension = 3;
  const Vec3 a = vector(1.0) - Vec3(2, 0, 0);
  const Vec3 b = vector(1.0) + Vec3(2, 0, 0);
  const double approach = 1.5 + unit(random);
  s.balls = {ball(a, (b - a) * approach + vector(0.6), std::pow(10.0, 3.0 * unit(random)), 0.4),
             ball(b, vector(0.6), std::pow(10.0, 3.0 * unit(random)), 0.2 * (1.5 + unit(random)))};
  s.balls[0].spin = vector(10.0);
  s.ball_contact.restitution = std::abs(unit(random));
  return s;
}

TEST(ClosedFormPair, MomentaAndSpin_AreConserved_RandomScenes) {
  constexpr std::uint64_t kSeed = 20240601;
  std::mt19937_64 random(kSeed);
  int met = 0;
  for (int k = 0; k < 300; ++k) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", scene " + std::to_string(k));
    const Scenario s = random_pair(random);
    const Moment end = at(s, 4.0);
    met += end.tally.impacts > 0 ? 1 : 0;
    const double mass = s.balls[0].mass + s.balls[1].mass;
    const double speed = 20.0;  // m/s, |b - a| < 7 m times 2.5/s and 1 more
    EXPECT_LT((momentum(s, end.balls) - momentum(s, s.balls)).norm(), rounding(mass * speed));
    EXPECT_LT((angular_momentum(s, end.balls) - angular_momentum(s, s.balls)).norm(),
              rounding(mass * speed * (4.0 + speed * 4.0)));
    EXPECT_LE(energy(s, end.balls), energy(s, s.balls) * (1.0 + 8.0 * kEpsilon));
    EXPECT_EQ(end.balls[0].spin, s.balls[0].spin);
    EXPECT_GE((end.balls[1].position - end.balls[0].position).norm(),
              s.balls[0].radius + s.balls[1].radius - 2.0 * end.uncertainty_m);
  }
  EXPECT_GT(met, 100);
}

TEST(ClosedFormPair, Impact_IsWhereBisectionFindsIt_RandomScenes) {
  constexpr std::uint64_t kSeed = 7;
  std::mt19937_64 random(kSeed);
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", scene " + std::to_string(k));
    const Scenario s = random_pair(random);
    const Vec3 d = s.balls[1].position - s.balls[0].position;
    const Vec3 u = s.balls[1].velocity - s.balls[0].velocity;
    const double reach = s.balls[0].radius + s.balls[1].radius;
    double high = -d.dot(u) / u.squaredNorm();  // the moment at which they are nearest
    const double nearest = (d + u * high).norm() / reach;
    if (high <= 0.0 || high > 3.0 || nearest > 0.99) continue;
    double low = 0.0;
    for (int i = 0; i < 60; ++i)
      ((d + u * (0.5 * (low + high))).norm() > reach ? low : high) = 0.5 * (low + high);
    const Vec3 n = (d + u * low) / reach;
    const double m = 1.0 / (1.0 / s.balls[0].mass + 1.0 / s.balls[1].mass);
    const Vec3 impulse = -(1.0 + s.ball_contact.restitution) * m * u.dot(n) * n;
    const Moment end = at(s, 4.0);
    // |d + u t| is right to ε |d|, so t to ε |d| / (|u| cos), cos² = 1 - nearest²; n to |u| / R times that.
    const double slope = u.norm() * std::sqrt(1.0 - nearest * nearest);
    const double n_error = 4.0 * kEpsilon * d.norm() * u.norm() / (slope * reach);
    for (const std::size_t i : {0U, 1U}) {
      const Ball& b = s.balls[i];
      const Vec3 jump = impulse * ((i == 0 ? -1.0 : 1.0) / b.mass);
      const Vec3 expected = b.position + b.velocity * 4.0 + jump * (4.0 - low);
      const double change = 2.0 * u.norm() * m / b.mass;
      EXPECT_LT((end.balls[i].position - expected).norm(),
                end.uncertainty_m + rounding(100.0) + 3.0 * change * n_error * 4.0);
    }
  }
}

TEST(ClosedFormPair, Outcome_IsTheSame_MirroredAndBoosted) {
  constexpr std::uint64_t kSeed = 99;
  std::mt19937_64 random(kSeed);
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", scene " + std::to_string(k));
    const Scenario s = random_pair(random);
    const Moment end = at(s, 4.0);
    Scenario mirrored = s;
    Scenario boosted = s;
    const Vec3 boost(0.5, -0.25, 2.0);
    for (std::size_t i = 0; i < 2; ++i) {
      mirrored.balls[i].position.x() *= -1.0;
      mirrored.balls[i].velocity.x() *= -1.0;
      boosted.balls[i].velocity += boost;
    }
    const Moment in_mirror = at(mirrored, 4.0);
    const Moment with_boost = at(boosted, 4.0);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(in_mirror.balls[i].position, end.balls[i].position.cwiseProduct(Vec3(-1, 1, 1)));
      // Adding the boost rounds the velocities, which a near graze magnifies: not compared where it is nearer
      // than 1 % to one; else by 1/√(1 - 0.99²) = 7 and the way over the contact distance, 80 m / 0.5 m.
      const double magnified = 8.0 * kEpsilon * 80.0 * 7.0 * (80.0 / 0.5);
      EXPECT_LT((with_boost.balls[i].position - boost * 4.0 - end.balls[i].position).norm(),
                with_boost.uncertainty_m + end.uncertainty_m + magnified);
    }
  }
}

TEST(ClosedFormPair, Scene_IsRefused_WhereTheFamilyEnds) {
  Scenario wall = scene({ball({-1, 0, 0}, {1, 0, 0}), ball({1, 0.1, 0}, {-1, 0, 0})});
  wall.walls = {{Vec3::UnitX(), -3.0}};
  EXPECT_EQ(refusal(wall), "no closed form: two balls, and ball 0 reaches a wall");
  wall.duration_s = 2.0;
  EXPECT_EQ(refusal(wall), "");
  EXPECT_EQ(refusal(scene({ball({0, 0, 0}), ball({0.1, 0.1, 0})})),
            "no closed form: balls start overlapping");
  EXPECT_EQ(refusal(scene({ball({0, 0, 0}, {1, 1, 0}), ball({1, 1, 0}), ball({2, 0, 0}, {0, 1, 0})})),
            "no closed form: 3 balls in the plane can meet");
}

// ----------------------------------------------------------------------------------- walls, axis by axis

TEST(ClosedFormWalls, Drop_HasItsFirstImpactAndRebounds_AsTheFormulasSay) {
  const double h = 1.25;
  for (const double e : {0.5, 0.9, 1.0}) {
    const Scenario s = drop(h, e);
    const double first = std::sqrt(2.0 * h / kGravity);
    EXPECT_EQ(at(s, first * (1.0 - 4.0 * kEpsilon)).tally.impacts, 0);
    EXPECT_EQ(at(s, first * (1.0 + 4.0 * kEpsilon)).tally.impacts, 1);
    double bounce = first;
    for (int n = 1; n <= 5; ++n) {
      const double flight = 2.0 * first * std::pow(e, n);
      const Moment apex = at(s, bounce + 0.5 * flight);
      EXPECT_EQ(apex.tally.impacts, n);
      EXPECT_NEAR(apex.balls[0].position.y() - 0.1, h * std::pow(e, 2 * n), apex.uncertainty_m + rounding(h));
      EXPECT_NEAR(apex.balls[0].velocity.y(), 0.0, rounding(kGravity * bounce));
      bounce += flight;
    }
  }
}

TEST(ClosedFormWalls, Drop_RestsAfterAFiniteTime_BelowFullRestitution) {
  for (const double e : {0.0, 0.5, 0.9, 0.999}) {
    const double h = 0.2;
    const double end = std::sqrt(2.0 * h / kGravity) * (1.0 + e) / (1.0 - e);
    const Scenario s = drop(h, e, 0.0, 2.0 * end);
    const Moment before = at(s, end * (1.0 - 1e-6));
    const Moment after = at(s, end * (1.0 + 4.0 * kEpsilon));
    EXPECT_GT(before.balls[0].position.y(), 0.1);
    // With R = 1e-6 T left, flights last less than R/e, and rise less than g (R/e)²/8; with e = 0 it still
    // falls.
    const double left = 1e-6 * end;
    const double above = e > 0.0 ? kGravity * left * left / (8.0 * e * e) : kGravity * end * left;
    EXPECT_LE(before.balls[0].position.y() - 0.1, above + before.uncertainty_m);
    EXPECT_EQ(after.balls[0].position.y(), 0.1);
    EXPECT_EQ(after.balls[0].velocity.y(), 0.0);
    EXPECT_EQ(at(s, 2.0 * end).tally.impacts, after.tally.impacts);
    EXPECT_DOUBLE_EQ(at(s, 2.0 * end).balls[0].velocity.x(), 0.25);
  }
}

TEST(ClosedFormWalls, Drop_ReachesItsImpact_ThrownUpOrDown) {
  const double h = 1.0;
  for (const double v : {-3.0, 4.0}) {
    const Scenario s = drop(h, 0.5, v);
    const double speed = std::sqrt(v * v + 2.0 * kGravity * h);
    const double first = (v + speed) / kGravity;
    const Moment moment = at(s, first + 0.25 * speed / kGravity);
    EXPECT_EQ(moment.tally.impacts, 1);
    EXPECT_NEAR(moment.balls[0].velocity.y(), 0.25 * speed, rounding(2.0 * speed));
  }
}

TEST(ClosedFormWalls, WallImpulse_IsTheSumOverBounces_WithTheMomentAtTheContact) {
  const double h = 0.8;
  const double e = 0.7;
  const Scenario s = drop(h, e, 0.0, 20.0);
  const double m = 2.0;
  const double first = std::sqrt(2.0 * h / kGravity);
  double t = first;
  double impulse = 0.0;
  double moment = 0.0;
  for (int n = 0; n < 200; ++n) {  // e^200 < 1e-30: all of them
    const double j = m * (1.0 + e) * kGravity * first * std::pow(e, n);
    impulse += j;
    moment += j * (0.3 + 0.25 * t);
    t += 2.0 * first * std::pow(e, n + 1);
    if (n != 4) continue;
    const Tally five = at(s, t - 0.5 * first * std::pow(e, n + 1)).tally;
    EXPECT_EQ(five.impacts, 5);
    EXPECT_NEAR(five.external_impulse.y(), impulse, rounding(impulse));
    EXPECT_NEAR(five.external_angular_impulse.z(), moment, rounding(moment));
  }
  const Tally end = at(s, 20.0).tally;  // from t on the floor carries the ball
  EXPECT_NEAR(end.external_impulse.y(), impulse + m * kGravity * (20.0 - t), rounding(m * kGravity * 20.0));
  EXPECT_NEAR(end.external_angular_impulse.z(),
              moment + m * kGravity * (0.3 * (20.0 - t) + 0.125 * (400.0 - t * t)),
              rounding(m * kGravity * 60.0));
}

/// Fine steps, exact between bounces, reflected at the first step beyond a wall: wrong by O(v h) per bounce.
double stepped_height(const Scenario& s, double low, double high, double end_s, int steps) {
  const double a = s.effects.gravity->y();
  const double h = end_s / steps;
  double y = s.balls[0].position.y();
  double v = s.balls[0].velocity.y();
  for (int i = 0; i < steps; ++i) {
    y += h * (v + 0.5 * a * h);
    v += a * h;
    if ((y < low && v < 0.0) || (y > high && v > 0.0)) v *= -s.wall_contact.restitution;
  }
  return y;
}

TEST(ClosedFormWalls, FloorAndCeiling_MatchFineSteps_AnyRestitution) {
  for (const double e : {0.6, 0.95, 1.0}) {
    Scenario s = drop(1.0, e, 6.0, 3.0);
    s.walls.push_back({-Vec3::UnitY(), -2.0});
    // Up to nine bounces, each late by a step at up to 7.5 m/s and so off by at most twice that way, plus
    // what the changed speed makes of it, as much again.
    constexpr int kSteps = 3'000'000;
    const double step_error = 9.0 * 4.0 * 7.5 * 3.0 / kSteps;
    const Moment end = at(s, 3.0);
    EXPECT_GT(end.tally.impacts, 2);
    EXPECT_NEAR(end.balls[0].position.y(), stepped_height(s, 0.1, 1.9, 3.0, kSteps), step_error);
  }
}

TEST(ClosedFormWalls, BoxMotion_IsExact_AfterAMillionBounces) {
  // Room for the centre: 1.75 m, in numbers that are exact, so that the fold can be done in whole numbers.
  Scenario s = scene({ball({0.5, 0.25, 0}, {0.75, -2.5, 0}, 1.0, 0.125)}, 4.0e6);
  s.effects.collisions = false;
  for (const Vec3& n : {Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
    s.walls.push_back({n, 0.0});
    s.walls.push_back({-n, -2.0});
  }
  const auto fold = [](double x) {
    const double r = std::fmod(std::fmod(x, 3.5) + 3.5, 3.5);
    return 0.125 + (r < 1.75 ? r : 3.5 - r);
  };
  for (const double t : {1.0, 1000.5, 3.0e6 + 0.25}) {
    const Moment moment = at(s, t);
    EXPECT_NEAR(moment.balls[0].position.x(), fold(0.375 + 0.75 * t), moment.uncertainty_m);
    EXPECT_NEAR(moment.balls[0].position.y(), fold(0.125 - 2.5 * t), moment.uncertainty_m);
    EXPECT_EQ(moment.balls[0].velocity.cwiseAbs(), Vec3(0.75, 2.5, 0));
    EXPECT_NEAR(static_cast<double>(moment.tally.impacts), 3.25 * t / 1.75, 2.0);
    EXPECT_LT(moment.uncertainty_m, 3e-15);
    EXPECT_LT((s.balls[0].velocity + moment.tally.external_impulse - moment.balls[0].velocity).norm(), 1e-15);
  }
}

TEST(ClosedFormWalls, ElasticDrop_ReturnsToItsHeight_AfterAMillionBounces) {
  const double h = 0.5 * kGravity;  // falls for 1 s
  Scenario s = drop(h, 1.0, 0.0, 4.0e6);
  s.balls[0].velocity.x() = 0.0;
  const Moment moment = at(s, 2.0e6);
  EXPECT_EQ(moment.tally.impacts, 1'000'000);
  // h and its gap are rounded: the period is off by ε/2 of h + r each, a million times, which near the apex
  // enters squared; the velocity shows it.
  EXPECT_NEAR(moment.balls[0].position.y(), h + 0.1, moment.uncertainty_m + rounding(h));
  EXPECT_NEAR(moment.balls[0].velocity.y(), 0.0, kGravity * 2.0e6 * 4.0 * kEpsilon);
}

TEST(ClosedFormWalls, Speed_FallsByRestitutionAtEveryWall_InABox) {
  Scenario s = scene({on_x(0.5, 1.0)}, 20.0);
  s.walls = {{Vec3::UnitX(), 0.0}, {-Vec3::UnitX(), -1.0}};
  s.wall_contact.restitution = 0.5;
  // 0.4 m to the wall, then 0.8 m at each half the speed: bounces at 0.4, 2, 5.2, 11.6 s.
  const Moment moment = at(s, 12.0);
  EXPECT_EQ(moment.tally.impacts, 4);
  EXPECT_NEAR(moment.balls[0].velocity.x(), 0.0625, rounding(1.0));
  EXPECT_NEAR(moment.balls[0].position.x(), 0.1 + 0.4 * 0.0625, moment.uncertainty_m + rounding(1.0));
}

TEST(ClosedFormWalls, BallAtRestOnTheFloor_StaysAndIsCarried) {
  for (const double e : {0.0, 0.5, 1.0}) {
    const Scenario s = drop(0.0, e);
    const Moment end = at(s, 10.0);
    EXPECT_EQ(end.balls[0].position.y(), 0.1);
    EXPECT_EQ(end.tally.impacts, 0);
    EXPECT_NEAR(end.tally.external_impulse.y(), 2.0 * kGravity * 10.0, rounding(2.0 * kGravity * 10.0));
  }
}

TEST(ClosedFormWalls, Motion_IsTheSame_Mirrored) {
  for (const double e : {0.0, 0.7, 1.0}) {
    const Scenario s = drop(1.0, e, 2.0);
    Scenario mirrored = s;
    mirrored.effects.gravity = -*s.effects.gravity;
    mirrored.walls[0].normal = -s.walls[0].normal;
    mirrored.balls[0].position.y() = -s.balls[0].position.y();
    mirrored.balls[0].velocity.y() = -s.balls[0].velocity.y();
    for (const double t : {0.3, 1.0, 2.0, 10.0}) {
      const Moment one = at(s, t);
      const Moment other = at(mirrored, t);
      EXPECT_EQ(other.balls[0].position.y(), -one.balls[0].position.y());
      EXPECT_EQ(other.balls[0].velocity.y(), -one.balls[0].velocity.y());
      EXPECT_EQ(other.tally.external_impulse.y(), -one.tally.external_impulse.y());
      EXPECT_EQ(other.tally.impacts, one.tally.impacts);
    }
  }
}

TEST(ClosedFormWalls, ManyBalls_AreTaken_WhereTheyCannotMeet) {
  Scenario s = drop(1.0, 0.8);
  s.balls[0].velocity.x() = 0.0;
  s.balls.push_back(ball({0.6, 2.0, 0}));
  EXPECT_EQ(at(s, 5.0).family, "separable axes");
  s.balls.push_back(ball({0.75, 4.0, 0}));  // overhangs its neighbour's lane
  EXPECT_EQ(refusal(s), "no closed form: 3 balls in the plane can meet");
  s.effects.collisions = false;
  EXPECT_EQ(refusal(s), "");
}

TEST(ClosedFormWalls, Scene_IsRefused_WhereTheFamilyEnds) {
  Scenario rough = drop(1.0, 0.5);
  rough.wall_contact.friction = 0.5;
  rough.balls.push_back(ball({5, 1, 0}));
  EXPECT_EQ(refusal(rough), "no closed form: ball 0 reaches a rough wall");
  rough.duration_s = 0.4;  // before the first impact at 0.45 s
  EXPECT_EQ(refusal(rough), "");
  Scenario oblique = drop(1.0, 0.5);
  oblique.walls.push_back({Vec3(-0.6, 0.8, 0), -1.5});
  EXPECT_EQ(refusal(oblique), "no closed form: ball 0 can reach a wall that is not across an axis");
  EXPECT_EQ(refusal(drop(-0.01, 0.5)), "no closed form: ball 0 starts outside a wall");
}

// ------------------------------------------------------------------------------------------------- drag

Scenario with_drag(Drag::Kind kind, double coefficient, const Vec3& v, const Vec3& gravity, double end_s) {
  Scenario s = scene({ball({1, 2, 0}, v, 0.5)}, end_s);
  s.effects.drag = Drag{kind, coefficient};
  s.effects.gravity = gravity;
  return s;
}

constexpr int kSteps = 20000;

/// Runge–Kutta of order 4 in long double.
BallState integrated(const Scenario& s, double end_s) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  const Ball& b = s.balls[0];
  const long double k = static_cast<long double>(s.effects.drag->coefficient) / b.mass;
  const bool linear = s.effects.drag->kind == Drag::Kind::linear;
  const Vector g = s.effects.gravity->cast<long double>();
  const auto acceleration = [&](const Vector& v) -> Vector { return g - v * (linear ? k : k * v.norm()); };
  const long double h = static_cast<long double>(end_s) / kSteps;
  Vector x = b.position.cast<long double>();
  Vector v = b.velocity.cast<long double>();
  for (int i = 0; i < kSteps; ++i) {
    const Vector a1 = acceleration(v);
    const Vector a2 = acceleration(v + h / 2 * a1);
    const Vector a3 = acceleration(v + h / 2 * a2);
    const Vector a4 = acceleration(v + h * a3);
    x += h * v + h * h / 6 * (a1 + a2 + a3);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return {x.cast<double>(), v.cast<double>(), Vec3::Zero()};
}

TEST(ClosedFormDrag, Motion_MatchesFineIntegration_EveryCase) {
  const Vec3 down(0, -kGravity, 0);
  const Vec3 none = Vec3::Zero();
  const Vec3 oblique(3, 4, 0);
  using enum Drag::Kind;
  for (const double end_s : {0.01, 0.5, 3.0}) {
    for (const Scenario& s :
         {with_drag(linear, 0.1, oblique, down, end_s), with_drag(linear, 1e-9, oblique, down, end_s),
          with_drag(linear, 2.0, oblique, none, end_s), with_drag(quadratic, 0.02, oblique, none, end_s),
          with_drag(quadratic, 0.02, none, down, end_s),
          with_drag(quadratic, 0.02, -Vec3::UnitY(), down, end_s),
          with_drag(quadratic, 0.02, -30.0 * Vec3::UnitY(), down, end_s),
          with_drag(quadratic, 0.02, 8.0 * Vec3::UnitY(), down, end_s),
          with_drag(quadratic, 1e-9, 8.0 * Vec3::UnitY(), down, end_s)}) {
      SCOPED_TRACE(std::to_string(s.effects.drag->coefficient) + " at " + std::to_string(end_s));
      const Moment moment = at(s, end_s);
      const BallState expected = integrated(s, end_s);
      // With h = T/20000 <= 1.5e-4 s and rates below 2.4/s (2 q v at 30 m/s) the steps err by (h rate)⁴/120
      // of 50 m: below 1e-14 m. At an apex the third derivative of the speed jumps by 2 q g², of which the
      // step across it makes h³/3 at most, and the time left a way.
      const double h = end_s / kSteps;
      const double jump = 2.0 * s.effects.drag->coefficient / s.balls[0].mass * kGravity * kGravity;
      const bool turns = s.balls[0].velocity.y() > 0.0 && s.effects.drag->kind == quadratic;
      const double step_error = 1e-14 + (turns ? jump * h * h * h / 3.0 * end_s : 0.0);
      EXPECT_LT((moment.balls[0].position - expected.position).norm(), moment.uncertainty_m + step_error);
      EXPECT_LT((moment.balls[0].velocity - expected.velocity).norm(), rounding(40.0) + step_error);
    }
  }
}

TEST(ClosedFormDrag, Fall_ApproachesTheTerminalSpeed) {
  const Vec3 down(0, -kGravity, 0);
  const double linear = 0.5 * kGravity / 0.1;
  EXPECT_NEAR(at(with_drag(Drag::Kind::linear, 0.1, Vec3::Zero(), down, 1e4), 1e4).balls[0].velocity.y(),
              -linear, rounding(linear));
  const double quadratic = std::sqrt(0.5 * kGravity / 0.02);
  const Moment fall = at(with_drag(Drag::Kind::quadratic, 0.02, Vec3::Zero(), down, 1e4), 1e4);
  EXPECT_NEAR(fall.balls[0].velocity.y(), -quadratic, rounding(quadratic));
  // ln cosh θ → θ - ln 2
  const double way = quadratic * 1e4 - quadratic * quadratic / kGravity * std::numbers::ln2;
  EXPECT_NEAR(fall.balls[0].position.y(), 2.0 - way, fall.uncertainty_m);
}

TEST(ClosedFormDrag, Scene_IsRefused_WhereTheFamilyEnds) {
  using enum Drag::Kind;
  const Vec3 down(0, -kGravity, 0);
  EXPECT_EQ(refusal(with_drag(quadratic, 0.1, Vec3(1, 0, 0), down, 1.0)),
            "no closed form: quadratic drag and gravity, off the vertical");
  Scenario floor = with_drag(linear, 0.1, Vec3(1, 0, 0), down, 1.0);
  floor.walls = {{Vec3::UnitY(), 0.0}};
  EXPECT_EQ(refusal(floor), "no closed form: drag, and ball 0 reaches a wall");
  floor.duration_s = 0.5;
  EXPECT_EQ(refusal(floor), "");
  Scenario ceiling = with_drag(linear, 0.1, Vec3(0, 6, 0), down, 1.3);  // up by 1.7 m and back
  ceiling.walls = {{-Vec3::UnitY(), -3.0}};
  EXPECT_NE(refusal(ceiling), "");
}

// ----------------------------------------------------------------------------------------- balls on a line

TEST(ClosedFormLine, CradleWithGaps_SendsOutTheLastBall_AtTheProductOfTheRatios) {
  for (const double e : {0.5, 0.9, 1.0}) {
    for (const int n : {2, 5, 10}) {
      Scenario s = scene({});
      double arrival_s = 0.0;  // of the first pass at the last ball, over gaps of 0.05 m
      for (int i = 0; i < n; ++i) {
        s.balls.push_back(on_x(0.25 * i, i == 0 ? 1.0 : 0.0));
        arrival_s += i == 0 ? 0.0 : 0.05 / std::pow(0.5 * (1.0 + e), i - 1);
      }
      s.ball_contact.restitution = e;
      s.duration_s = arrival_s * 1.001;
      const Moment end = at(s, s.duration_s);
      EXPECT_EQ(end.family, "balls on a line");
      const double expected = std::pow(0.5 * (1.0 + e), n - 1);
      EXPECT_NEAR(end.balls.back().velocity.x(), expected, rounding(expected));
      EXPECT_TRUE(e < 1.0 || end.tally.impacts == n - 1);
    }
  }
}

TEST(ClosedFormLine, GalperinsCount_IsPi_ElasticHeavyBallAndWall) {
  const std::array counts = {3, 31, 314, 3141, 31415};
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double heavy = std::pow(100.0, static_cast<double>(k));
    Scenario s = scene({on_x(1.0), on_x(2.0, -1.0, heavy)}, 100.0);
    s.walls = {{Vec3::UnitX(), 0.0}};
    const Moment end = at(s, 100.0);
    EXPECT_EQ(end.tally.impacts, counts[k]);
    EXPECT_NEAR(energy(s, end.balls), 0.5 * heavy, rounding(0.5 * heavy));
    // With θ = arctan √(m/M) every impact turns the path by θ in the plane of √m v: after n the heavy ball
    // has the velocity -cos(n₊ 2θ), n₊ of them with the other ball.
    const double between_balls = std::ceil(counts[k] / 2.0);
    const double theta = std::atan(std::sqrt(1.0 / heavy));
    EXPECT_NEAR(end.balls[1].velocity.x(), -std::cos(2.0 * between_balls * theta),
                rounding(between_balls * theta));
    EXPECT_LT(end.uncertainty_m, 1e-13);
  }
}

TEST(ClosedFormLine, Trajectory_ReturnsToItsStart_WhenVelocitiesAreReversed) {
  Scenario s = scene({on_x(1.0), on_x(2.0, -1.0, 1e4)}, 2.0);
  s.walls = {{Vec3::UnitX(), 0.0}};
  const Moment middle = at(s, 2.0);
  Scenario back = s;
  for (std::size_t i = 0; i < 2; ++i) {
    back.balls[i].position = middle.balls[i].position;
    back.balls[i].velocity = -middle.balls[i].velocity;
  }
  const Moment start = at(back, 2.0);
  EXPECT_GT(middle.tally.impacts, 100);
  EXPECT_NEAR(static_cast<double>(start.tally.impacts), static_cast<double>(middle.tally.impacts), 1.0);
  for (std::size_t i = 0; i < 2; ++i) {
    // The rounded middle is off by ε of places, and of velocities up to √M = 100 times 2 s, in the norm of
    // the billiard's plane, which goes back without growing and shows √(M/m) = 100 times as large in the
    // light ball.
    EXPECT_NEAR(start.balls[i].position.x(), s.balls[i].position.x(),
                rounding(2.0 * 100.0 * 2.0 + 100.0 * 2.0));
  }
}

/// A random chain along x with gaps; walls at both ends where `walled`.
Scenario random_chain(std::mt19937_64& random, bool walled) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Scenario s = scene({}, 3.0);
  double edge = 0.5;
  const auto count = 2 + static_cast<int>(unit(random) * 6.0);
  for (int i = 0; i < count; ++i) {
    const double radius = 0.05 + 0.2 * unit(random);
    edge += 0.05 + unit(random) + radius;
    s.balls.push_back(
        ball({edge, 0.5, 0}, {4.0 * unit(random) - 2.0, 0, 0}, 0.5 + 4.0 * unit(random), radius));
    edge += radius;
  }
  if (walled) s.walls = {{Vec3::UnitX(), 0.0}, {-Vec3::UnitX(), -edge - 0.5}};
  s.ball_contact.restitution = 0.6 + 0.4 * unit(random);
  s.wall_contact.restitution = 0.6 + 0.4 * unit(random);
  return s;
}

TEST(ClosedFormLine, MomentaEnergyAndOrder_AreKept_RandomScenes) {
  constexpr std::uint64_t kSeed = 314159;
  std::mt19937_64 random(kSeed);
  std::int64_t impacts = 0;
  for (int k = 0; k < 200; ++k) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", scene " + std::to_string(k));
    const Scenario s = random_chain(random, k % 2 == 1);
    const Moment end = at(s, 3.0);
    impacts += end.tally.impacts;
    // At most 7 balls of 4.5 kg, energy enough for 2 m/s √9 and 10 m of line.
    const double scale = 7.0 * 4.5 * 2.0 * 3.0;
    EXPECT_LT((momentum(s, end.balls) - momentum(s, s.balls) - end.tally.external_impulse).norm(),
              rounding(scale));
    EXPECT_LT(
        (angular_momentum(s, end.balls) - angular_momentum(s, s.balls) - end.tally.external_angular_impulse)
            .norm(),
        rounding(scale * 0.5));
    EXPECT_LE(energy(s, end.balls), energy(s, s.balls) * (1.0 + 8.0 * kEpsilon));
    for (std::size_t i = 1; i < s.balls.size(); ++i) {
      EXPECT_GE(end.balls[i].position.x() - end.balls[i - 1].position.x(),
                s.balls[i].radius + s.balls[i - 1].radius - 2.0 * end.uncertainty_m);
    }
    EXPECT_TRUE(!s.walls.empty() || end.tally.external_impulse.isZero(0.0));
  }
  EXPECT_GT(impacts, 500);
}

TEST(ClosedFormLine, Outcome_IsTheSame_MirroredAndBoosted) {
  constexpr std::uint64_t kSeed = 2718;
  std::mt19937_64 random(kSeed);
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", scene " + std::to_string(k));
    const Scenario s = random_chain(random, false);
    const Moment end = at(s, 3.0);
    Scenario mirrored = s;
    Scenario boosted = s;
    for (std::size_t i = 0; i < s.balls.size(); ++i) {
      mirrored.balls[i].position.x() *= -1.0;
      mirrored.balls[i].velocity.x() *= -1.0;
      boosted.balls[i].velocity.x() += 0.75;
    }
    const Moment in_mirror = at(mirrored, 3.0);
    const Moment with_boost = at(boosted, 3.0);
    // Adding the boost rounds each velocity by ε/2 of 2.75 m/s, for 3 s; in the billiard's norm that does not
    // grow, and comes back √(m_max/m_min) = 3 times as large from each of up to 7 balls.
    const double rounded_boost = rounding(2.75 * 3.0 * 3.0 * 7.0);
    for (std::size_t i = 0; i < s.balls.size(); ++i) {
      EXPECT_NEAR(in_mirror.balls[i].position.x(), -end.balls[i].position.x(), 2.0 * end.uncertainty_m);
      EXPECT_NEAR(with_boost.balls[i].position.x() - 0.75 * 3.0, end.balls[i].position.x(), rounded_boost);
    }
  }
}

TEST(ClosedFormLine, Outcome_IsTheSame_OnASlantedLine) {
  Scenario straight = scene({on_x(0.0, 1.0), on_x(1.0), on_x(2.0, -0.5, 3.0)}, 4.0);
  Scenario slanted = straight;
  const Vec3 along(0.6, 0.8, 0);
  for (Ball& b : slanted.balls) {
    b.position = along * b.position.x();
    b.velocity = along * b.velocity.x();
  }
  straight.walls = {{Vec3::UnitX(), -0.5}};
  slanted.walls = {{along, -0.5}};
  const Moment a = at(straight, 4.0);
  const Moment b = at(slanted, 4.0);
  EXPECT_EQ(b.family, "balls on a line");
  EXPECT_EQ(a.tally.impacts, b.tally.impacts);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT((along * a.balls[i].position.x() - b.balls[i].position).norm(),
              a.uncertainty_m + b.uncertainty_m);
  }
}

TEST(ClosedFormLine, Scene_IsRefused_WhereTheFamilyEnds) {
  const std::string simultaneous = "no closed form: simultaneous impacts have no unique outcome";
  EXPECT_EQ(refusal(scene({on_x(0.0, 1.0), on_x(0.5), on_x(0.7), on_x(0.9)})), simultaneous);
  EXPECT_EQ(refusal(scene({on_x(-1.0, 1.0), on_x(0.0), on_x(1.0, -1.0)})), simultaneous);
  Scenario at_wall = scene({on_x(0.1), on_x(1.0, -1.0)});
  at_wall.walls = {{Vec3::UnitX(), 0.0}};
  EXPECT_EQ(refusal(at_wall), simultaneous);
  EXPECT_EQ(refusal(scene({on_x(0.0, 1.0, kInfinity), on_x(1.0), on_x(2.0, 0.0, kInfinity)}, 1.0)), "");
  EXPECT_EQ(refusal(scene({on_x(0.0, 1.0, kInfinity), on_x(1.0, 0.0, kInfinity)})),
            "no closed form: an immovable ball meets another, or a wall");
  EXPECT_EQ(refusal(scene({on_x(0.0, 1.0), on_x(0.15)})), "no closed form: balls start overlapping");
}

// ------------------------------------------------------------------------------------------- every family

/// Two families that solve the same scene, by different formulas.
void expect_agreement(const closed_form::Attempt& one, const closed_form::Attempt& other, const Scenario& s) {
  ASSERT_TRUE(one.motion) << one.reason;
  ASSERT_TRUE(other.motion) << other.reason;
  std::vector<BallState> a(s.balls.size());
  std::vector<BallState> b(s.balls.size());
  for (int moment = 0; moment <= 64; ++moment) {
    const double t = s.duration_s * moment / 64.0;
    one.motion->evaluate(t, a);
    other.motion->evaluate(t, b);
    const double tolerance = one.motion->uncertainty_m() + other.motion->uncertainty_m();
    for (std::size_t i = 0; i < s.balls.size(); ++i)
      EXPECT_LT((a[i].position - b[i].position).norm(), tolerance);
    const Tally at_a = one.motion->tally(t);
    const Tally at_b = other.motion->tally(t);
    EXPECT_EQ(at_a.impacts, at_b.impacts);
    EXPECT_LT((at_a.external_impulse - at_b.external_impulse).norm(), rounding(10.0));
    EXPECT_LT((at_a.external_angular_impulse - at_b.external_angular_impulse).norm(), rounding(10.0));
  }
}

TEST(ClosedForm, Families_Agree_WhereTheyOverlap) {
  for (const double e : {0.0, 0.4, 1.0}) {
    Scenario head_on = scene({ball({-1, 1, 0}, {0.7, 0, 0}, 2.0), ball({1, 1, 0}, {-0.2, 0, 0}, kInfinity)});
    head_on.ball_contact.restitution = e;
    expect_agreement(closed_form::try_pair(head_on), closed_form::try_line(head_on), head_on);
    Scenario lone = scene({ball({0.5, 0.25, 0}, {0.7, 0, 0}, 2.0)}, 40.0);
    lone.walls = {{Vec3::UnitX(), 0.0}, {-Vec3::UnitX(), -1.3}};
    lone.wall_contact.restitution = e;
    expect_agreement(closed_form::try_separable(lone), closed_form::try_line(lone), lone);
  }
}

TEST(ClosedForm, State_IsTheSame_InOneStepAndInAMillion) {
  Scenario line = scene({on_x(0.0, 1.0), on_x(1.0), on_x(2.0, -0.5, 3.0)}, 4.0);
  const Scenario falling = drop(1.0, 0.9, 0.0, 4.0);
  const Scenario pair = scene({ball({-2, 0.1, 0}, {1, 0, 0}), ball({0, 0, 0})}, 4.0);
  for (const Scenario& s : {line, falling, pair}) {
    const Moment one = at(s, 4.0);
    const Moment many = at(s, 4.0, 1'000'000);
    EXPECT_EQ(one.tally.impacts, many.tally.impacts);
    for (std::size_t i = 0; i < s.balls.size(); ++i) {
      // The step length is rounded by ε/2, and so is the time: at up to 10 m/s for 4 s.
      EXPECT_LT((one.balls[i].position - many.balls[i].position).norm(), rounding(10.0 * 4.0));
    }
  }
}

TEST(ClosedForm, Time_IsRight_AfterMillionsOfCalls) {
  const Scenario s = scene({on_x(0.0, 1.0)}, 1e6);
  const auto simulation = make_closed_form_engine()->create(s, "faithful");
  constexpr std::int64_t kCalls = 3'000'000;
  for (std::int64_t i = 0; i < kCalls; ++i) simulation->advance(0.1, 1);
  std::vector<BallState> balls(1);
  simulation->snapshot(balls);
  EXPECT_DOUBLE_EQ(balls[0].position.x(), 0.1 * static_cast<double>(kCalls));
}

TEST(ClosedForm, FeaturesWithoutAForm_AreNamedWithAReason) {
  Scenario s = scene({on_x(0.0, 1.0)});
  s.slabs = {{Vec3::UnitX(), 2.0, 0.1}};
  EXPECT_EQ(refusal(s), "slab: no family of closed forms here has it");
}

}  // namespace
}  // namespace carom::test
