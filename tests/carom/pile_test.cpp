// Piles that form.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "carom/broad_phase/list.h"
#include "carom/compose.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

/// Balls poured from a lattice into a box, e = 0.5.
ScenarioPtr pour(int dimension, int count, double friction) {
  const bool plane = dimension == 2;
  return scene_of(fmt::format(R"(
title = "pour"
dimension = {}
duration = 1.5
step = 0.005
frames = 10
[effects]
gravity = [{}]
spin = {}
[contact]
restitution = 0.5
friction = {}
[box]
min = [{}]
max = [{}]
[[balls]]
kind = "lattice"
count = {}
seed = 3
radius = [0.09, 0.11]
mass = 1.0
gap = 0.02
speed = 0.3
)",
                              dimension, plane ? "0, -9.81" : "0, -9.81, 0", friction > 0.0, friction,
                              plane ? "0, 0" : "0, 0, 0", plane ? "1.25, 3" : "0.75, 3, 0.75", count));
}

double energy_of(const Scenario& scene, const std::vector<BallState>& states) {
  double sum = kinetic_energy_of(scene, states);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Ball& ball = scene.balls[i];
    sum += 9.81 * ball.mass * states[i].position.y();
    sum += 0.5 * ball.inertia * ball.mass * ball.radius * ball.radius * states[i].spin.squaredNorm();
  }
  return sum;
}

double overlap_of(const Scenario& scene, const std::vector<BallState>& states) {
  double most = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    for (const Wall& wall : scene.walls) {
      most = std::max(most, scene.balls[i].radius + wall.offset - wall.normal.dot(states[i].position));
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = (states[i].position - states[j].position).norm();
      most = std::max(most, scene.balls[i].radius + scene.balls[j].radius - distance);
    }
  }
  return most;
}

struct PileCase {
  int dimension;
  double friction;
};

class FormingPile : public testing::TestWithParam<PileCase> {};

TEST_P(FormingPile, GainsNoEnergyInAnyStep_AndOverlapsByNoMoreThanStated) {
  const ScenarioPtr scene = pour(GetParam().dimension, 24, GetParam().friction);
  const auto simulation = compose(*scene, {"toi", ""});
  double last = energy_of(*scene, states_of(*scene));
  const double scale = last;
  for (int k = 0; k < 300 / kPart; ++k) {
    simulation->advance(scene->step_s, 1);
    const auto states = states_of(*simulation, scene->balls.size());
    // A rebound that is left out leaves a ball up to kRestShare² g h²/8 = 3e-11 m too high, of 1 m.
    ASSERT_LE(energy_of(*scene, states), last + 1e-9 * scale) << "step " << k;
    last = energy_of(*scene, states);
    // Each step leaves 1e-10 of g h² in a contact that bears: 300 × 2.5e-14 m.
    ASSERT_LE(overlap_of(*scene, states), 1e-11) << "step " << k;
  }
}

TEST_P(FormingPile, IsTheSameBits_WithEveryBroadPhase) {
  const ScenarioPtr scene = pour(GetParam().dimension, 24, GetParam().friction);
  const auto first = run(*compose(*scene, {"toi", "brute-force"}), *scene, 200 / kPart);
  for (const std::string_view broad_phase : broad_phase_names(GetParam().dimension)) {
    const auto again = run(*compose(*scene, {"toi", std::string(broad_phase)}), *scene, 200 / kPart);
    for (std::size_t i = 0; i < first.size(); ++i) {
      ASSERT_EQ(first[i].position, again[i].position) << broad_phase << ", ball " << i;
      ASSERT_EQ(first[i].velocity, again[i].velocity) << broad_phase << ", ball " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Piles, FormingPile,
                         testing::Values(PileCase{2, 0.0}, PileCase{2, 0.3}, PileCase{3, 0.0},
                                         PileCase{3, 0.3}),
                         [](const auto& info) {
                           return fmt::format("{}D{}", info.param.dimension,
                                              info.param.friction > 0.0 ? "Rough" : "Smooth");
                         });

}  // namespace
}  // namespace carom::test
