#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "carom/laws/frictionless.h"
#include "carom/laws/three_parameter.h"
#include "core/random.h"

namespace carom::test {
namespace {

constexpr int kTrials = 3000;

/// Two balls that touch and approach, in one law and one dimension.
template <class LawType, int kDimension>
struct Case {
  using Law = LawType;
  static constexpr int kDim = kDimension;
};

template <int Dim>
Vec<Dim> random_vector(Random& random) {
  Vec<Dim> v;
  for (int axis = 0; axis < Dim; ++axis) v[axis] = random.normal();
  return v;
}

template <class C>
struct Pair {
  static constexpr int kDim = C::kDim;
  std::vector<Ball> balls;
  World<kDim> world;
  Vec<kDim> normal;
  Contact surface;

  Pair(std::vector<Ball> both, const Vec<kDim>& n, const Contact& contact)
      : balls(std::move(both)), world(balls, C::Law::kFriction), normal(n), surface(contact) {}

  Vec<kDim> impact() { return C::Law::template between<kDim>(world, 0, 1, normal, surface); }

  double mass(std::size_t i) const { return balls[i].mass; }
  double moment_of_inertia(std::size_t i) const {
    return balls[i].inertia * mass(i) * balls[i].radius * balls[i].radius;
  }
  Vec3 velocity(std::size_t i) const { return widened<kDim>(world.velocity[i]); }
  Vec3 spin(std::size_t i) const {
    return world.spins() ? widened_spin<kDim>(world.spin[i]) : Vec3(Vec3::Zero());
  }

  Vec3 momentum() const { return mass(0) * velocity(0) + mass(1) * velocity(1); }
  Vec3 angular_momentum() const {
    Vec3 sum = Vec3::Zero();
    for (const std::size_t i : {0U, 1U}) {
      sum += balls[i].position.cross(mass(i) * velocity(i)) + moment_of_inertia(i) * spin(i);
    }
    return sum;
  }
  double energy() const {
    double sum = 0.0;
    for (const std::size_t i : {0U, 1U}) {
      sum += 0.5 * (mass(i) * velocity(i).squaredNorm() + moment_of_inertia(i) * spin(i).squaredNorm());
    }
    return sum;
  }

  double v_n() const { return normal.dot(world.velocity[1] - world.velocity[0]); }
  /// Written here with cross products in space, apart from the law.
  Vec3 tangential_slip() const {
    const Vec3 n = widened<kDim>(normal);
    const Vec3 turning = balls[0].radius * spin(0) + balls[1].radius * spin(1);
    const Vec3 slip = velocity(1) - velocity(0) - turning.cross(n);
    return slip - n.dot(slip) * n;
  }

  double reduced_mass() const { return 1.0 / (1.0 / mass(0) + 1.0 / mass(1)); }
  double tangential_mass() const {
    double inverse = 1.0 / reduced_mass();
    for (const std::size_t i : {0U, 1U}) inverse += 1.0 / (balls[i].inertia * mass(i));
    return 1.0 / inverse;
  }

  /// S, the speeds that are added up at a contact point, m/s.
  double speeds() const {
    double sum = 0.0;
    for (const std::size_t i : {0U, 1U}) sum += velocity(i).norm() + balls[i].radius * spin(i).norm();
    return sum;
  }

