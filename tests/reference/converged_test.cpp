#include "reference/converged/converged.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/random.h"
#include "reference/closed_form/closed_form.h"
#include "reference/exact/exact.h"
#include "scenario/catalog.h"
#include "scenario/parse.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

using testing::HasSubstr;

/// What a source says of a scene, at `frames` equal moments after the start.
struct Told {
  Solution solution;
  std::vector<std::vector<BallState>> frames;  ///< as far as it is known
  std::vector<Tally> tallies;

  const std::vector<BallState>& end() const { return frames.back(); }
};

Told told_by(const TruthSource& source, const Scenario& s, std::int64_t frames = 16) {
  Told told;
  EXPECT_EQ(source.refuses(s), "");
  std::vector<Moment> moments;
  for (std::int64_t k = 0; k <= frames; ++k) {
    moments.push_back({s.duration_s / static_cast<double>(frames), k});
  }
  told.solution =
      source.solve(s, moments, [&](std::size_t, std::span<const BallState> balls, const Tally& tally) {
        told.frames.emplace_back(balls.begin(), balls.end());
        told.tallies.push_back(tally);
      });
  return told;
}

Told converged(Scenario s, const ConvergedSettings& settings = {}, std::int64_t frames = 16) {
  s.truth = TruthKind::converged;
  return told_by(*make_converged_truth(settings), s, frames);
}

/// The largest distance of any ball from where the other says it is, over the frames that both know.
double apart_m(const Told& a, const Told& b) {
  double apart = 0.0;
  for (std::size_t k = 0; k < std::min(a.frames.size(), b.frames.size()); ++k) {
    for (std::size_t i = 0; i < a.frames[k].size(); ++i) {
      apart = std::max(apart, (a.frames[k][i].position - b.frames[k][i].position).norm());
    }
  }
  return apart;
}

Scenario scene(int dimension, double duration_s, std::vector<Ball> balls = {}) {
  Scenario s;
  s.dimension = dimension;
  s.duration_s = duration_s;
  s.balls = std::move(balls);
  return s;
}

Ball ball(const Vec3& position, const Vec3& velocity = Vec3::Zero(), double mass = 1.0, double radius = 0.1) {
  return {.mass = mass, .radius = radius, .position = position, .velocity = velocity};
}

void add_box(Scenario& s, double half_m) {
  for (int axis = 0; axis < s.dimension; ++axis) {
    s.walls.push_back({Vec3::Unit(axis), -half_m});
    s.walls.push_back({-Vec3::Unit(axis), -half_m});
  }
}

/// A few balls, one in each corner of a box, with one kind of drag or the Magnus force or both, with or
/// without gravity, friction and losses.
Scenario random_scene(Random& random, int balls) {
  Scenario s = scene(random.uniform() < 0.5 ? 2 : 3, 1.0);
  add_box(s, 1.0);
  for (int i = 0; i < balls; ++i) {
    const Vec3 corner(i % 2 == 0 ? -0.5 : 0.5, i / 2 % 2 == 0 ? -0.5 : 0.5, 0.0);
    Ball b = ball(corner + random_vector(random, s.dimension, 0.1), random_vector(random, s.dimension, 3.0),
                  random.uniform(0.5, 2.0), random.uniform(0.1, 0.35));
    b.spin = s.dimension == 2 ? Vec3(0, 0, random.uniform(-20.0, 20.0)) : random_vector(random, 3, 20.0);
    s.balls.push_back(b);
  }
  s.effects.spin = true;
  if (random.uniform() < 0.5) s.effects.gravity = random_vector(random, s.dimension, 10.0);
  const auto kind = random.uniform() < 0.5 ? Drag::Kind::linear : Drag::Kind::quadratic;
  if (random.uniform() < 0.8) s.effects.drag = Drag{kind, random.uniform(0.0, 0.5)};
  if (random.uniform() < 0.5) s.effects.magnus = random.uniform(-0.2, 0.2);
  for (Contact* contact : {&s.ball_contact, &s.wall_contact}) {
    contact->restitution = random.uniform(0.6, 1.0);
    if (random.uniform() < 0.5) contact->friction = random.uniform(0.0, 0.5);
    contact->tangential_restitution = random.uniform(-1.0, 1.0);
  }
  return s;
}

