#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "reference/closed_form/closed_form.h"
#include "tests/support/numbers.h"

namespace carom::test {
namespace {

using Real = long double;
using Vec3Real = Eigen::Matrix<Real, 3, 1>;

constexpr double kSolid = 0.4;

/// What rounding leaves of a sum of a few products of numbers no larger than `scale`, sixteen roundings.
double rounding(double scale) {
  return 16.0 * kEpsilon * scale;
}

Vec3Real real(const Vec3& v) {
  return v.cast<Real>();
}

Vec3 random_vector(Random& random, double size) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

Scenario scene(std::vector<Ball> balls, double duration_s) {
  Scenario s;
  s.dimension = 3;
  s.duration_s = duration_s;
  s.effects.spin = true;
  s.balls = std::move(balls);
  return s;
}

/// A ball of 0.5 kg and r = 0.1 m, `height` over the rough floor z = 0.
Scenario over_floor(double height, const Vec3& velocity, const Vec3& spin, double mu, double duration_s) {
  Scenario s = scene({{.mass = 0.5,
                       .radius = 0.1,
                       .position = {0.3, -0.2, 0.1 + height},
                       .velocity = velocity,
                       .spin = spin}},
                     duration_s);
  s.effects.gravity = Vec3(0, 0, -kGravity);
  s.walls = {{Vec3::UnitZ(), 0.0}};
  s.wall_contact.friction = mu;
  return s;
}

/// A ball at rest on a slope of 3 : 4 that falls towards +x.
Scenario on_slope(double mu, double duration_s) {
  Scenario s = over_floor(0.0, Vec3::Zero(), Vec3::Zero(), mu, duration_s);
  s.balls[0].position = {0.06, 0.7, 0.08};
  s.walls = {{Vec3(0.6, 0, 0.8), 0.0}};
  return s;
}

struct Moment {
  std::vector<BallState> balls;
  Tally tally;
  double uncertainty_m = 0.0;
  std::string family;