  /// What an impulse is off by, N s. Its normal part (1 + e) m v_n <= 2 m S is known to some ε; sliding
  /// multiplies it by μ, and sticking adds (1 + β0) m_t g_t <= 2 m S. The direction of a slip is known to
  /// ε S/|g_t|, but a sliding impulse is less than the sticking one, so that makes no more than 2 m ε S.
  /// A dozen roundings of ε/2 are in each of S, 1/m and 1/m_t: 16 ε in all.
  double impulse_error() const {
    return 16.0 * kEpsilon * 2.0 * reduced_mass() * (3.0 + surface.friction) * speeds();
  }
};

template <class C>
Pair<C> random_pair(Random& random) {
  constexpr int kDim = C::kDim;
  const Vec<kDim> normal = random_vector<kDim>(random).normalized();
  std::vector<Ball> balls(2);
  for (Ball& ball : balls) {
    ball.mass = std::pow(10.0, random.uniform(-6.0, 6.0));
    ball.radius = std::pow(10.0, random.uniform(-2.0, 2.0));
    ball.inertia = random.uniform(0.1, 1.0);
    ball.velocity = widened<kDim>(random_vector<kDim>(random));
    // Surfaces move about as fast as centres.
    if constexpr (C::Law::kFriction) {
      ball.spin = widened_spin<kDim>(random_vector<kSpinAxes<kDim>>(random)) / ball.radius;
    }
  }
  balls[0].position = widened<kDim>(random_vector<kDim>(random));
  const Vec3 n = widened<kDim>(normal);
  balls[1].position = balls[0].position + (balls[0].radius + balls[1].radius) * n;
  const double opening = n.dot(balls[1].velocity - balls[0].velocity);
  balls[1].velocity -= (opening + random.uniform(0.01, 2.0)) * n;
  // Half of the surfaces are hardly rough, so that sliding is as common as sticking.
  const double friction = random.uniform() < 0.5 ? random.uniform(0.0, 0.3) : random.uniform(0.0, 10.0);
  return {balls, normal, {random.uniform(), friction, random.uniform(-1.0, 1.0)}};
}

template <class C>
class ImpactLaw : public ::testing::Test {
 protected:
  static constexpr int kDim = C::kDim;

  /// Calls check(pair) for many pairs; a failure names the pair.
  template <class Check>
  static void for_random_pairs(std::uint64_t seed, Check check) {
    Random random(seed);
    for (int trial = 0; trial < kTrials; ++trial) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", trial " + std::to_string(trial));
      check(random_pair<C>(random), random);
      if (::testing::Test::HasFailure()) return;
    }
  }

  /// The pair as the orthogonal map `turn` leaves it; spins are axial vectors.
  static Pair<C> mapped(const Pair<C>& pair, const Eigen::Matrix3d& turn) {
    std::vector<Ball> balls = pair.balls;
    for (Ball& ball : balls) {
      ball.position = turn * ball.position;
      ball.velocity = turn * ball.velocity;
      ball.spin = turn.determinant() * (turn * ball.spin);
    }
    return {balls, flattened<kDim>(turn * widened<kDim>(pair.normal)), pair.surface};
  }

  /// After their impacts `image` is what the map makes of `pair`.
  static void expect_same_impact(Pair<C> pair, Pair<C> image, const Eigen::Matrix3d& turn) {
    const double error = 2.0 * std::max(pair.impulse_error(), image.impulse_error());
    // The map itself rounds what it is given, ε per component.
    const double mapping = 8.0 * kEpsilon * std::max(pair.speeds(), image.speeds());
    const Vec3 impulse = widened<kDim>(pair.impact());
    EXPECT_LE((widened<kDim>(image.impact()) - turn * impulse).norm(), error);
    for (const std::size_t i : {0U, 1U}) {
      EXPECT_LE((image.velocity(i) - turn * pair.velocity(i)).norm(), error / pair.mass(i) + mapping);
      const Vec3 turned_spin = turn.determinant() * (turn * pair.spin(i));
      const double radius = pair.balls[i].radius;
      EXPECT_LE(radius * (image.spin(i) - turned_spin).norm(),
                error / (pair.balls[i].inertia * pair.mass(i)) + mapping);
    }
  }
};

using Cases = ::testing::Types<Case<Frictionless, 2>, Case<Frictionless, 3>, Case<ThreeParameter, 2>,
                               Case<ThreeParameter, 3>>;
TYPED_TEST_SUITE(ImpactLaw, Cases);

TYPED_TEST(ImpactLaw, ConservesMomentum_AnyMassRatio) {
  this->for_random_pairs(1, [](auto pair, Random&) {
    const Vec3 before = pair.momentum();
    const double scale = pair.mass(0) * pair.velocity(0).norm() + pair.mass(1) * pair.velocity(1).norm();
    const double push = pair.impact().norm();
    // The velocities are rounded after their change, the masses by their inverses, the changes by both: 8 ε.
    EXPECT_LE((pair.momentum() - before).norm(), 8.0 * kEpsilon * (scale + push));
  });
}