// -------------------------------------------------------------------------------- against the closed forms

/// Compares the two truths of a scene, where there are both.
void expect_agreement(const Scenario& s, std::int64_t frames = 16) {
  const auto source = make_closed_form_truth();
  ASSERT_EQ(source->refuses(s), "");
  const Told exact = told_by(*source, s, frames);
  const Told integrated = converged(s, {}, frames);
  EXPECT_LE(apart_m(exact, integrated), exact.solution.uncertainty_m + integrated.solution.uncertainty_m);
  for (std::size_t k = 0; k < integrated.frames.size(); ++k) {
    EXPECT_EQ(exact.tallies[k].impacts, integrated.tallies[k].impacts) << "frame " << k;
  }
}

TEST(ConvergedTruth, AgreesWithClosedForms_SceneFiles) {
  const Catalog catalog(std::filesystem::path(CAROM_SOURCE_DIR) / "scenarios");
  int compared = 0;
  for (const std::filesystem::path& file : catalog.all()) {
    Scenario s = *load_scene(file);
    if (!make_closed_form_truth()->refuses(s).empty()) continue;
    s.truth = TruthKind::converged;
    if (!make_converged_truth()->refuses(s).empty()) continue;
    SCOPED_TRACE(s.id);
    const Told exact = told_by(*make_closed_form_truth(), s, s.frames);
    const Told integrated = converged(s, {}, s.frames);
    if (integrated.frames.empty()) continue;
    EXPECT_LE(apart_m(exact, integrated), exact.solution.uncertainty_m + integrated.solution.uncertainty_m);
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

TEST(ConvergedTruth, AgreesWithClosedForms_RandomFlights) {
  Random random(401);
  for (int round = 0; round < 16; ++round) {
    SCOPED_TRACE(round);
    const int dimension = round % 2 == 0 ? 2 : 3;
    Scenario s = scene(dimension, random.uniform(0.1, 3.0));
    Ball b = ball(random_vector(random, dimension, 1.0), random_vector(random, dimension, 5.0),
                  random.uniform(0.2, 5.0));
    switch (round / 2 % 4) {
      case 0:  // linear drag and gravity
        s.effects.gravity = random_vector(random, dimension, 10.0);
        s.effects.drag = Drag{Drag::Kind::linear, random.uniform(0.0, 2.0)};
        break;
      case 1:  // quadratic drag alone
        s.effects.drag = Drag{Drag::Kind::quadratic, random.uniform(0.0, 2.0)};
        break;
      case 2:  // quadratic drag along gravity, up, down and from rest
        s.effects.gravity = Vec3(0, -kGravity, 0);
        s.effects.drag = Drag{Drag::Kind::quadratic, random.uniform(0.01, 2.0)};
        b.velocity = Vec3(0, random.uniform() < 0.3 ? 0.0 : random.uniform(-8.0, 8.0), 0);
        break;
      default:  // the Magnus force and gravity
        s.effects.spin = true;
        s.effects.gravity = random_vector(random, dimension, 10.0);
        s.effects.magnus = random.uniform(0.05, 0.3);
        b.spin = dimension == 2 ? Vec3(0, 0, random.uniform(-30.0, 30.0)) : random_vector(random, 3, 30.0);
    }
    s.balls = {b};
    expect_agreement(s);
  }
}

TEST(ConvergedTruth, AgreesWithClosedForms_RandomImpacts) {
  Random random(402);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const int dimension = round % 2 == 0 ? 2 : 3;
    Scenario s = scene(dimension, 2.0);
    s.effects.spin = true;
    const auto spin = [&] {
      return dimension == 2 ? Vec3(0, 0, random.uniform(-20.0, 20.0)) : random_vector(random, 3, 20.0);
    };
    Contact contact{random.uniform(0.3, 1.0), random.uniform(0.0, 0.6), random.uniform(-1.0, 1.0)};
    s.ball_contact = s.wall_contact = contact;
    if (round % 4 < 2) {  // two balls, of any masses and moments
      Ball a = ball({-1, 0, 0}, {random.uniform(0.5, 3.0), 0, 0}, random.uniform(0.1, 9.0), 0.3);
      Ball b = ball(Vec3(1, 0, 0) + random_vector(random, dimension, 0.2), {random.uniform(-3.0, 0.0), 0, 0},
                    round % 8 == 0 ? kInfinity : random.uniform(0.1, 9.0), 0.2);
      a.inertia = random.uniform(0.2, 0.6);
      a.spin = spin();
      b.spin = spin();
      s.balls = {a, b};
    } else {  // a bounce or more on a rough floor
      s.effects.gravity = Vec3(0, -kGravity, 0);
      s.walls = {{Vec3::UnitY(), 0.0}};
      s.wall_contact.restitution = random.uniform(0.8, 1.0);
      Ball b = ball({0, random.uniform(0.2, 2.0), 0}, random_vector(random, dimension, 2.0));
      b.spin = spin();
      s.balls = {b};
    }
    expect_agreement(s);
  }
}

/// Under linear drag at one rate k = c/m, without gravity, velocities only shrink all alike, by e^{-kt}. The
/// balls go the ways that they would go without drag, and are at t where they would be at
///
///   s = (1 - e^{-kt})/k,
///
/// through any number of smooth impacts. So a row of balls in drag, whose impacts no closed form here has,
/// can be held against one without.
TEST(ConvergedTruth, LinearDrag_IsASlowedClock_RowOfBalls) {
  Random random(403);
  constexpr double kRate = 0.7;  // 1/s
  std::int64_t impacts = 0;
  for (int round = 0; round < 10; ++round) {
    SCOPED_TRACE(round);
    Scenario free = scene(2, 1.0);
    free.ball_contact.restitution = random.uniform(0.8, 1.0);
    free.walls = {{Vec3::UnitX(), -3.0}, {-Vec3::UnitX(), -3.0}};
    for (int i = 0; i < 5; ++i) {
      free.balls.push_back(ball({i - 2.0, 0, 0}, {random.uniform(-4.0, 4.0), 0, 0}));
    }
    Scenario dragged = free;
    dragged.duration_s = 2.0;
    dragged.effects.drag = Drag{Drag::Kind::linear, kRate};
    free.duration_s = -std::expm1(-kRate * dragged.duration_s) / kRate;
    const Told slow = converged(dragged, {}, 1);
    const Told exact = told_by(*make_closed_form_truth(), free, 1);
    ASSERT_FALSE(slow.solution.known_until_s) << slow.solution.limit;
    impacts += slow.solution.impact_count;
    EXPECT_EQ(slow.solution.impact_count, exact.solution.impact_count);
    // s is off by its two roundings, and balls are no faster than 5 m/s.
    const double clock_m = 2.0 * kEpsilon * free.duration_s * 5.0;
    EXPECT_LE(apart_m({{}, {slow.end()}, {}}, {{}, {exact.end()}, {}}),
              slow.solution.uncertainty_m + exact.solution.uncertainty_m + clock_m);
  }
  EXPECT_GT(impacts, 50);
}

/// Two sources that share nothing, through many rough and lossy impacts of several balls.
TEST(ConvergedTruth, AgreesWithTheExactTruth_GravityFrictionAndSeveralBalls) {
  Random random(412);
  std::int64_t impacts = 0;
  int whole = 0;
  for (int round = 0; round < 20; ++round) {
    SCOPED_TRACE(round);
    Scenario s = random_scene(random, 4);
    s.effects.drag.reset();
    s.effects.magnus.reset();
    const Told exact = told_by(*make_exact_truth(), s);
    const Told integrated = converged(s);
    EXPECT_LE(apart_m(exact, integrated), exact.solution.uncertainty_m + integrated.solution.uncertainty_m);
    for (std::size_t k = 0; k < std::min(exact.frames.size(), integrated.frames.size()); ++k) {
      EXPECT_EQ(exact.tallies[k].impacts, integrated.tallies[k].impacts) << "frame " << k;
      impacts = std::max(impacts, integrated.tallies[k].impacts);
    }
    if (integrated.frames.size() == 17U) ++whole;
  }
  EXPECT_GT(impacts, 10);
  EXPECT_GT(whole, 15);  // in the others a ball comes to rest
}

// --------------------------------------------------------------------------------------- its own uncertainty

/// What a coarse pair of runs claims is never less than what it is wrong by, against one of full precision.
TEST(ConvergedTruth, ClaimedError_IsNotBelowTrueError_CoarseRuns) {
  const ConvergedSettings coarse = {
      .fine = {.order = 10, .bits = 40}, .coarse = {.order = 8, .bits = 33}, .tolerance = 1e-2};
  const ConvergedSettings much_finer = {.fine = {.order = 16, .bits = 64},
                                        .coarse = {.order = 14, .bits = 57}};
  Random random(404);
  int inexact = 0;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    Scenario s = random_scene(random, 2);
    s.duration_s = 0.3;
    const Told rough = converged(s, coarse, 4);
    const Told truth = converged(s, much_finer, 4);
    const double wrong_m = apart_m(rough, truth);
    EXPECT_LE(wrong_m, rough.solution.uncertainty_m + truth.solution.uncertainty_m);
    if (wrong_m > 100.0 * truth.solution.uncertainty_m) ++inexact;
  }
  EXPECT_GT(inexact, 150);  // so that there was something to claim
}