  const BallState& ball() const { return balls.front(); }
};

std::string refusal(const Scenario& s) {
  return unsupported_reason(*make_closed_form_engine(), s, "faithful");
}

Moment at(const Scenario& s, double time_s) {
  const auto engine = make_closed_form_engine();
  Moment moment;
  moment.balls.resize(s.balls.size());
  const std::string reason = refusal(s);
  EXPECT_EQ(reason, "");
  if (!reason.empty()) return moment;
  const auto simulation = engine->create(s, "faithful");
  if (time_s > 0.0) simulation->advance(time_s, 1);
  simulation->snapshot(moment.balls);
  moment.tally = simulation->tally();
  moment.uncertainty_m = simulation->uncertainty_m();
  moment.family = std::get<std::string>(simulation->settings().at("family"));
  return moment;
}

double moment_of_inertia(const Ball& ball) {
  return ball.inertia * ball.mass * ball.radius * ball.radius;
}

double kinetic(const Ball& ball, const Vec3& velocity, const Vec3& spin) {
  return 0.5 * ball.mass * velocity.squaredNorm() + 0.5 * moment_of_inertia(ball) * spin.squaredNorm();
}

/// Orbital and spin, about the origin.
Vec3 angular_momentum(const Ball& ball, const Vec3& position, const Vec3& velocity, const Vec3& spin) {
  return ball.mass * position.cross(velocity) + moment_of_inertia(ball) * spin;
}

// ------------------------------------------------------------------------------------------------ Magnus

Scenario magnus(const Vec3& velocity, const Vec3& spin, const Vec3& gravity, double duration_s) {
  Scenario s = scene(
      {{.mass = 0.5, .radius = 0.1, .position = {1, 2, 3}, .velocity = velocity, .spin = spin}}, duration_s);
  s.effects.magnus = 0.1;
  s.effects.gravity = gravity;
  return s;
}

TEST(ClosedFormMagnus, Path_IsACircle_WithoutGravity) {
  const double omega = 20.0;
  const double rate = 0.1 * omega / 0.5;
  const double radius = 3.0 / rate;
  const Scenario s = magnus({3, 0, 0}, {0, 0, omega}, Vec3::Zero(), 10.0);
  for (int k = 1; k <= 40; ++k) {
    const double t = 0.25 * k;
    const Moment moment = at(s, t);
    const Real theta = static_cast<Real>(rate) * t;
    const Vec3Real expected =
        real({1, 2, 3}) + Vec3Real(std::sin(theta), 1 - std::cos(theta), 0) * static_cast<Real>(radius);
    EXPECT_LT((moment.ball().position - expected.cast<double>()).norm(), moment.uncertainty_m);
    EXPECT_NEAR(moment.ball().velocity.norm(), 3.0, rounding(3.0));
    EXPECT_EQ(moment.ball().spin, s.balls[0].spin);
  }
  EXPECT_EQ(at(s, 1.0).family, "Magnus flight");
}

/// Runge–Kutta of order 4 in long double.
std::pair<Vec3, Vec3> integrated(const Scenario& s, double end_s, int steps) {
  const Ball& ball = s.balls[0];
  const Vec3Real omega = real(ball.spin) * (static_cast<Real>(*s.effects.magnus) / ball.mass);
  const Vec3Real g = real(*s.effects.gravity);
  const auto acceleration = [&](const Vec3Real& v) -> Vec3Real { return g + omega.cross(v); };
  const Real h = static_cast<Real>(end_s) / steps;
  Vec3Real x = real(ball.position);
  Vec3Real v = real(ball.velocity);
  for (int i = 0; i < steps; ++i) {
    const Vec3Real a1 = acceleration(v);
    const Vec3Real a2 = acceleration(v + h / 2 * a1);
    const Vec3Real a3 = acceleration(v + h / 2 * a2);
    const Vec3Real a4 = acceleration(v + h * a3);
    x += h * v + h * h / 6 * (a1 + a2 + a3);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return {x.cast<double>(), v.cast<double>()};
}

TEST(ClosedFormMagnus, Motion_MatchesFineIntegration_AnyAxis) {
  constexpr std::uint64_t kSeed = 11;
  constexpr int kSteps = 10000;
  Random random(kSeed);
  for (int k = 0; k < 60; ++k) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", scene " + std::to_string(k));
    // From no turn at all, by way of angles at which the series of a coefficient takes over, to six turns.
    const double spin = k % 10 == 0 ? 0.0 : std::pow(10.0, random.uniform(-6.0, 2.0));
    const Vec3 axis = random_vector(random, 1.0);
    const Vec3 velocity = random_vector(random, 4.0);
    const Scenario s = magnus(velocity, axis.normalized() * spin, random_vector(random, kGravity), 2.0);
    const Moment moment = at(s, 2.0);
    const auto [x, v] = integrated(s, 2.0, kSteps);
    // Steps of 2e-4 s at 20 rad/s err by (h Ω)⁴/120 = 2e-12 of the way, 7 m/s × 2 s + ½ 17 m/s² × 4 s² = 48
    // m, and of the speed, 41 m/s, as much for each of 40 rad.
    const double turn = 2e-4 * 0.2 * spin;
    const double step_error = turn * turn * turn * turn / 120.0;
    EXPECT_LT((moment.ball().position - x).norm(), moment.uncertainty_m + step_error * 48.0 * 40.0);
    EXPECT_LT((moment.ball().velocity - v).norm(), 32.0 * kEpsilon * 41.0 + step_error * 41.0 * 40.0);
  }
}

TEST(ClosedFormMagnus, BallLetGo_ComesBackToItsHeight_AndDrifts) {
  const double rate = 0.1 * 30.0 / 0.5;
  const Scenario s = magnus(Vec3::Zero(), {0, 0, 30}, {0, -kGravity, 0}, 10.0);
  const double period = 2.0 * std::numbers::pi / rate;
  const Moment cusp = at(s, 4.0 * period);
  // Four arcs of a cycloid, with 2 π ε in the period: they count at the speed, which is 0 there but for ε.
  EXPECT_LT(cusp.ball().velocity.norm(), rounding(kGravity * 4.0 * period));
  EXPECT_LT((cusp.ball().position - Vec3(1.0 + kGravity / rate * 4.0 * period, 2, 3)).norm(),
            cusp.uncertainty_m);
  EXPECT_NEAR(at(s, 0.5 * period).ball().position.y(), 2.0 - 2.0 * kGravity / (rate * rate),
              cusp.uncertainty_m);
}

TEST(ClosedFormMagnus, Scene_IsRefused_WhereTheFamilyEnds) {
  Scenario s = magnus({3, 0, 0}, {0, 0, 20}, Vec3::Zero(), 100.0);
  s.walls = {{Vec3::UnitX(), -0.6}};  // 1.5 m from the surface of the ball, 2 × 0.75 m the circle's width
  s.balls[0].velocity.x() = 2.9;
  EXPECT_EQ(refusal(s), "");
  s.balls[0].velocity.x() = 3.1;
  EXPECT_EQ(refusal(s), "no closed form: the Magnus force, and ball 0 can reach a wall");
  s.walls.clear();
  s.balls.push_back(s.balls[0]);
  s.balls[1].position.x() += 9.0;
  EXPECT_EQ(refusal(s), "no closed form: the Magnus force, and several balls that can meet");
  s.effects.collisions = false;
  EXPECT_EQ(refusal(s), "");
  s.effects.drag = Drag{Drag::Kind::linear, 0.1};
  EXPECT_EQ(refusal(s), "no closed form: the Magnus force and drag");
}

// --------------------------------------------------------------------------------------- sliding, rolling

TEST(ClosedFormRoughWall, SlidingBall_RollsAtFiveSevenths_AndLosesTwoSeventhsOfItsEnergy) {
  const double v = 2.0;
  const double mu = 0.2;
  const Scenario s = over_floor(0.0, {v, 0, 0}, Vec3::Zero(), mu, 2.0);
  const double rolls = 2.0 * v / (7.0 * mu * kGravity);
  const Moment before = at(s, 0.5 * rolls);
  EXPECT_EQ(before.family, "a rough wall");
  EXPECT_NEAR(before.ball().velocity.x(), v * 6.0 / 7.0, rounding(v));
  EXPECT_NEAR(before.ball().spin.y(), 2.5 * v / 7.0 / 0.1, rounding(v / 0.1));
  const Moment end = at(s, 2.0);
  EXPECT_NEAR(end.ball().velocity.x(), v * 5.0 / 7.0, rounding(v));
  EXPECT_NEAR(end.ball().spin.y(), v * 5.0 / 7.0 / 0.1, rounding(v / 0.1));
  EXPECT_NEAR(end.ball().position.x(), 0.3 + v * rolls * 6.0 / 7.0 + v * 5.0 / 7.0 * (2.0 - rolls),
              end.uncertainty_m);
  const Ball& ball = s.balls[0];
  EXPECT_NEAR(kinetic(ball, ball.velocity, ball.spin) - kinetic(ball, end.ball().velocity, end.ball().spin),
              ball.mass * v * v / 7.0, rounding(ball.mass * v * v));
}

TEST(ClosedFormRoughWall, SlipFallsUniformly_AndTheRestIsKept_AnyVelocitySpinAndInertia) {
  constexpr std::uint64_t kSeed = 21;
  Random random(kSeed);
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", scene " + std::to_string(k));
    Vec3 velocity = random_vector(random, 3.0);
    velocity.z() = 0.0;
    const double mu = random.uniform(0.1, 0.8);
    Scenario s = over_floor(0.0, velocity, random_vector(random, 40.0), mu, 5.0);
    Ball& ball = s.balls[0];
    ball.inertia = random.uniform(0.1, 0.7);
    // The lowest point, at -r z, moves at v + ω × (-r z); over it friction does its work.
    const Vec3Real slip = real(ball.velocity) + real(ball.spin).cross(real({0, 0, -ball.radius}));
    const Real kappa = ball.inertia;
    const Real end_s = slip.norm() * kappa / ((1 + kappa) * mu * kGravity);
    const Vec3Real braking = slip.normalized() * (static_cast<Real>(mu) * kGravity);
    for (int i = 1; i <= 20; ++i) {
      const double t = 0.25 * i;
      const Moment moment = at(s, t);
      const Real slides = std::min(end_s, static_cast<Real>(t));
      const Vec3Real way =
          real(ball.position) + real(ball.velocity) * t - braking * (slides * (t - slides / 2));
      const Vec3Real v = real(ball.velocity) - braking * slides;
      const Vec3Real spin =
          real(ball.spin) - braking.cross(real(Vec3::UnitZ())) * (slides / (kappa * ball.radius));
      EXPECT_LT((moment.ball().position - way.cast<double>()).norm(), moment.uncertainty_m);
      EXPECT_LT((moment.ball().velocity - v.cast<double>()).norm(), rounding(8.0));
      EXPECT_LT((moment.ball().spin - spin.cast<double>()).norm(), rounding(8.0 / (0.1 * 0.1)));
      EXPECT_EQ(moment.ball().spin.z(), ball.spin.z());
      EXPECT_EQ(moment.ball().position.z(), ball.position.z());
    }
  }
}