TYPED_TEST(ImpactLaw, ConservesAngularMomentumWithSpin_AboutAnyPoint) {
  this->for_random_pairs(2, [](auto pair, Random&) {
    const Vec3 before = pair.angular_momentum();
    double scale = 0.0;
    double reach = 0.0;
    for (const std::size_t i : {0U, 1U}) {
      const double arm = pair.balls[i].position.norm();
      scale += arm * pair.mass(i) * pair.velocity(i).norm() + pair.moment_of_inertia(i) * pair.spin(i).norm();
      reach += arm + pair.balls[i].radius;
    }
    const double push = pair.impact().norm();
    // As for momentum; and the two contact points differ by the rounding of the second ball's place. Cross
    // products add two products per component: 16 ε.
    EXPECT_LE((pair.angular_momentum() - before).norm(), 16.0 * kEpsilon * (scale + reach * push));
  });
}

TYPED_TEST(ImpactLaw, LosesExactlyWhatTheFormulaSays_AndNeverGains) {
  this->for_random_pairs(3, [](auto pair, Random&) {
    const double before = pair.energy();
    const double v_n = pair.v_n();
    const double slip = pair.tangential_slip().norm();
    // An impulse that is off by δJ changes the energy by δJ (u + u')/2, and both are at most 2 S here; the
    // energies themselves are sums of a dozen terms.
    const double error = 2.0 * pair.impulse_error() * pair.speeds() + 16.0 * kEpsilon * before;
    pair.impact();
    const double e = pair.surface.restitution;
    double lost = 0.5 * pair.reduced_mass() * (1.0 - e * e) * v_n * v_n;
    if (pair.world.spins()) {
      const double after = pair.tangential_slip().norm();
      lost += 0.5 * pair.tangential_mass() * (slip - after) * (slip + after);
    }
    EXPECT_NEAR(before - pair.energy(), lost, error);
    EXPECT_LE(pair.energy(), before + error);
  });
}

TYPED_TEST(ImpactLaw, KeepsTheEnergy_ElasticAndSmooth) {
  this->for_random_pairs(4, [](auto pair, Random&) {
    pair.surface = {1.0, 0.0, pair.surface.tangential_restitution};
    const double before = pair.energy();
    const double error = 2.0 * pair.impulse_error() * pair.speeds() + 16.0 * kEpsilon * before;
    pair.impact();
    EXPECT_NEAR(pair.energy(), before, error);
  });
}

TYPED_TEST(ImpactLaw, TurnsTheNormalVelocityByMinusE_AndPushesOnly) {
  this->for_random_pairs(5, [](auto pair, Random&) {
    const double before = pair.v_n();
    const double error = pair.impulse_error() / pair.reduced_mass();
    const auto impulse = pair.impact();
    EXPECT_GT(impulse.dot(pair.normal), 0.0);
    EXPECT_NEAR(pair.v_n(), -pair.surface.restitution * before, error);
    EXPECT_GE(pair.v_n(), -error);
  });
}

TYPED_TEST(ImpactLaw, MirroredPair_DoesTheMirroredThing) {
  this->for_random_pairs(6, [](const auto& pair, Random& random) {
    const Vec3 across = widened<TypeParam::kDim>(random_vector<TypeParam::kDim>(random).normalized());
    const Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity() - 2.0 * across * across.transpose();
    TestFixture::expect_same_impact(pair, TestFixture::mapped(pair, mirror), mirror);
  });
}

TYPED_TEST(ImpactLaw, RotatedPair_DoesTheRotatedThing) {
  this->for_random_pairs(7, [](const auto& pair, Random& random) {
    const Vec3 axis = TypeParam::kDim == 2 ? Vec3(Vec3::UnitZ()) : random_vector<3>(random).normalized();
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(random.uniform(0.0, 2.0 * std::numbers::pi), axis).toRotationMatrix();
    TestFixture::expect_same_impact(pair, TestFixture::mapped(pair, turn), turn);
  });
}