TEST(ConvergedTruth, Uncertainty_IsThatOfADouble_FewImpacts) {
  Random random(405);
  for (int round = 0; round < 8; ++round) {
    const Told told = converged(random_scene(random, 2));
    // Centres stay within 1 m: one rounding, and of the integration nothing that shows.
    EXPECT_LE(told.solution.uncertainty_m, 1.01 * kEpsilon);
  }
}

// ---------------------------------------------------------------------------------------------- conservation

/// d/dt E = -Σ c |v|^p with p = 2 or 3, E with the energy of height: integrated by Simpson's rule.
TEST(ConvergedTruth, Energy_FallsByTheWorkOfDrag_BothKinds) {
  Random random(406);
  for (int round = 0; round < 8; ++round) {
    Scenario s = scene(3, 1.0);
    const bool linear = round % 2 == 0;
    const double c = 0.3;
    s.effects.gravity = Vec3(1.0, -kGravity, 0.5);
    s.effects.drag = Drag{linear ? Drag::Kind::linear : Drag::Kind::quadratic, c};
    s.effects.spin = true;
    s.effects.magnus = 0.1;
    s.balls = {ball(Vec3::Zero(), random_vector(random, 3, 5.0) + Vec3(5, 0, 0))};
    s.balls[0].spin = random_vector(random, 3, 20.0);
    constexpr std::int64_t kIntervals = 1000;
    const Told told = converged(s, {}, kIntervals);
    const auto energy = [&](std::size_t k) {
      const BallState& b = told.frames[k][0];
      return 0.5 * b.velocity.squaredNorm() - s.effects.gravity->dot(b.position);
    };
    double work = 0.0;
    for (std::size_t k = 0; k <= kIntervals; ++k) {
      const double weight = k == 0 || k == kIntervals ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0);
      work += weight / (3.0 * kIntervals) * c * std::pow(told.frames[k][0].velocity.norm(), linear ? 2 : 3);
    }
    // Simpson's error is h⁴/180 of the fourth derivative, a rate of at most 10/s each time, of c v³ < 400 W:
    // (1e-3)⁴/180 × 10⁴ × 400 = 2.3e-8 J.
    EXPECT_NEAR(energy(kIntervals) - energy(0), -work, 2.3e-8);
  }
}