TEST(ClosedFormRoughWall, Account_OfTheFloor_IsItsPushAtTheContact) {
  const double v = 2.0;
  const double mu = 0.2;
  const double t = 0.2;  // it still slides
  const Scenario s = over_floor(0.0, {v, 0, 0}, Vec3::Zero(), mu, 2.0);
  const Tally tally = at(s, t).tally;
  const double weight = 0.5 * kGravity;
  EXPECT_LT((tally.external_impulse - Vec3(-mu, 0, 1) * (weight * t)).norm(), rounding(weight * t));
  // At (x, y, 0) with x = 0.3 + v t - ½ μ g t², y = -0.2: about y by -∫ x dt m g, about x by y m g t, and
  // about z by y μ m g t.
  const double area = 0.3 * t + v * t * t / 2.0 - mu * kGravity * t * t * t / 6.0;
  const Vec3 expected = Vec3(-0.2 * t, -area, -0.2 * mu * t) * weight;
  EXPECT_LT((tally.external_angular_impulse - expected).norm(), rounding(weight * t));
  EXPECT_EQ(tally.impacts, 0);
}

TEST(ClosedFormRoughWall, BallOnASlope_RollsOrSlides_AsFrictionAllows) {
  const double sine = 0.6;
  const double cosine = 0.8;
  const Vec3 down(0.8, 0, -0.6);
  for (const double kappa : {kSolid, 0.5, 2.0 / 3.0}) {
    const double least = sine / cosine * kappa / (1.0 + kappa);
    for (const double mu : {0.3 * least, 0.999 * least, 1.001 * least, 3.0 * least}) {
      Scenario s = on_slope(mu, 2.0);
      s.balls[0].inertia = kappa;
      const Moment end = at(s, 2.0);
      const bool rolls = mu > least;
      const double a = rolls ? kGravity * sine / (1.0 + kappa) : kGravity * (sine - mu * cosine);
      const double spin_rate = rolls ? a / 0.1 : mu * kGravity * cosine / (kappa * 0.1);
      // 0.6 and 0.8 as doubles stand for a slope that is off by ε, and so does g along it.
      EXPECT_LT((end.ball().velocity - down * (a * 2.0)).norm(), rounding(kGravity * 2.0));
      EXPECT_LT((end.ball().position - s.balls[0].position - down * (a * 2.0)).norm(),
                end.uncertainty_m + rounding(kGravity * 2.0));
      EXPECT_NEAR(end.ball().spin.y(), spin_rate * 2.0, rounding(kGravity * 2.0 / (kappa * 0.1)));
      const Ball& ball = s.balls[0];
      const double fallen = ball.mass * kGravity * (ball.position.z() - end.ball().position.z());
      const double gained = kinetic(ball, end.ball().velocity, end.ball().spin);
      if (rolls) {
        EXPECT_NEAR(gained, fallen, rounding(ball.mass * kGravity * 12.0));
      } else {
        EXPECT_LT(gained, fallen);
      }
    }
  }
}