TYPED_TEST(ImpactLaw, BoostedPair_GetsTheSameImpulse) {
  this->for_random_pairs(8, [](auto pair, Random& random) {
    auto balls = pair.balls;
    const Vec3 boost = widened<TypeParam::kDim>(random_vector<TypeParam::kDim>(random));
    for (Ball& ball : balls) ball.velocity += boost;
    Pair<TypeParam> moving(balls, pair.normal, pair.surface);
    const double error = pair.impulse_error() + moving.impulse_error();
    EXPECT_LE((moving.impact() - pair.impact()).norm(), error);
  });
}

TYPED_TEST(ImpactLaw, NamedTheOtherWayRound_PushesTheOtherWay) {
  this->for_random_pairs(9, [](auto pair, Random&) {
    Pair<TypeParam> swapped({pair.balls[1], pair.balls[0]}, -pair.normal, pair.surface);
    const double error = 2.0 * pair.impulse_error();
    EXPECT_LE((swapped.impact() + pair.impact()).norm(), error);
  });
}

TYPED_TEST(ImpactLaw, Wall_IsAnImmovableBall) {
  this->for_random_pairs(10, [](auto pair, Random&) {
    auto balls = pair.balls;
    balls[0].mass = std::numeric_limits<double>::infinity();
    balls[0].velocity = Vec3::Zero();
    balls[0].spin = Vec3::Zero();
    // Approaching, whatever the other ball did.
    balls[1].velocity -= (0.01 + std::abs(balls[1].velocity.norm())) * widened<TypeParam::kDim>(pair.normal);
    Pair<TypeParam> on_ball(balls, pair.normal, pair.surface);
    auto world = on_ball.world;
    const double mass = balls[1].mass;
    const double error = on_ball.impulse_error();
    const auto on_wall =
        TypeParam::Law::template on_wall<TypeParam::kDim>(world, 1, pair.normal, pair.surface);
    EXPECT_LE((on_ball.impact() - on_wall).norm(), error);
    EXPECT_LE((on_ball.world.velocity[1] - world.velocity[1]).norm(),
              error / mass + kEpsilon * on_ball.speeds());
    EXPECT_EQ(on_ball.velocity(0), Vec3(Vec3::Zero()));
    EXPECT_EQ(on_ball.spin(0), Vec3(Vec3::Zero()));
  });
}

// --- along the surface

template <class C>
class RoughImpact : public ImpactLaw<C> {};
using RoughCases = ::testing::Types<Case<ThreeParameter, 2>, Case<ThreeParameter, 3>>;
TYPED_TEST_SUITE(RoughImpact, RoughCases);

TYPED_TEST(RoughImpact, SticksOrSlides_ByTheSmallerImpulse) {
  int sticking = 0;
  this->for_random_pairs(11, [&sticking](auto pair, Random&) {
    const Vec3 slip = pair.tangential_slip();
    const Vec3 n = widened<TypeParam::kDim>(pair.normal);
    const double beta0 = pair.surface.tangential_restitution;
    const double error = pair.impulse_error();
    const double slip_error = error / pair.tangential_mass();
    const Vec3 impulse = widened<TypeParam::kDim>(pair.impact());
    const Vec3 tangential = impulse - n.dot(impulse) * n;
    const Vec3 after = pair.tangential_slip();
    const double stick = (1.0 + beta0) * pair.tangential_mass() * slip.norm();
    const double slide = pair.surface.friction * n.dot(impulse);
    EXPECT_LE((tangential + std::min(stick, slide) * slip.normalized()).norm(), error);
    if (stick < slide) {
      ++sticking;
      EXPECT_LE((after + beta0 * slip).norm(), slip_error);
    }
    // What is left of the slip lies between -β0 and all of it: reversed at most by the tangential rebound.
    EXPECT_LE(after.dot(slip.normalized()), slip.norm() + slip_error);
    EXPECT_GE(after.dot(slip.normalized()), -beta0 * slip.norm() - slip_error);
  });
  EXPECT_GT(sticking, kTrials / 4);
  EXPECT_LT(sticking, 3 * kTrials / 4);
}