/// The Magnus force does no work and changes sign with the spin: with v and ω turned round all goes back.
TEST(ConvergedTruth, GoesBack_WhenVelocitiesAndSpinsAreTurnedRound_PureMagnus) {
  Random random(407);
  for (int round = 0; round < 10; ++round) {
    SCOPED_TRACE(round);
    Scenario s = random_scene(random, 3);
    s.effects.drag.reset();
    s.effects.gravity.reset();
    s.effects.magnus = 0.1;
    s.ball_contact = s.wall_contact = Contact{};
    const Told there = converged(s, {}, 1);
    ASSERT_FALSE(there.solution.known_until_s) << there.solution.limit;
    Scenario back = s;
    for (std::size_t i = 0; i < s.balls.size(); ++i) {
      back.balls[i].position = there.end()[i].position;
      back.balls[i].velocity = -there.end()[i].velocity;
      back.balls[i].spin = -there.end()[i].spin;
    }
    const Told again = converged(back, {}, 1);
    ASSERT_EQ(again.frames.size(), 2U);
    // Where it turns round places and velocities are rounded, of up to 1 m and 6 m/s × 1 s; a random change
    // grows by the amplification, one in another direction by some times as much.
    const double change_m = 8.0 * again.solution.amplification.back() * 6.0 * kEpsilon;
    for (std::size_t i = 0; i < s.balls.size(); ++i) {
      EXPECT_LE((again.end()[i].position - s.balls[i].position).norm(), change_m);
    }
  }
}

