#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "carom/broad_phase/list.h"
#include "carom/compose.h"
#include "tests/support/scenes.h"

// What must hold for any right engine, without any truth: for every evolver, in the plane and in space, with
// everything that balls can be subject to, over random gases.
//
// Where a scene and its image are not rounded alike, their rounding errors grow as any disturbance does: the
// growth is measured with a twin of the scene that is disturbed in its first state, and what it makes of the
// rounding of every step is allowed.

namespace carom::test {
namespace {

constexpr std::int64_t kSteps = 60;
constexpr int kSeeds = 3;

/// What a gas is subject to. Each kind has its own way to break a symmetry.
struct Kind {
  std::string name;
  std::function<void(Scenario&)> engage;
};

void spin_up(Scenario& scene) {
  Random random(5);
  scene.effects.spin = true;
  for (Ball& ball : scene.balls) {
    ball.spin = scene.dimension == 2 ? Vec3(0, 0, random.uniform(-4, 4)) : random_vector(random, 3, 4.0);
  }
}

void fall(Scenario& scene) {
  scene.effects.gravity = Vec3(0.5, -2.0, scene.dimension == 3 ? 0.25 : 0.0);
}

void drag(Scenario& scene) {
  scene.effects.drag = Drag{Drag::Kind::linear, 0.25};
}

void drag_quadratically(Scenario& scene) {
  scene.effects.drag = Drag{Drag::Kind::quadratic, 0.5};
}

void curve(Scenario& scene) {
  spin_up(scene);
  scene.effects.magnus = 0.5;
}

void roughen(Scenario& scene) {
  spin_up(scene);
  scene.ball_contact = {0.9, 0.3, 0.4};
  scene.wall_contact = {0.8, 0.2, 0.1};
}

Kind smooth_kind() {
  return {"smooth", [](Scenario&) {}};
}

Kind falling_kind() {
  return {"falling", fall};
}

Kind rough_kind() {
  return {"rough", roughen};
}

Kind everything_kind() {
  return {"everything", [](Scenario& scene) {
            fall(scene);
            drag_quadratically(scene);
            curve(scene);
            roughen(scene);
            scene.wall_contact.restitution = 1.0;
          }};
}

/// Kinds in which balls do not come to rest. Rest begins with a rebound that is left out, and goes on from
/// gaps of the last bit, so that it is not defined to rounding.
const std::vector<Kind>& flying_kinds() {
  static const std::vector<Kind> kinds = {smooth_kind(),      falling_kind(), {"dragged", drag},
                                          {"curving", curve}, rough_kind(),   everything_kind()};
  return kinds;
}

/// With one in which balls bounce, slide and roll to rest on the floor, and on each other.
const std::vector<Kind>& all_kinds() {
  static const std::vector<Kind> kinds = [] {
    std::vector<Kind> all = flying_kinds();
    all.push_back({"settling", [](Scenario& scene) {
                     fall(scene);
                     *scene.effects.gravity *= 5.0;
                     drag(scene);
                     roughen(scene);
                   }});
    return all;
  }();
  return kinds;
}

/// How a state, or a scene, is seen from another frame: positions and velocities are mapped linearly, and
/// spins, which are no vectors under reflection, by det(map) map.
struct Isometry {
  Eigen::Matrix3d map;

  Vec3 operator()(const Vec3& v) const { return map * v; }
  Vec3 spin(const Vec3& spin) const { return map.determinant() * (map * spin); }

  BallState operator()(const BallState& state) const {
    return {map * state.position, map * state.velocity, spin(state.spin)};
  }

  Scenario operator()(const Scenario& scene) const {
    Scenario image = scene;
    for (Ball& ball : image.balls) {
      ball.position = map * ball.position;
      ball.velocity = map * ball.velocity;
      ball.spin = spin(ball.spin);
    }
    for (Wall& wall : image.walls) wall.normal = map * wall.normal;
    if (image.effects.gravity) image.effects.gravity = map * *image.effects.gravity;
    return image;
  }
};

class Symmetry : public testing::TestWithParam<std::tuple<std::string, int>> {
 protected:
  static std::string evolver() { return std::get<0>(GetParam()); }
  static int dimension() { return std::get<1>(GetParam()); }

  /// Calls check with a gas of every kind that the evolver takes, and every seed.
  static void for_each_gas(const std::vector<Kind>& kinds,
                           const std::function<void(const Scenario&)>& check) {
    for (const Kind& kind : kinds) {
      for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        SCOPED_TRACE(testing::Message() << kind.name << ", seed " << seed);
        Scenario scene = *gas(dimension(), 30, 0.1, 4.0, seed);
        kind.engage(scene);
        if (refusal(scene, {evolver(), ""}).empty()) check(scene);
      }
    }
  }

  struct Outcome {
    std::vector<BallState> states;
    std::int64_t impacts = 0;
  };