TYPED_TEST(RoughImpact, SlidingImpulse_NeverReversesTheSlip_WithoutTangentialRebound) {
  this->for_random_pairs(12, [](auto pair, Random&) {
    pair.surface.tangential_restitution = 0.0;
    const Vec3 slip = pair.tangential_slip();
    const double slip_error = pair.impulse_error() / pair.tangential_mass();
    const Vec3 impulse = widened<TypeParam::kDim>(pair.impact());
    EXPECT_LE(impulse.dot(slip.normalized()), pair.impulse_error());
    EXPECT_GE(pair.tangential_slip().dot(slip.normalized()), -slip_error);
  });
}

TYPED_TEST(RoughImpact, KeepsTheEnergy_ElasticAndStickingWithFullReboundOrNone) {
  this->for_random_pairs(13, [](auto pair, Random& random) {
    // β0 = 1 turns the slip round, β0 = -1 leaves it. |v_n| >= 0.01 and |g_t| < 10² m/s, so no such impact
    // slides.
    const double before = pair.energy();
    const double error = 2.0 * pair.impulse_error() * pair.speeds() + 16.0 * kEpsilon * before;
    pair.surface = {1.0, 1e4, random.uniform() < 0.5 ? 1.0 : -1.0};
    pair.impact();
    EXPECT_NEAR(pair.energy(), before, error);
  });
}

// --- the numbers of a benchmark: Y. C. Chung, J. Y. Ooi, "Benchmark tests for verifying discrete element
// modelling codes at particle impact level", Granular Matter 13, 643 (2011). Solid spheres; the y-axis is the
// wall's normal, x is along it, and a spin about z is counterclockwise. Of a solid sphere m/m_t = 1 + 5/2.

constexpr double kSphereTurning = 3.5;

/// A ball that flies onto the floor, after the impact.
World<2> after_floor(double radius_m, const Vec3& velocity, double spin_radps, const Contact& surface) {
  Ball ball;
  ball.radius = radius_m;
  ball.velocity = velocity;
  ball.spin = Vec3(0.0, 0.0, spin_radps);
  World<2> world({ball}, true);
  ThreeParameter::on_wall<2>(world, 0, Vec<2>::UnitY(), surface);
  return world;
}

/// Some roundings of numbers of this size.
double rounding(double scale) {
  return 16.0 * kEpsilon * scale;
}

TEST(ChungOoi, Test4_ObliqueImpactOnAWall) {
  constexpr double kRadius_m = 0.0025;
  constexpr double kSpeed_mps = 3.9;
  // With β0 = 0 the ball would stick at 30°, below tan γ = 3.5 μ (1 + e)/(1 + β0); with what Foerster et al.
  // measured on glass it slides from 24° on.
  const Contact surface{0.98, 0.092, 0.44};
  struct Row {
    double degrees;
    double tangential_restitution;  ///< as printed, three decimals and more
    double spin_radps;              ///< as printed, one decimal; against our sense of rotation
  };
  for (const Row& row : {Row{30.0, 0.6845, -615.2}, Row{50.0, 0.847, -456.7}, Row{70.0, 0.934, -243.0}}) {
    const double angle = row.degrees * std::numbers::pi / 180.0;
    const Vec3 velocity = kSpeed_mps * Vec3(std::sin(angle), -std::cos(angle), 0.0);
    const World<2> world = after_floor(kRadius_m, velocity, 0.0, surface);
    const double e_t = world.velocity[0][0] / velocity[0];
    EXPECT_NEAR(e_t, 1.0 - 0.092 * 1.98 / std::tan(angle), rounding(1.0)) << row.degrees;
    const double spin = -2.5 * 0.092 * 1.98 * kSpeed_mps * std::cos(angle) / kRadius_m;
    EXPECT_NEAR(world.spin[0][0], spin, rounding(std::abs(spin))) << row.degrees;
    // Half of the last printed digit.
    EXPECT_NEAR(e_t, row.tangential_restitution, 0.5e-3) << row.degrees;
    EXPECT_NEAR(world.spin[0][0], row.spin_radps, 0.06) << row.degrees;
  }
}

