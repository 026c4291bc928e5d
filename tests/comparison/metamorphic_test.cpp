#include "comparison/metamorphic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

/// Everything that a scene can have, in space.
Scenario everything() {
  Scenario scene = *gas(3, 6, 0.05, 4.0, 3);
  scene.effects.gravity = Vec3(0.5, -2.0, 0.25);
  scene.effects.drag = Drag{Drag::Kind::quadratic, 0.125};
  scene.effects.spin = true;
  scene.effects.magnus = 0.5;
  Random random(7);
  for (Ball& ball : scene.balls) ball.spin = random_vector(random, 3, 5.0);
  scene.walls.push_back({Vec3(2, -3, 6) / 7, -9.0});
  scene.slabs.push_back({Vec3(0, 1, 0), 1.0, 0.25});
  scene.barriers.push_back({Vec3(1, 0, 0), 2.0, 0.5, 3.0, 0.75, 9});
  scene.events.push_back({0.5, 2, {SetVelocity{Vec3(1, 2, 3)}, SetPosition{Vec3(4, 5, 6)}, ScaleMass{1.5}}});
  return scene;
}

void expect_close(const BallState& got, const BallState& expected, double tolerance) {
  EXPECT_LE((got.position - expected.position).norm(), tolerance);
  EXPECT_LE((got.velocity - expected.velocity).norm(), tolerance);
  EXPECT_LE((got.spin - expected.spin).norm(), tolerance);
}

Twin twin_of(const Scenario& scene, Symmetry symmetry) {
  return make_twin(scene, symmetry, states_of(scene));
}

/// The symmetries that are a frame and change no digit, and those that round.
const std::vector<Symmetry> kExact = {Symmetry::mirror, Symmetry::rotate_90, Symmetry::relabel,
                                      Symmetry::rescale_2, Symmetry::reverse};
const std::vector<Symmetry> kRounding = {Symmetry::rotate_1_rad, Symmetry::boost, Symmetry::rescale_1_7};

TEST(Twin, StartsWhereTheSceneStarts_SeenBack) {
  for (const int dimension : {2, 3}) {
    const Scenario scene = *gas(dimension, 20, 0.1, 4.0, 5);
    const std::vector<BallState> start = states_of(scene);
    for (const auto& [symmetries, tolerance] :
         {std::pair(kExact, 0.0), std::pair(kRounding, 64 * kEpsilon)}) {
      for (const Symmetry symmetry : symmetries) {
        SCOPED_TRACE(name_of(symmetry));
        const Twin twin = twin_of(scene, symmetry);
        const std::vector<BallState> seen = states_of(twin.scenario);
        // Coordinates of up to 4 m and a few m/s, each rounded a few times on the way there and back.
        for (std::size_t i = 0; i < start.size(); ++i)
          expect_close(twin.back(seen, i, 0.0), start[i], tolerance);
      }
    }
  }
}

TEST(Frame, UnseenIsTheInverseOfSeen_AtAnyTime) {
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    Frame frame;
    frame.map = Eigen::AngleAxisd(random.uniform(-3, 3), random_vector(random, 3, 1.0).normalized())
                    .toRotationMatrix();
    if (n % 2 == 0) frame.map.col(0) *= -1.0;
    frame.boost = random_vector(random, 3, 5.0);
    frame.length = random.uniform(0.3, 3);
    frame.time = random.uniform(0.3, 3);
    frame.mass = random.uniform(0.3, 3);
    const BallState state{random_vector(random, 3, 4.0), random_vector(random, 3, 4.0),
                          random_vector(random, 3, 4.0)};
    const double time_s = random.uniform(0, 10);
    // Numbers of up to 50, divided by at least 0.3, in some ten roundings.
    expect_close(frame.unseen(frame.seen(state, time_s), time_s), state, 10 * 50 / 0.3 * kEpsilon);
  }
}

// The spin of a body is what carries its points: v = ω × x must hold in the mirror too.
TEST(Frame, SpinCarriesPoints_InEveryFrame) {
  const Scenario scene = everything();
  const Vec3 arm(0.3, -0.2, 0.5);
  for (const Symmetry symmetry : {Symmetry::mirror, Symmetry::rotate_90, Symmetry::rotate_1_rad,
                                  Symmetry::rescale_2, Symmetry::rescale_1_7}) {
    SCOPED_TRACE(name_of(symmetry));
    const Frame frame = twin_of(scene, symmetry).frame;
    const Vec3 spin(1.5, -2.0, 0.7);
    const BallState point = frame.seen({arm, spin.cross(arm), spin}, 0.0);
    EXPECT_LE((point.spin.cross(point.position) - point.velocity).norm(), 32 * kEpsilon);
  }
}