/// Momentum changes by what acts from outside: walls, a ball that is held.
TEST(ConvergedTruth, Tally_AccountsForMomentum_MagnusFreeFlight) {
  Random random(408);
  for (int round = 0; round < 10; ++round) {
    Scenario s = random_scene(random, 4);
    s.effects.drag.reset();
    s.effects.magnus.reset();
    s.effects.gravity.reset();
    s.balls[3].mass = kInfinity;
    s.balls[3].velocity.setZero();
    const Told told = converged(s);
    Vec3 gained = Vec3::Zero();
    Vec3 turned = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      const Ball& b = s.balls[i];
      const double moment = b.inertia * b.mass * b.radius * b.radius;
      const BallState& end = told.end()[i];
      gained += b.mass * (end.velocity - b.velocity);
      turned += b.mass * (end.position.cross(end.velocity) - b.position.cross(b.velocity)) +
                moment * (end.spin - b.spin);
    }
    // Some 20 roundings of at most 2 kg × 6 m/s × 1 m.
    constexpr double kRounding = 20.0 * kEpsilon * 12.0;
    EXPECT_LE((gained - told.tallies.back().external_impulse).norm(), kRounding);
    EXPECT_LE((turned - told.tallies.back().external_angular_impulse).norm(), kRounding);
  }
}

// ------------------------------------------------------------------------------------------- hard to find

/// A ball on a Magnus circle of radius ρ about the origin comes to ρ + r from it. A wall at ρ + r - δ is hit
/// however small δ, and at ρ + r + δ is not.
TEST(ConvergedTruth, GrazedWall_IsHitOrNot_ByTheLastDigitsOfADouble) {
  for (const double delta : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    for (const double sign : {-1.0, 1.0}) {
      SCOPED_TRACE(fmt::format("{} {}", sign, delta));
      Scenario s = scene(2, 3.0);
      s.effects.spin = true;
      s.effects.magnus = 1.0;
      s.balls = {ball({-0.5, 0, 0}, {0, -1, 0}, 1.0, 0.125)};  // Ω = 2 rad/s, ρ = ½ m
      s.balls[0].spin = Vec3(0, 0, 2.0);
      s.walls = {{-Vec3::UnitX(), -(0.625 + sign * delta)}};
      EXPECT_EQ(converged(s, {}, 1).solution.impact_count, sign < 0.0 ? 1 : 0);
    }
  }
}