  static Outcome outcome_of(const Scenario& scene, std::int64_t steps = kSteps,
                            const std::string& broad_phase = {}) {
    const auto simulation = compose(scene, {evolver(), broad_phase});
    return {run(*simulation, scene, steps), simulation->tally().impacts};
  }

  /// How far apart two states of a ball are: m, m/s, and m/s of its surface.
  static double difference(const BallState& a, const BallState& b, double radius) {
    return std::max({(a.position - b.position).norm(), (a.velocity - b.velocity).norm(),
                     radius * (a.spin - b.spin).norm()});
  }

  static void expect_same(const Scenario& scene, const std::vector<BallState>& got,
                          const std::vector<BallState>& expected, double tolerance) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_LE(difference(got[i], expected[i], scene.balls[i].radius), tolerance) << "ball " << i;
    }
  }

  /// By how much the scene multiplies a small disturbance until the end, at least 1.
  static double growth(const Scenario& scene) {
    constexpr double kDisturbance = 1e-10;
    Scenario disturbed = scene;
    Random random(99);
    for (Ball& ball : disturbed.balls) {
      ball.position += random_vector(random, scene.dimension, kDisturbance);
      ball.velocity += random_vector(random, scene.dimension, kDisturbance);
    }
    const auto a = outcome_of(scene).states;
    const auto b = outcome_of(disturbed).states;
    double largest = 1.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      largest = std::max(largest, difference(a[i], b[i], scene.balls[i].radius) / kDisturbance);
    }
    return largest;
  }

  /// Round-off of a run: in each step a coordinate of up to 4 m, or a speed of a few m/s, is rounded twice.
  static double tolerance_of(const Scenario& scene) {
    return static_cast<double>(kSteps) * 2.0 * 4.0 * kEpsilon * growth(scene);
  }

  /// Runs the scene and its image, and holds the image of the outcome against the outcome of the image.
  static void expect_image(const Scenario& scene, const Scenario& image,
                           const std::function<BallState(const BallState&)>& map, double tolerance) {
    Outcome original = outcome_of(scene);
    const Outcome imaged = outcome_of(image);
    EXPECT_GT(original.impacts, 10);
    EXPECT_EQ(original.impacts, imaged.impacts);
    for (BallState& state : original.states) state = map(state);
    expect_same(scene, imaged.states, original.states, tolerance);
  }

  static void expect_image(const Scenario& scene, const Eigen::Matrix3d& map, double tolerance) {
    const Isometry isometry{map};
    expect_image(scene, isometry(scene), isometry, tolerance);
  }
};

TEST_P(Symmetry, Mirror_BitForBit) {
  for_each_gas(all_kinds(), [](const Scenario& gas) {
    Scenario scene = gas;
    // Clocks of `event` are rounded whenever it counts them anew, after 64 steps. Its cells do not lie
    // mirrored, so that it may look at a pair before that in one run, and after it in the other.
    if (evolver() == "event") scene.step_s = scene.duration_s / 64.0;
    expect_image(scene, Vec3(-1.0, 1.0, 1.0).asDiagonal(), 0.0);
    expect_image(scene, Vec3(1.0, -1.0, 1.0).asDiagonal(), 0.0);
  });
}

TEST_P(Symmetry, QuarterTurn) {
  Eigen::Matrix3d turn;
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  for_each_gas(flying_kinds(),
               [&](const Scenario& scene) { expect_image(scene, turn, tolerance_of(scene)); });
}

TEST_P(Symmetry, TurnByOneRadian) {
  const Vec3 axis = dimension() == 2 ? Vec3(Vec3::UnitZ()) : Vec3(Vec3(2, -3, 6) / 7);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.0, axis).toRotationMatrix();
  for_each_gas(flying_kinds(),
               [&](const Scenario& scene) { expect_image(scene, turn, tolerance_of(scene)); });
}

/// What acts may depend on velocities only among the balls: so neither drag nor the Magnus force.
TEST_P(Symmetry, GalileanBoost_WithoutWalls) {
  for_each_gas({smooth_kind(), falling_kind(), rough_kind()}, [](const Scenario& gas) {
    Scenario scene = gas;
    scene.walls.clear();
    const Vec3 middle(2, 2, scene.dimension == 3 ? 2 : 0);
    for (Ball& ball : scene.balls) ball.velocity -= 2.0 * (ball.position - middle);
    const Vec3 boost(0.7, -0.3, 0.0);
    Scenario boosted = scene;
    for (Ball& ball : boosted.balls) ball.velocity += boost;
    const auto seen = [&](const BallState& state) {
      return BallState{state.position + scene.duration_s * boost, state.velocity + boost, state.spin};
    };
    expect_image(scene, boosted, seen, tolerance_of(scene));
  });
}