TEST(ClosedFormRoughWall, BallThrownUpASlope_IsContinuous_AndTurnsItsSlip) {
  const Vec3 down(0.8, 0, -0.6);
  for (const double mu : {0.1, 0.5}) {
    Scenario s = on_slope(mu, 2.0);
    s.balls[0].velocity = -3.0 * down;
    // Up to slip 0 friction and gravity both pull down; then, if it can, it rolls; or friction pulls up.
    const double slide = kGravity * (0.6 + mu * 0.8);
    const double braking = kGravity * (0.6 + 3.5 * mu * 0.8);
    const double end = 3.0 / braking;
    const double then = mu > 0.75 * 2.0 / 7.0 ? kGravity * 0.6 / 1.4 : kGravity * (0.6 - mu * 0.8);
    const auto speed = [&](double t) {
      return -3.0 + slide * std::min(t, end) + then * std::max(0.0, t - end);
    };
    for (const double t : {0.5 * end, end * (1.0 - 1e-9), end * (1.0 + 1e-9), 1.0, 2.0}) {
      const Moment moment = at(s, t);
      EXPECT_NEAR(moment.ball().velocity.dot(down), speed(t), rounding(20.0));
      EXPECT_LT(moment.ball().velocity.cross(down).norm(), rounding(20.0));
    }
    const double way = -3.0 * 2.0 + slide * end * (2.0 - end / 2.0) + 0.5 * then * (2.0 - end) * (2.0 - end);
    const Moment moment = at(s, 2.0);
    EXPECT_NEAR((moment.ball().position - s.balls[0].position).dot(down), way,
                moment.uncertainty_m + rounding(20.0));
  }
}

// ------------------------------------------------------------------------------------------------ bounces

TEST(ClosedFormRoughWall, ObliqueImpact_IsThatOfChungAndOoi) {
  // Test 4: sliding, e_t = 1 - μ (1+e)/tan θ and rω = -2.5 μ (1+e) v cos θ. Source: Y. C. Chung, J. Y. Ooi,
  // Granular Matter 13, 643 (2011); 0.6845, 0.847 and 0.934 by the rigid law.
  for (const auto& [degrees, share] :
       {std::pair(30.0, 0.6845), std::pair(50.0, 0.847), std::pair(70.0, 0.934)}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    Scenario s = scene({{.mass = 1.0, .radius = 0.0025, .position = {0, 0, 0.0125}}}, 0.02);
    s.balls[0].velocity = Vec3(std::sin(angle), 0, -std::cos(angle)) * 3.9;
    s.walls = {{Vec3::UnitZ(), 0.0}};
    s.wall_contact = {.restitution = 0.98, .friction = 0.092, .tangential_restitution = 0.44};
    const BallState end = at(s, 0.02).ball();
    const double tangential = end.velocity.x() / s.balls[0].velocity.x();
    EXPECT_NEAR(tangential, 1.0 - 0.092 * 1.98 / std::tan(angle), rounding(1.0));
    EXPECT_NEAR(tangential, share, 5e-4);  // half of the last digit that is printed
    EXPECT_NEAR(end.velocity.z(), 0.98 * 3.9 * std::cos(angle), rounding(3.9));
    EXPECT_NEAR(end.spin.y(), 2.5 * 0.092 * 1.98 * 3.9 * std::cos(angle) / 0.0025, rounding(500.0));
  }
}