// By dimension: whatever the units, ratios of like quantities are what they are.
TEST(Rescaled, DimensionlessNumbers_StayTheSame) {
  for (const Drag::Kind kind : {Drag::Kind::linear, Drag::Kind::quadratic}) {
    Scenario scene = everything();
    scene.effects.drag->kind = kind;
    const auto numbers = [](const Scenario& s) {
      const Ball& ball = s.balls[0];
      const double v = ball.velocity.norm();
      const double drag_N =
          s.effects.drag->coefficient * (s.effects.drag->kind == Drag::Kind::linear ? v : v * v);
      const double inertia_N = ball.mass * v * v / ball.radius;
      const Barrier& barrier = s.barriers[0];
      return std::vector<double>{s.effects.gravity->norm() * ball.radius / (v * v),
                                 drag_N / inertia_N,
                                 *s.effects.magnus * ball.spin.cross(ball.velocity).norm() / inertia_N,
                                 ball.spin.norm() * ball.radius / v,
                                 v * s.duration_s / ball.radius,
                                 v * s.step_s / ball.radius,
                                 v * s.events[0].time / ball.radius,
                                 s.walls.back().offset / ball.radius,
                                 s.box->max.x() / ball.radius,
                                 s.slabs[0].offset / ball.radius,
                                 s.slabs[0].thickness / ball.radius,
                                 barrier.offset / ball.radius,
                                 barrier.height / (ball.mass * v * v),
                                 barrier.hbar / (ball.mass * v * barrier.thickness),
                                 std::get<SetVelocity>(s.events[0].actions[0]).velocity.norm() / v,
                                 std::get<SetPosition>(s.events[0].actions[1]).position.norm() / ball.radius,
                                 std::get<ScaleMass>(s.events[0].actions[2]).factor};
    };
    const std::vector<double> expected = numbers(scene);
    EXPECT_EQ(numbers(twin_of(scene, Symmetry::rescale_2).scenario), expected);
    const std::vector<double> rounded = numbers(twin_of(scene, Symmetry::rescale_1_7).scenario);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      // Five scaled factors at most, and as many roundings of what is made of them.
      EXPECT_NEAR(rounded[i] / expected[i], 1.0, 20 * kEpsilon) << "number " << i;
    }
  }
}

/// How deep each ball is in each solid: what an isometry must leave.
std::vector<double> depths(const Scenario& scene) {
  std::vector<double> depths;
  for (const Ball& ball : scene.balls) {
    for (const Wall& wall : scene.walls) depths.push_back(wall.normal.dot(ball.position) - wall.offset);
    for (const Slab& slab : scene.slabs) depths.push_back(slab.normal.dot(ball.position) - slab.offset);
    for (const Barrier& b : scene.barriers) depths.push_back(b.normal.dot(ball.position) - b.offset);
    depths.push_back(scene.effects.gravity->dot(ball.velocity));
    depths.push_back(ball.spin.cross(ball.velocity).dot(ball.position));
  }
  return depths;
}

TEST(Isometry, LeavesEveryDistanceAndAngle) {
  const Scenario scene = everything();
  for (const Symmetry symmetry : {Symmetry::mirror, Symmetry::rotate_90, Symmetry::rotate_1_rad}) {
    SCOPED_TRACE(name_of(symmetry));
    // The box's walls come in the order of the axes, so that a mirror changes two of them.
    std::vector<double> expected = depths(scene);
    std::vector<double> seen = depths(twin_of(scene, symmetry).scenario);
    std::sort(expected.begin(), expected.end());
    std::sort(seen.begin(), seen.end());
    ASSERT_EQ(seen.size(), expected.size());
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_NEAR(seen[i], expected[i], 400 * kEpsilon);
  }
}

TEST(Isometry, KeepsABoxWhereAxesBecomeAxes) {
  const Scenario scene = *gas(2, 4, 0.1, 4.0, 1);
  const Scenario turned = twin_of(scene, Symmetry::rotate_90).scenario;
  ASSERT_TRUE(turned.box);
  EXPECT_EQ(turned.box->min, Vec3(-4, 0, 0));
  EXPECT_EQ(turned.box->max, Vec3(0, 4, 0));
  ASSERT_EQ(turned.walls.size(), 4U);
  EXPECT_EQ(turned.walls[0].normal, Vec3::UnitX().eval());
  EXPECT_EQ(turned.walls[0].offset, -4.0);
  EXPECT_EQ(turned.walls[1].normal, (-Vec3::UnitX()).eval());
  EXPECT_EQ(turned.walls[1].offset, 0.0);
  const Scenario askew = twin_of(scene, Symmetry::rotate_1_rad).scenario;
  EXPECT_FALSE(askew.box);
  ASSERT_EQ(askew.walls.size(), 4U);
  EXPECT_NEAR(askew.walls[0].normal.x(), std::cos(1.0), kEpsilon);
}