/// Two balls on parallel ways, in drag, pass each other at a gap of ±δ.
TEST(ConvergedTruth, GrazedBall_IsHitOrNot_ByTheLastDigitsOfADouble) {
  for (const double delta : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    for (const double sign : {-1.0, 1.0}) {
      SCOPED_TRACE(fmt::format("{} {}", sign, delta));
      Scenario s = scene(2, 2.0);
      s.effects.drag = Drag{Drag::Kind::quadratic, 0.1};
      s.balls = {ball({-1, 0, 0}, {2, 0, 0}, 1.0, 0.125),
                 ball({1, 0.25 + sign * delta, 0}, {-2, 0, 0}, 1.0, 0.125)};
      EXPECT_EQ(converged(s, {}, 1).solution.impact_count, sign < 0.0 ? 1 : 0);
    }
  }
}

TEST(ConvergedTruth, Top_IsPassed_NearlyStraightThrow) {
  for (const double across : {0.0, 1e-20, 1e-3}) {
    SCOPED_TRACE(across);
    Scenario s = scene(2, 2.0);
    s.effects.gravity = Vec3(0, -kGravity, 0);
    s.effects.drag = Drag{Drag::Kind::quadratic, 0.2};
    s.balls = {ball(Vec3::Zero(), {across, 8.0, 0})};
    const Told told = converged(s, {}, 8);
    ASSERT_FALSE(told.solution.known_until_s) << told.solution.limit;
    Scenario straight = s;
    straight.balls[0].velocity.x() = 0.0;
    const Told exact = told_by(*make_closed_form_truth(), straight, 8);
    // The way across is no longer than across × 2 s; upwards it changes by the square of that.
    EXPECT_LE(apart_m(told, exact),
              told.solution.uncertainty_m + exact.solution.uncertainty_m + 2.1 * across);
  }
}

// ------------------------------------------------------------------------------------------------- its ends

TEST(ConvergedTruth, EndsWhereBouncingEnds_AtTheKnownTime) {
  Scenario s = scene(2, 10.0);
  s.effects.gravity = Vec3(0, -kGravity, 0);
  s.walls = {{Vec3::UnitY(), 0.0}};
  s.wall_contact.restitution = 0.5;
  s.balls = {ball({0, 1.1, 0})};
  const Told told = converged(s);
  ASSERT_TRUE(told.solution.known_until_s);
  // T = √(2h/g) (1 + e)/(1 - e) with h = 1 m; what is left when the bounces cannot be told apart is far
  // below.
  EXPECT_NEAR(*told.solution.known_until_s, std::sqrt(2.0 / kGravity) * 3.0, 1e-12);
  EXPECT_THAT(told.solution.limit, HasSubstr("rest"));
  EXPECT_LT(told.frames.size(), 17U);
}

TEST(ConvergedTruth, EndsWhereABallComesToRest_UnderDrag) {
  for (const auto kind : {Drag::Kind::linear, Drag::Kind::quadratic}) {
    Scenario s = scene(2, 10.0);
    s.effects.gravity = Vec3(0, -kGravity, 0);
    s.effects.drag = Drag{kind, 0.5};
    s.walls = {{Vec3::UnitY(), 0.0}};
    s.wall_contact.restitution = 0.5;
    s.balls = {ball({0, 1.1, 0}, {0.3, 0, 0})};
    const Told told = converged(s);
    ASSERT_TRUE(told.solution.known_until_s);
    EXPECT_GT(*told.solution.known_until_s, 0.9);
    EXPECT_LT(*told.solution.known_until_s, 1.6);
    EXPECT_THAT(told.solution.limit, HasSubstr("ball 0 and wall 0"));
  }
}