TEST(ClosedFormRoughWall, StickingImpact_TurnsTheSlipRound_ByBeta0) {
  for (const double beta0 : {-1.0, 0.0, 0.44, 1.0}) {
    Scenario s = scene({{.mass = 1.0, .radius = 0.1, .position = {0, 0, 0.6}}}, 1.0);
    s.balls[0].velocity = {0.5, 0.25, -2.0};
    s.balls[0].spin = {3.0, 4.0, 5.0};
    s.walls = {{Vec3::UnitZ(), 0.0}};
    s.wall_contact = {.restitution = 0.5, .friction = 5.0, .tangential_restitution = beta0};
    const auto slip = [](const Vec3& v, const Vec3& spin) -> Vec3 {
      const Vec3 at_contact = v + spin.cross(Vec3(0, 0, -0.1));
      return {at_contact.x(), at_contact.y(), 0};
    };
    const BallState end = at(s, 1.0).ball();
    const Vec3 before = slip(s.balls[0].velocity, s.balls[0].spin);
    EXPECT_LT((slip(end.velocity, end.spin) + beta0 * before).norm(), rounding(2.0));
    EXPECT_EQ(end.spin.z(), 5.0);
  }
}

/// A ball that bounces in the plane: v along the floor, w = r ω so that the slip is v + w, u the speed at
/// which it arrives; all after each impact, by recursion.
struct Bounces {
  Real v, w, u;
  Real kappa, e, mu, beta0;

  void impact() {
    const Real slip = v + w;
    const Real sticks = (1 + beta0) * std::abs(slip) / (1 + 1 / kappa);
    const Real change = -std::copysign(std::min(sticks, mu * (1 + e) * u), slip);
    v += change;
    w += change / kappa;
    u *= e;
  }
};

TEST(ClosedFormRoughWall, Bounces_FollowTheRecursion_AnyCoefficients) {
  constexpr std::uint64_t kSeed = 31;
  Random random(kSeed);
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", scene " + std::to_string(k));
    const double h = random.uniform(0.2, 1.0);
    const double vx = random.uniform(-3.0, 3.0);
    const double spin = random.uniform(-60.0, 60.0);
    Scenario s = over_floor(h, {vx, 0, 0}, {0, -spin, 0}, random.uniform(0.05, 0.6), 20.0);
    s.balls[0].inertia = random.uniform(0.2, 0.66);
    s.wall_contact.restitution = k % 5 == 0 ? 1.0 : random.uniform(0.3, 0.95);
    s.wall_contact.tangential_restitution = random.uniform(-1.0, 1.0);
    const Contact& c = s.wall_contact;
    Bounces bounces{vx,
                    static_cast<Real>(spin) * 0.1L,
                    std::sqrt(2 * static_cast<Real>(kGravity) * h),
                    s.balls[0].inertia,
                    c.restitution,
                    c.friction,
                    c.tangential_restitution};
    Real t = bounces.u / kGravity;
    Real x = 0.3L + vx * t;
    for (int n = 1; n <= 8; ++n) {
      bounces.impact();
      const Real half = bounces.u / kGravity;
      const Moment apex = at(s, static_cast<double>(t + half));
      EXPECT_EQ(apex.tally.impacts, n);
      // The moment is rounded, by ε/2 of 8 s at most, and so x at up to 10 m/s; h it does not touch.
      EXPECT_NEAR(apex.ball().position.x(), static_cast<double>(x + bounces.v * half),
                  apex.uncertainty_m + rounding(10.0));
      EXPECT_NEAR(apex.ball().position.z() - 0.1, static_cast<double>(bounces.u * half / 2),
                  apex.uncertainty_m);
      EXPECT_NEAR(apex.ball().velocity.x(), static_cast<double>(bounces.v), rounding(10.0));
      EXPECT_NEAR(apex.ball().spin.y(), static_cast<double>(-bounces.w * 10), rounding(500.0));
      t += 2 * half;
      x += bounces.v * 2 * half;
    }
  }
}