TEST(Relabelled, GivesEveryBallAnotherNumber_AndEventsWithIt) {
  Scenario scene = everything();
  scene.barriers.clear();
  const Twin twin = twin_of(scene, Symmetry::relabel);
  std::set<std::size_t> places(twin.place.begin(), twin.place.end());
  EXPECT_EQ(places.size(), scene.balls.size());
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    EXPECT_NE(twin.place[i], i);
    EXPECT_EQ(twin.scenario.balls[twin.place[i]].position, scene.balls[i].position);
  }
  EXPECT_EQ(twin.scenario.events[0].ball, twin.place[2]);
}

TEST(Disturbed, MovesEveryBallByLittle_ButNoneOfInfiniteMass) {
  Scenario scene = *gas(2, 8, 0.1, 4.0, 1);
  scene.balls[3].mass = std::numeric_limits<double>::infinity();
  const Scenario moved = disturbed_twin(scene, 1e-6, 1e-3).scenario;
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    const Vec3 x = moved.balls[i].position - scene.balls[i].position;
    const Vec3 v = moved.balls[i].velocity - scene.balls[i].velocity;
    EXPECT_EQ(x.z(), 0.0);
    if (i == 3) {
      EXPECT_TRUE(x.isZero(0.0) && v.isZero(0.0));
    } else {
      EXPECT_GT(x.norm(), 0.0);
      EXPECT_LE(x.cwiseAbs().maxCoeff(), 1.001e-6);
      EXPECT_LE(v.cwiseAbs().maxCoeff(), 1.001e-3);
    }
  }
}

struct Refusal {
  const char* name;
  Symmetry symmetry;
  void (*change)(Scenario&);
  const char* reason;  ///< empty: it applies
};

std::ostream& operator<<(std::ostream& out, const Refusal& refusal) {
  return out << refusal.name;
}

class NotSymmetric : public testing::TestWithParam<Refusal> {};

TEST_P(NotSymmetric, SaysWhy) {
  Scenario scene = free_scene(2, std::vector<Ball>(2), 1.0, 0.1);
  GetParam().change(scene);
  EXPECT_EQ(not_symmetric(scene, GetParam().symmetry), GetParam().reason);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, NotSymmetric,
    testing::Values(
        Refusal{"FreeBoost", Symmetry::boost, [](Scenario&) {}, ""},
        Refusal{"Walls", Symmetry::boost, [](Scenario& s) { s.walls.emplace_back(); }, "walls stand still"},
        Refusal{"Slab", Symmetry::boost, [](Scenario& s) { s.slabs.emplace_back(); },
                "slabs and barriers stand still"},
        Refusal{"Drag", Symmetry::boost, [](Scenario& s) { s.effects.drag = Drag{}; },
                "drag is relative to the air, which stands still"},
        Refusal{"Magnus", Symmetry::boost, [](Scenario& s) { s.effects.magnus = 1.0; },
                "the Magnus force is relative to the air, which stands still"},
        Refusal{"Alone", Symmetry::relabel, [](Scenario& s) { s.balls.resize(1); }, "a single ball"},
        Refusal{"Draws", Symmetry::relabel, [](Scenario& s) { s.barriers.emplace_back(); },
                "who passes a barrier is drawn by the ball's number"},
        Refusal{"FreeReversal", Symmetry::reverse, [](Scenario& s) { s.effects.magnus = 1.0; }, ""},
        Refusal{"Lossy", Symmetry::reverse, [](Scenario& s) { s.ball_contact.restitution = 0.9; },
                "impacts lose energy"},
        Refusal{"LossyButNobodyMeets", Symmetry::reverse,
                [](Scenario& s) {
                  s.ball_contact.restitution = 0.9;
                  s.effects.collisions = false;
                },
                ""},
        Refusal{"LossyWallsThatAreNotThere", Symmetry::reverse,
                [](Scenario& s) { s.wall_contact.restitution = 0.9; }, ""},
        Refusal{"Friction", Symmetry::reverse, [](Scenario& s) { s.ball_contact.friction = 0.1; },
                "friction loses energy"},
        Refusal{"Dragged", Symmetry::reverse, [](Scenario& s) { s.effects.drag = Drag{}; },
                "drag loses energy"},
        Refusal{"Barrier", Symmetry::reverse, [](Scenario& s) { s.barriers.emplace_back(); },
                "a barrier draws who passes"},
        Refusal{"Events", Symmetry::reverse, [](Scenario& s) { s.events.emplace_back(); },
                "its events have their times"}),
    [](const auto& info) { return info.param.name; });

TEST(NotSymmetric, NothingStandsAgainstMirrorsTurnsAndUnits) {
  for (const Symmetry symmetry : {Symmetry::mirror, Symmetry::rotate_90, Symmetry::rotate_1_rad,
                                  Symmetry::rescale_2, Symmetry::rescale_1_7}) {
    EXPECT_EQ(not_symmetric(everything(), symmetry), "");
  }
}

}  // namespace
}  // namespace carom::test