TEST(ChungOoi, Test5_ElasticImpact_SlidesBySevenFrictions) {
  constexpr double kRadius_m = 10e-6;
  constexpr double kNormal_mps = 5.0;
  const Contact surface{1.0, 0.3, 0.0};
  constexpr double kFriction_mps = 0.3 * kNormal_mps;
  // From just above the seven that it takes to stop a sliding sphere's surface.
  for (double ratio = 7.5; ratio < 20.0; ratio += 0.5) {
    const Vec3 velocity(ratio * kFriction_mps, -kNormal_mps, 0.0);
    const World<2> world = after_floor(kRadius_m, velocity, 0.0, surface);
    const double slip = world.velocity[0][0] + kRadius_m * world.spin[0][0];
    EXPECT_NEAR(slip / kFriction_mps, ratio - 7.0, rounding(ratio));
    EXPECT_NEAR(kRadius_m * world.spin[0][0] / kFriction_mps, -5.0, rounding(5.0));
  }
}

TEST(ChungOoi, Test6_SpinningImpactOnAWall) {
  constexpr double kRadius_m = 0.1;
  constexpr double kNormal_mps = 0.2;
  const Contact surface{0.5, 0.4, 0.0};
  for (double spin_radps = 5.0; spin_radps < 60.0; spin_radps += 5.0) {
    const World<2> world = after_floor(kRadius_m, Vec3(0.0, -kNormal_mps, 0.0), spin_radps, surface);
    const double slip = kRadius_m * spin_radps;
    const double after = world.velocity[0][0] + kRadius_m * world.spin[0][0];
    EXPECT_NEAR(-after / slip, -1.0 + kSphereTurning * 0.4 * 1.5 * kNormal_mps / slip, rounding(1.0))
        << spin_radps;
  }
}

/// Two balls that meet head-on along x, after the impact.
World<2> after_head_on(Ball left, Ball right, const Contact& surface) {
  left.position = Vec3(-left.radius, 0.0, 0.0);
  right.position = Vec3(right.radius, 0.0, 0.0);
  World<2> world({left, right}, true);
  ThreeParameter::between<2>(world, 0, 1, Vec<2>::UnitX(), surface);
  return world;
}

TEST(ChungOoi, Test7_OppositeSpins_DoNotSlip) {
  Ball left;
  left.radius = 0.1;
  left.velocity = Vec3(0.2, 0.0, 0.0);
  for (const double spin_radps : {1.0, 10.0, 100.0}) {
    left.spin = Vec3(0.0, 0.0, spin_radps);
    Ball right = left;
    right.velocity = -left.velocity;
    right.spin = -left.spin;
    const World<2> world = after_head_on(left, right, {0.5, 0.4, 0.0});
    EXPECT_EQ(world.spin[0][0], spin_radps);
    EXPECT_EQ(world.spin[1][0], -spin_radps);
    EXPECT_EQ(world.velocity[0][1], 0.0);
    EXPECT_EQ(world.velocity[1][1], 0.0);
  }
}

TEST(ChungOoi, Test8_SpinningImpactOnAHeavyBall) {
  constexpr double kNormal_mps = 0.2;
  Ball ball;
  ball.radius = 0.1;
  ball.velocity = Vec3(kNormal_mps, 0.0, 0.0);
  Ball heavy;
  heavy.radius = 0.5;
  heavy.mass = 1000.0 * 125.0;  // a thousand times denser, five times larger
  for (double spin_radps = 5.0; spin_radps < 60.0; spin_radps += 5.0) {
    ball.spin = Vec3(0.0, 0.0, spin_radps);
    const World<2> world = after_head_on(ball, heavy, {0.5, 0.4, 0.0});
    const double slip = ball.radius * spin_radps;
    const double of_ball = world.velocity[0][1] + ball.radius * world.spin[0][0];
    const double of_heavy = world.velocity[1][1] - heavy.radius * world.spin[1][0];
    EXPECT_NEAR(-(of_ball - of_heavy) / slip, -1.0 + kSphereTurning * 0.4 * 1.5 * kNormal_mps / slip,
                rounding(1.0))
        << spin_radps;
  }
}

}  // namespace
}  // namespace carom::test