TEST(ClosedFormRoughWall, AfterAllBounces_TheBallRolls_AsItsMomentAboutTheContactSays) {
  constexpr std::uint64_t kSeed = 41;
  Random random(kSeed);
  for (int k = 0; k < 50; ++k) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", scene " + std::to_string(k));
    const Vec3 velocity = random_vector(random, 2.0);
    Scenario s = over_floor(0.5, velocity, random_vector(random, 50.0), random.uniform(0.1, 0.5), 30.0);
    s.wall_contact.restitution = random.uniform(0.0, 0.8);
    s.wall_contact.tangential_restitution = random.uniform(-0.9, 0.9);
    const Ball& ball = s.balls[0];
    // Whatever pushes at the contact keeps v_t - κ r n × ω; rolling, v_t = r ω × n. It slips no faster than
    // 14 m/s, which μ = 0.1 needs 4 s to end; all bounces are over after 0.54 s × (1 + e)/(1 - e) = 5 s.
    const Vec3 n = Vec3::UnitZ();
    const Vec3 kept = ball.velocity - n * ball.velocity.z() - kSolid * ball.radius * n.cross(ball.spin);
    const Vec3 rolls = kept / (1.0 + kSolid);
    const Moment end = at(s, 30.0);
    EXPECT_LT((end.ball().velocity - rolls).norm(), rounding(14.0));
    EXPECT_LT((end.ball().spin - (n.cross(rolls) / ball.radius + n * ball.spin.z())).norm(), rounding(140.0));
    EXPECT_NEAR(end.ball().position.z(), ball.radius, end.uncertainty_m);
    // The floor's push is what is missing of the momentum.
    const Vec3 missing = ball.mass * (end.ball().velocity - ball.velocity + Vec3(0, 0, kGravity * 30.0));
    EXPECT_LT((end.tally.external_impulse - missing).norm(), rounding(ball.mass * kGravity * 30.0));
  }
}

TEST(ClosedFormRoughWall, State_IsContinuous_AtTheEndOfAllBounces) {
  Scenario s = over_floor(0.5, {1, 0, 0}, {0, 300, 0}, 0.1, 5.0);  // it still slides when it comes to rest
  s.wall_contact.restitution = 0.6;
  const double end = std::sqrt(2.0 * 0.5 / kGravity) * 1.6 / 0.4;
  const double around = 1e-7;
  const Moment before = at(s, end - around);
  const Moment after = at(s, end + around);
  EXPECT_GT(after.tally.impacts, 20);
  // Flights so near to the end last 1e-7 s / 0.6 at most; friction makes μ g of it, and the last bounces
  // throw the ball up by as much: four times g around is more than both.
  EXPECT_LT((after.ball().velocity - before.ball().velocity).norm(), 4.0 * kGravity * around);
  EXPECT_LT((after.ball().position - before.ball().position).norm(), 2.0 * 10.0 * around);
  // Bounces and sliding have pushed with the weight, on average, and friction with μ of that.
  const double u = std::sqrt(2.0 * kGravity * 0.5);
  EXPECT_NEAR(after.ball().velocity.x(), 1.0 + 0.1 * (u + kGravity * (end - u / kGravity)),
              4.0 * kGravity * around);
}

TEST(ClosedFormRoughWall, BounceOnASlope_IsThatOnAFloor_Turned) {
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, -1).normalized());
  Scenario level = over_floor(0.5, {1, 0.5, 0}, {10, -20, 30}, 0.2, 1.2);
  level.wall_contact = {.restitution = 0.7, .friction = 0.2, .tangential_restitution = 0.3};
  level.effects.gravity = Vec3(1, 2, -kGravity);
  Scenario turned = level;
  for (Vec3* v : {&turned.balls[0].position, &turned.balls[0].velocity, &turned.balls[0].spin,
                  &*turned.effects.gravity, &turned.walls[0].normal}) {
    *v = turn * *v;
  }
  for (const double t : {0.2, 0.6, 1.2}) {
    const Moment one = at(level, t);
    const Moment other = at(turned, t);
    EXPECT_EQ(one.tally.impacts, other.tally.impacts);
    // Turning rounds everything by a few ε; each of up to 2 bounces passes that on, no more than doubled, as
    // velocity, for a second.
    const double tolerance = 4.0 * (rounding(15.0) + one.uncertainty_m + other.uncertainty_m);
    EXPECT_LT((turn * one.ball().position - other.ball().position).norm(), tolerance);
    EXPECT_LT((turn * one.ball().velocity - other.ball().velocity).norm(), tolerance);
    EXPECT_LT((turn * one.ball().spin - other.ball().spin).norm(), tolerance / (0.1 * kSolid));
    EXPECT_LT((turn * one.tally.external_angular_impulse - other.tally.external_angular_impulse).norm(),
              tolerance);
  }
}

