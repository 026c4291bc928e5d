#include <gtest/gtest.h>

#include <limits>
#include <variant>

#include "carom/evolvers/event_evolver.h"
#include "carom/evolvers/event_search.h"
#include "carom/evolvers/traits.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

/// What the evolver is compiled with, and how its scenes are made.
template <int kDimensions, bool kGravity, class ImpactLaw>
struct Kind {
  static constexpr int kDim = kDimensions;
  static constexpr bool kFalls = kGravity;
  using Law = ImpactLaw;

  /// A gas of this kind, that runs for `duration_s`. Under gravity all is elastic: see event_refusal().
  static Scenario gas_of(int count, double packing, double restitution, std::uint64_t seed,
                         double duration_s) {
    Scenario scene = *gas(kDim, count, packing, 4.0, seed);
    if constexpr (kGravity) scene.effects.gravity = Vec3(0.25, -1.0, 0.0);
    scene.ball_contact.restitution = scene.wall_contact.restitution = kGravity ? 1.0 : restitution;
    if constexpr (Law::kFriction) {
      scene.effects.spin = true;
      scene.ball_contact.friction = scene.wall_contact.friction = 0.2;
    }
    scene.duration_s = duration_s;
    return scene;
  }
};

/// Enough for cells to be worth it, and not more than the search can look at.
constexpr int kBalls = 120;

template <class K>
class EventTwins : public testing::Test {
 protected:
  /// Runs the scene with plans and with the search, and expects the same bits at every cut and at the end.
  /// Returns the impacts.
  static std::int64_t run_both(const Scenario& scene, int cuts) {
    EventEvolver<K::kDim, K::kFalls, typename K::Law> planned(scene);
    EventEvolver<K::kDim, K::kFalls, typename K::Law, EventSearch> searched(scene);
    for (int cut = 0; cut < cuts; ++cut) {
      planned.advance(scene.duration_s / cuts, 1);
      searched.advance(scene.duration_s / cuts, 1);
      expect_same_states(states_of(planned, scene.balls.size()), states_of(searched, scene.balls.size()));
      expect_same_tallies(planned.tally(), searched.tally());
      if (testing::Test::HasFailure()) break;
    }
    return planned.tally().impacts;
  }

  static double outside_cells(const Scenario& scene) {
    const EventEvolver<K::kDim, K::kFalls, typename K::Law> planned(scene);
    return std::get<double>(planned.settings().at("balls_outside_cells"));
  }

 private:
  static void expect_same_states(const std::vector<BallState>& a, const std::vector<BallState>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].position, b[i].position) << "ball " << i;
      EXPECT_EQ(a[i].velocity, b[i].velocity) << "ball " << i;
      EXPECT_EQ(a[i].spin, b[i].spin) << "ball " << i;
    }
  }

  static void expect_same_tallies(const Tally& a, const Tally& b) {
    EXPECT_EQ(a.impacts, b.impacts);
    EXPECT_EQ(a.wall_impacts, b.wall_impacts);
    EXPECT_EQ(a.wall_push_Ns, b.wall_push_Ns);
    EXPECT_EQ(a.external_impulse, b.external_impulse);
    EXPECT_EQ(a.external_angular_impulse, b.external_angular_impulse);
    EXPECT_EQ(a.energy.ball_impacts_J, b.energy.ball_impacts_J);
    EXPECT_EQ(a.energy.wall_impacts_J, b.energy.wall_impacts_J);
    EXPECT_EQ(a.energy.friction_J, b.energy.friction_J);
  }
};

using Kinds = testing::Types<Kind<2, false, Frictionless>, Kind<3, false, Frictionless>,
                             Kind<2, true, Frictionless>, Kind<3, true, Frictionless>,
                             Kind<2, false, ThreeParameter>, Kind<3, false, ThreeParameter>>;
TYPED_TEST_SUITE(EventTwins, Kinds);