TEST(ConvergedTruth, GoesOn_AfterAnInelasticHit_WhereTheBallsPartByThemselves) {
  Scenario s = scene(2, 2.0, {ball({-1, 0, 0}, {2, 0, 0}), ball({0, 0.1, 0})});
  s.effects.drag = Drag{Drag::Kind::linear, 0.1};
  s.ball_contact.restitution = 0.0;
  const Told told = converged(s);
  EXPECT_FALSE(told.solution.known_until_s) << told.solution.limit;
  EXPECT_EQ(told.solution.impact_count, 1);
}

/// Of three equal balls on a line the one in the middle can be met from either side without end, in finite
/// time, where e < 7 - 4√3 = 0.0718 (S. McNamara, W. R. Young, Phys. Fluids A 4, 496, 1992).
TEST(ConvergedTruth, EndsInACollapse_OnlyBelowTheKnownRestitution) {
  for (const double e : {0.06, 0.071, 0.0725, 0.09}) {
    SCOPED_TRACE(e);
    Scenario s =
        scene(2, 3.0, {ball({-1, 0, 0}, {1, 0, 0}), ball({0, 0, 0}), ball({1, 0, 0}, {-0.99, 0, 0})});
    s.ball_contact.restitution = e;
    const Told told = converged(s);
    EXPECT_EQ(told.solution.known_until_s.has_value(), e < 7.0 - 4.0 * std::sqrt(3.0)) << told.solution.limit;
  }
}