TEST(ClosedFormRoughWall, Scene_IsRefused_WhereTheFamilyEnds) {
  Scenario s = over_floor(0.0, {1, 0, 0}, Vec3::Zero(), 0.2, 1.0);
  s.walls.push_back({-Vec3::UnitX(), -2.0});
  EXPECT_EQ(refusal(s), "");
  s.walls.back().offset = -1.0;
  EXPECT_EQ(refusal(s), "no closed form: ball 0 reaches two rough walls");
  Scenario across = on_slope(0.5, 1.0);
  across.balls[0].velocity = {0, 1, 0};
  EXPECT_EQ(refusal(across),
            "no closed form: ball 0 is on a rough wall, and it slides across the slope of a wall");
  Scenario endless = over_floor(1e-9, Vec3::Zero(), Vec3::Zero(), 0.2, 10.0);
  EXPECT_EQ(refusal(endless),
            "no closed form: ball 0 is on a rough wall, and it bounces more than 100000 times");
  Scenario heavy = over_floor(0.5, {0, 0, -1}, Vec3::Zero(), 0.2, 10.0);
  heavy.balls[0].mass = kInfinity;
  EXPECT_EQ(refusal(heavy), "no closed form: ball 0 is immovable and reaches a wall");
  Scenario two = over_floor(0.0, {1, 0, 0}, Vec3::Zero(), 0.2, 1.0);
  two.balls.push_back(two.balls[0]);
  two.balls[1].position.x() += 1.0;
  EXPECT_NE(refusal(two), "");
  two.effects.collisions = false;
  EXPECT_EQ(refusal(two), "");
}

// ---------------------------------------------------------------------------------------------- two balls

/// Two rough balls that often meet; some are immovable.
Scenario rough_pair(Random& random) {
  const Vec3 a = random_vector(random, 0.5) - Vec3(2, 0, 0);
  const Vec3 b = random_vector(random, 0.5) + Vec3(2, 0, 0);
  Scenario s = scene({{.mass = std::pow(10.0, random.uniform(-2.0, 2.0)), .radius = 0.4},
                      {.mass = std::pow(10.0, random.uniform(-2.0, 2.0)), .radius = 0.7}},
                     4.0);
  s.balls[0].position = a;
  s.balls[1].position = b;
  s.balls[0].velocity = (b - a) * random.uniform(0.5, 1.5) + random_vector(random, 0.5);
  for (Ball& ball : s.balls) {
    ball.spin = random_vector(random, 10.0);
    ball.inertia = random.uniform(0.1, 0.66);
  }
  if (random.uniform() < 0.2) s.balls[1].mass = kInfinity;
  s.ball_contact = {.restitution = random.uniform(),
                    .friction = random.uniform(0.01, 0.8),
                    .tangential_restitution = random.uniform(-1.0, 1.0)};
  return s;
}

/// Where the paths touch, by bisection up to the moment at which they are nearest; none where they do not.
std::optional<Real> meeting_s(const Scenario& s) {
  const Vec3Real d = real(s.balls[1].position) - real(s.balls[0].position);
  const Vec3Real u = real(s.balls[1].velocity) - real(s.balls[0].velocity);
  const Real reach = static_cast<Real>(s.balls[0].radius) + s.balls[1].radius;
  Real high = -d.dot(u) / u.squaredNorm();
  if (high <= 0 || high > s.duration_s || (d + u * high).norm() > 0.99L * reach) return std::nullopt;
  Real low = 0;
  for (int i = 0; i < 70; ++i) {
    const Real middle = (low + high) / 2;
    ((d + u * middle).norm() > reach ? low : high) = middle;
  }
  return low;
}