/// Over several windows of the clock, 0.5 s each.
TYPED_TEST(EventTwins, PlansMeetAsTheSearchDoes_BitForBit_InRandomGases) {
  std::int64_t impacts = 0;
  for (std::uint64_t seed = 1; seed <= 4 / kPart; ++seed) {
    const double packing = 0.1 + 0.04 * static_cast<double>(seed);
    const double restitution = seed % 2 == 0 ? 1.0 : 0.9;
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Scenario scene = TypeParam::gas_of(kBalls, packing, restitution, seed, 0.75);
    EXPECT_LT(this->outside_cells(scene), 0.2 * kBalls);
    impacts += this->run_both(scene, 4);
  }
  EXPECT_GT(impacts, 4 / kPart * kBalls / 2);
}

/// Some never move, some move and cannot be moved.
TYPED_TEST(EventTwins, PlansMeetAsTheSearchDoes_BitForBit_AmongImmovableBalls) {
  for (std::uint64_t seed = 11; seed < 11 + 4 / kPart; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Scenario scene = TypeParam::gas_of(40, 0.1, 0.9, seed, 2.0);
    for (std::size_t i = 0; i < 8; ++i) {
      scene.balls[i].mass = std::numeric_limits<double>::infinity();
      scene.balls[i].velocity *= i < 4 ? 0.0 : 0.1;
    }
    EXPECT_GT(this->run_both(scene, 4), 20);
  }
}

/// Rows of equal balls that fly at each other meet all at once, and cross from cell to cell at once: the
/// order is that of their numbers.
TYPED_TEST(EventTwins, PlansMeetAsTheSearchDoes_BitForBit_WhereManyMeetAtOnce) {
  Scenario scene = TypeParam::gas_of(2, 0.1, 1.0, 1, 8.0);
  scene.balls.clear();
  Random random(5);
  for (int x = 0; x < 6; ++x) {
    for (int y = 0; y < 6; ++y) {
      Ball ball;
      ball.radius = 0.125;
      ball.position = Vec3(0.5 + 0.5 * x, 0.5 + 0.5 * y, TypeParam::kDim == 2 ? 0.0 : 2.0);
      ball.velocity = Vec3(x % 2 == 0 ? 0.25 : -0.25, 0.0, 0.0);
      scene.balls.push_back(ball);
    }
  }
  for (std::size_t i = scene.balls.size(); i > 1; --i) {
    const auto other = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i)));
    std::swap(scene.balls[i - 1], scene.balls[other]);
  }
  EXPECT_GT(this->run_both(scene, 8), 6 * 6);
}

/// Small balls that fall together around a large one, which is in no cell, and fly off without walls, far out
/// of the box in which the cells began.
TYPED_TEST(EventTwins, PlansMeetAsTheSearchDoes_BitForBit_AroundAGiantWithoutWalls) {
  for (std::uint64_t seed = 21; seed <= 22; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Scenario scene = TypeParam::gas_of(kBalls, 0.1, 0.95, seed, 2.0);
    scene.walls.clear();
    Ball& giant = scene.balls[0];
    giant.position = Vec3(2.0, 2.0, TypeParam::kDim == 2 ? 0.0 : 2.0);
    giant.radius = TypeParam::kDim == 2 ? 0.4 : 0.8;
    for (std::size_t i = 1; i < scene.balls.size(); ++i) {
      scene.balls[i].radius *= 0.6;
      scene.balls[i].velocity -= scene.balls[i].position - giant.position;
    }
    std::erase_if(scene.balls, [centre = giant.position, reach = giant.radius](const Ball& ball) {
      return ball.position != centre && (ball.position - centre).norm() < reach + ball.radius;
    });
    EXPECT_GE(this->outside_cells(scene), 1.0);
    EXPECT_LT(this->outside_cells(scene), 0.2 * kBalls);
    EXPECT_GT(this->run_both(scene, 4), 50);
  }
}

}  // namespace
}  // namespace carom::test