TEST(ConvergedTruth, EndsAtATie_ThatSharesABall) {
  // The one in the middle is met from both sides at once.
  Scenario s = scene(2, 2.0, {ball({-1, 0, 0}, {1, 0, 0}), ball({0, 0, 0}), ball({1, 0, 0}, {-1, 0, 0})});
  s.effects.drag = Drag{Drag::Kind::linear, 0.1};
  const Told told = converged(s);
  ASSERT_TRUE(told.solution.known_until_s);
  // 0.8 m at first 1 m/s: (1 - e^{-0.1 t})/0.1 = 0.8.
  EXPECT_NEAR(*told.solution.known_until_s, -std::log1p(-0.08) / 0.1, 4.0 * kEpsilon);
  ASSERT_EQ(told.solution.ties.size(), 1U);
  EXPECT_TRUE(told.solution.ties[0].shares_ball);
  EXPECT_EQ(told.solution.ties[0].balls, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(ConvergedTruth, GoesOnPastATie_OfImpactsApart) {
  Scenario s = scene(2, 2.0);
  for (const double y : {0.0, 1.0}) {
    s.balls.push_back(ball({-1, y, 0}, {1, 0, 0}));
    s.balls.push_back(ball({0, y, 0}));
  }
  s.effects.drag = Drag{Drag::Kind::linear, 0.1};
  const Told told = converged(s);
  EXPECT_FALSE(told.solution.known_until_s);
  EXPECT_EQ(told.solution.impact_count, 2);
  ASSERT_EQ(told.solution.ties.size(), 1U);
  EXPECT_FALSE(told.solution.ties[0].shares_ball);
  EXPECT_EQ(told.solution.ties[0].balls, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST(ConvergedTruth, EndsWhereItsBudgetIsSpent) {
  Random random(409);
  ConvergedSettings settings;
  settings.most_work = 50'000;
  Scenario s = random_scene(random, 4);
  s.duration_s = 100.0;
  s.effects.drag = Drag{Drag::Kind::linear, 0.001};
  s.effects.gravity.reset();
  const Told told = converged(s, settings);
  ASSERT_TRUE(told.solution.known_until_s);
  EXPECT_THAT(told.solution.limit, HasSubstr("budget"));
}

TEST(ConvergedTruth, EndsWhereTheRunsDiffer_LongGas) {
  Random random(410);
  // 30 bits are used up after a dozen impacts per ball.
  const ConvergedSettings coarse = {
      .fine = {.order = 8, .bits = 34}, .coarse = {.order = 7, .bits = 30}, .tolerance = 1e-4};
  Scenario s = random_scene(random, 4);
  s.duration_s = 20.0;
  s.effects.drag.reset();
  s.effects.gravity.reset();
  s.ball_contact = s.wall_contact = Contact{};
  const Told told = converged(s, coarse, 400);
  const Told truth = converged(s, {}, 400);
  ASSERT_TRUE(told.solution.known_until_s);
  EXPECT_THAT(told.solution.limit, HasSubstr("differ"));
  EXPECT_GT(told.frames.size(), 10U);
  EXPECT_LE(apart_m(told, truth), told.solution.uncertainty_m + truth.solution.uncertainty_m);
  EXPECT_GT(truth.frames.size(), told.frames.size());
}

// ---------------------------------------------------------------------------------------------- what it
// tells

TEST(ConvergedTruth, Amplification_IsThatOfTheFlight_LoneBall) {
  Scenario s = scene(3, 2.0, {ball(Vec3::Zero(), {1, 2, 3})});
  const double k = 0.5;
  s.effects.drag = Drag{Drag::Kind::linear, k};
  const Told told = converged(s);
  ASSERT_EQ(told.solution.amplification.size(), told.frames.size());
  // δx(t) = δx + δv (1 - e^{-kt})/k with |δx| <= δ, |δv| T <= δ, one of them equal to δ.
  for (std::size_t i = 0; i < told.frames.size(); ++i) {
    const double t = 2.0 * static_cast<double>(i) / 16.0;
    EXPECT_LE(told.solution.amplification[i], 1.0 - std::expm1(-k * t) / (k * 2.0) + 1e-3);
  }
  EXPECT_GT(told.solution.amplification[0], 0.0);
}

TEST(ConvergedTruth, Impacts_AreToldInOrder) {
  Random random(411);
  const Told told = converged(random_scene(random, 4));
  ASSERT_EQ(told.solution.impacts.size(), static_cast<std::size_t>(told.solution.impact_count));
  EXPECT_GT(told.solution.impact_count, 3);
  EXPECT_TRUE(std::is_sorted(told.solution.impacts.begin(), told.solution.impacts.end(),
                             [](const auto& a, const auto& b) { return a.time_s < b.time_s; }));
}

TEST(ConvergedTruth, Refuses_WhatItCannotDo) {
  const auto source = make_converged_truth();
  Scenario s = scene(2, 1.0, {ball(Vec3::Zero()), ball({1, 0, 0})});
  EXPECT_THAT(source->refuses(s), HasSubstr("by name"));
  s.effects.drag = Drag{Drag::Kind::linear, 0.1};
  EXPECT_EQ(source->refuses(s), "");
  const auto reason_with = [&](auto change) {
    Scenario changed = s;
    change(changed);
    return source->refuses(changed);
  };
  EXPECT_THAT(reason_with([](Scenario& c) { c.slabs.emplace_back(); }), HasSubstr("slabs"));
  EXPECT_THAT(reason_with([](Scenario& c) { c.barriers.emplace_back(); }), HasSubstr("barriers"));
  EXPECT_THAT(reason_with([](Scenario& c) { c.events.emplace_back(); }), HasSubstr("events"));
  EXPECT_THAT(reason_with([](Scenario& c) { c.multi_contact = MultiContact::simultaneous; }),
              HasSubstr("pair at a time"));
  EXPECT_THAT(reason_with([](Scenario& c) { c.balls[1].position.x() = 0.1; }), HasSubstr("overlapping"));
  EXPECT_THAT(reason_with([](Scenario& c) {
                c.walls = {{Vec3::UnitX(), 0.0}};
              }),
              HasSubstr("outside a wall"));
}

}  // namespace
}  // namespace carom::test