TEST(ClosedFormRoughPair, Impact_ObeysTheThreeParameterLaw_RandomScenes) {
  constexpr std::uint64_t kSeed = 51;
  Random random(kSeed);
  int stuck = 0;
  int slid = 0;
  for (int k = 0; k < 400; ++k) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", scene " + std::to_string(k));
    const Scenario s = rough_pair(random);
    const std::optional<Real> met = meeting_s(s);
    if (!met) continue;
    const Ball& a = s.balls[0];
    const Ball& b = s.balls[1];
    const Moment end = at(s, 4.0);
    ASSERT_EQ(end.tally.impacts, 1);
    const Vec3 n = ((real(b.position) - real(a.position) + (real(b.velocity) - real(a.velocity)) * *met) /
                    static_cast<Real>(a.radius + b.radius))
                       .cast<double>();
    // How fast the surface of b moves against that of a, where they touch.
    const auto at_contact = [&](const Vec3& va, const Vec3& wa, const Vec3& vb, const Vec3& wb) -> Vec3 {
      return (vb + wb.cross(n * -b.radius)) - (va + wa.cross(n * a.radius));
    };
    const Vec3 before = at_contact(a.velocity, a.spin, b.velocity, b.spin);
    const Vec3 after =
        at_contact(end.balls[0].velocity, end.balls[0].spin, end.balls[1].velocity, end.balls[1].spin);
    const Vec3 impulse = (a.velocity - end.balls[0].velocity) * a.mass;
    const double push = impulse.dot(n);
    const double along = (impulse - n * push).norm();
    const Vec3 slip = before - n * before.dot(n);
    // Up to 10 m/s and 7 m/s of the rims; as surfaces κ = 0.1 makes 11 times as much of a change of velocity;
    // bisection and n are right to 2^-63, magnified by 1/√(1 - 0.99²) = 7.
    const double speed = 11.0 * rounding(17.0);
    EXPECT_NEAR(after.dot(n), -s.ball_contact.restitution * before.dot(n), speed);
    EXPECT_LE(along, s.ball_contact.friction * push + speed * a.mass);
    EXPECT_LT((impulse - n * push).cross(slip).norm(), speed * a.mass * slip.norm());
    EXPECT_LE((impulse - n * push).dot(slip), speed * a.mass * slip.norm());
    const bool slides = along >= s.ball_contact.friction * push - speed * a.mass;
    ++(slides ? slid : stuck);
    if (!slides) {
      const Vec3 turned = slip * -s.ball_contact.tangential_restitution;
      EXPECT_LT((after - n * after.dot(n) - turned).norm(), speed);
    }
  }
  EXPECT_GT(stuck, 50);
  EXPECT_GT(slid, 50);
}

TEST(ClosedFormRoughPair, MomentaAreKept_AndEnergyNeverRises_RandomScenes) {
  constexpr std::uint64_t kSeed = 61;
  Random random(kSeed);
  for (int k = 0; k < 400; ++k) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", scene " + std::to_string(k));
    const Scenario s = rough_pair(random);
    const Moment end = at(s, 4.0);
    Vec3 momentum = -end.tally.external_impulse;
    Vec3 angular = -end.tally.external_angular_impulse;
    double energy = 0.0;
    double scale = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      const Ball& ball = s.balls[i];
      const BallState& now = end.balls[i];
      if (!std::isfinite(ball.mass)) continue;
      scale += ball.mass;
      momentum += ball.mass * (now.velocity - ball.velocity);
      angular += angular_momentum(ball, now.position, now.velocity, now.spin) -
                 angular_momentum(ball, ball.position, ball.velocity, ball.spin);
      energy += kinetic(ball, now.velocity, now.spin) - kinetic(ball, ball.velocity, ball.spin);
    }
    // Up to 10 m/s at 40 m; energies of 50 J/kg and 25 J/kg in the spin.
    EXPECT_LT(momentum.norm(), rounding(10.0 * scale));
    EXPECT_LT(angular.norm(), rounding(400.0 * scale));
    // An immovable ball that spins is a motor.
    if (std::isfinite(s.balls[1].mass)) {
      EXPECT_LE(energy, rounding(75.0 * scale));
    }
  }
}

TEST(ClosedFormRoughPair, OppositeSpins_MeshLikeGears_AndEqualOnesBrake) {
  // Test 7 of Chung and Ooi (2011): ±0.2 m/s, r = 0.1 m, e = 0.5, μ = 0.4.
  Scenario s = scene({{.mass = 1.0, .radius = 0.1, .position = {-0.3, 0, 0}, .velocity = {0.2, 0, 0}},
                      {.mass = 1.0, .radius = 0.1, .position = {0.3, 0, 0}, .velocity = {-0.2, 0, 0}}},
                     2.0);
  s.ball_contact = {.restitution = 0.5, .friction = 0.4};
  s.balls[0].spin.z() = 10.0;
  s.balls[1].spin.z() = -10.0;
  const Moment gears = at(s, 2.0);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(gears.balls[i].spin, s.balls[i].spin);
    EXPECT_EQ(gears.balls[i].velocity.y(), 0.0);
    EXPECT_NEAR(gears.balls[i].velocity.x(), -0.5 * s.balls[i].velocity.x(), rounding(0.2));
  }
  s.balls[1].spin.z() = 10.0;
  const Moment brakes = at(s, 2.0);
  // Slip 2 m/s needs (2/7) ½ of it to stick, 0.29 N s; μ J = 0.4 × 1.5 × 0.2 = 0.12 N s, so that it slides.
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(brakes.balls[i].spin.z(), 10.0 - 2.5 * 0.12 / 0.1, rounding(10.0));
    EXPECT_NEAR(std::abs(brakes.balls[i].velocity.y()), 0.12, rounding(0.2));
  }
}

}  // namespace
}  // namespace carom::test