/// Lengths, times and masses in units of powers of two: these change no digit.
TEST_P(Symmetry, UnitScaling_BitForBit) {
  const double length = 1024.0;
  const double time = 0.125;
  const double mass = 32.0;
  for_each_gas(all_kinds(), [&](const Scenario& scene) {
    Scenario scaled = scene;
    scaled.duration_s *= time;
    scaled.step_s *= time;
    for (Ball& ball : scaled.balls) {
      ball.mass *= mass;
      ball.radius *= length;
      ball.position *= length;
      ball.velocity *= length / time;
      ball.spin /= time;
    }
    for (Wall& wall : scaled.walls) wall.offset *= length;
    Effects& effects = scaled.effects;
    if (effects.gravity) *effects.gravity *= length / (time * time);
    if (effects.drag)
      effects.drag->coefficient *= mass / (effects.drag->kind == Drag::Kind::linear ? time : length);
    if (effects.magnus) *effects.magnus *= mass;
    const auto seen = [&](const BallState& state) {
      return BallState{length * state.position, (length / time) * state.velocity, state.spin / time};
    };
    expect_image(scene, scaled, seen, 0.0);
  });
}

/// Of the evolvers that find every impact at its time. `step` takes all impacts of a step for one moment's,
/// and moves balls out of what they overlap, which has no reverse.
class SymmetryInTime : public Symmetry {};

/// Which ball has which number decides nothing but the order of impacts at one moment.
TEST_P(SymmetryInTime, Relabelling_BitForBit) {
  for_each_gas(all_kinds(), [](const Scenario& scene) {
    Scenario relabelled = scene;
    std::reverse(relabelled.balls.begin(), relabelled.balls.end());
    Outcome image = outcome_of(relabelled);
    std::reverse(image.states.begin(), image.states.end());
    expect_same(scene, image.states, outcome_of(scene).states, 0.0);
  });
}

/// Balls that are turned back where they are return to where they came from, if nothing takes energy.
TEST_P(SymmetryInTime, Reversal_ReturnsToTheStart) {
  // Perfectly rough balls reverse all of the velocity at the contact, along the surface too.
  const Kind superballs = {"superballs", [](Scenario& scene) {
                             spin_up(scene);
                             scene.ball_contact = scene.wall_contact = {1.0, 1e9, 1.0};
                           }};
  for_each_gas({smooth_kind(), falling_kind(), superballs}, [](const Scenario& scene) {
    const Outcome forth = outcome_of(scene);
    EXPECT_GT(forth.impacts, 10);
    Scenario reversed = scene;
    for (std::size_t i = 0; i < reversed.balls.size(); ++i) {
      reversed.balls[i].position = forth.states[i].position;
      reversed.balls[i].velocity = -forth.states[i].velocity;
      reversed.balls[i].spin = -forth.states[i].spin;
    }
    std::vector<BallState> start = states_of(scene);
    for (BallState& state : start) {
      state.velocity = -state.velocity;
      state.spin = -state.spin;
    }
    // The errors of the way forth grow on the way back.
    expect_same(scene, outcome_of(reversed).states, start, tolerance_of(scene) + tolerance_of(reversed));
  });
}

TEST_P(Symmetry, SameBitsTwice) {
  for_each_gas(all_kinds(), [](const Scenario& scene) {
    expect_same(scene, outcome_of(scene).states, outcome_of(scene).states, 0.0);
  });
}

/// Where flights are exact the step is none of the errors of `toi`, and `event` has none at all.
TEST_P(SymmetryInTime, StepDoesNotMatterBeyondRounding) {
  for_each_gas({smooth_kind(), falling_kind(), rough_kind()}, [](const Scenario& scene) {
    expect_same(scene, outcome_of(scene, 3).states, outcome_of(scene).states, tolerance_of(scene));
  });
}

/// Of the evolvers that take any broad phase.
class SymmetryOfBroadPhases : public Symmetry {};

TEST_P(SymmetryOfBroadPhases, NoneChangesABit) {
  for_each_gas(all_kinds(), [](const Scenario& scene) {
    const Outcome expected = outcome_of(scene);
    for (const std::string_view name : broad_phase_names(scene.dimension)) {
      SCOPED_TRACE(name);
      const Outcome got = outcome_of(scene, kSteps, std::string(name));
      EXPECT_EQ(got.impacts, expected.impacts);
      expect_same(scene, got.states, expected.states, 0.0);
    }
  });
}

std::string name_of(const testing::TestParamInfo<std::tuple<std::string, int>>& info) {
  return std::get<0>(info.param) + std::to_string(std::get<1>(info.param)) + "D";
}

const auto kDimensions = testing::Values(2, 3);

INSTANTIATE_TEST_SUITE_P(Evolvers, Symmetry,
                         testing::Combine(testing::Values("toi", "event", "step"), kDimensions), name_of);
INSTANTIATE_TEST_SUITE_P(Evolvers, SymmetryInTime,
                         testing::Combine(testing::Values("toi", "event"), kDimensions), name_of);
INSTANTIATE_TEST_SUITE_P(Evolvers, SymmetryOfBroadPhases,
                         testing::Combine(testing::Values("toi", "step"), kDimensions), name_of);

}  // namespace
}  // namespace carom::test
