// What a pile costs while it forms: balls poured from a lattice into a box, e = 0.5.
//
//   carom-pour DIMENSION BALLS FRICTION STEPS [BROAD_PHASE]
//
// advances `toi` by so many steps of 1/240 s and prints a row of JSON: processor time, energies and overlaps.
// Under callgrind it counts what is spent where.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "carom/compose.h"
#include "scenario/parse.h"

namespace carom::benchmark {
namespace {

constexpr double kStep_s = 1.0 / 240.0;

/// Balls of 9 to 11 cm, a centimetre apart, above a floor as wide as the pile becomes high.
ScenarioPtr pour(int dimension, std::size_t balls, double friction) {
  const double across = std::ceil(std::pow(static_cast<double>(balls), 1.0 / dimension));
  const double width = 0.24 * across + 0.01;
  const std::string plane = dimension == 2 ? fmt::format("{}", width) : fmt::format("{0}, {0}", width);
  const char* zeros = dimension == 2 ? "0, 0" : "0, 0, 0";
  const char* gravity = dimension == 2 ? "0, -9.81" : "0, 0, -9.81";
  return parse_scene(fmt::format(R"(
title = "A pile forms"
dimension = {0}
duration = 5.0
step = {1}
frames = 1
[effects]
gravity = [{2}]
spin = {3}
[contact]
restitution = 0.5
friction = {4}
[box]
min = [{5}]
max = [{6}, {7}]
[[balls]]
kind = "lattice"
count = {8}
seed = 1
radius = [0.09, 0.11]
density = 1000.0
gap = 0.02
speed = 0.3
)",
                                 dimension, kStep_s, gravity, friction > 0.0, friction, zeros, plane,
                                 0.24 * across + 1.0, balls),
                     "pour");
}

struct State {
  double energy_J = 0.0;
  double kinetic_J = 0.0;
  double overlap = 0.0;  ///< the largest, by the smaller radius
};

State state_of(const Scenario& scene, const Simulation& simulation) {
  std::vector<BallState> states(scene.balls.size());
  simulation.snapshot(states);
  State state;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Ball& ball = scene.balls[i];
    const double turning = 0.5 * ball.inertia * ball.mass * ball.radius * ball.radius;
    state.kinetic_J +=
        0.5 * ball.mass * states[i].velocity.squaredNorm() + turning * states[i].spin.squaredNorm();
    state.energy_J -= ball.mass * scene.effects.gravity->dot(states[i].position);
    for (const Wall& wall : scene.walls) {
      const double overlap = ball.radius + wall.offset - wall.normal.dot(states[i].position);
      state.overlap = std::max(state.overlap, overlap / ball.radius);
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double overlap =
          ball.radius + scene.balls[j].radius - (states[i].position - states[j].position).norm();
      state.overlap = std::max(state.overlap, overlap / std::min(ball.radius, scene.balls[j].radius));
    }
  }
  state.energy_J += state.kinetic_J;
  return state;
}

void measure(int dimension, std::size_t balls, double friction, int steps, const std::string& broad_phase) {
  const ScenarioPtr scene = pour(dimension, balls, friction);
  const auto simulation = compose(*scene, {"toi", broad_phase});
  double last_J = state_of(*scene, *simulation).energy_J;
  double gained_J = 0.0;
  double overlap = 0.0;
  double spent_ms = 0.0;
  double longest_ms = 0.0;
  for (int k = 0; k < steps; ++k) {
    const std::clock_t begun = std::clock();
    simulation->advance(kStep_s, 1);
    const double step_ms = 1e3 * static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
    spent_ms += step_ms;
    longest_ms = std::max(longest_ms, step_ms);
    const State now = state_of(*scene, *simulation);
    gained_J = std::max(gained_J, now.energy_J - last_J);
    last_J = now.energy_J;
    overlap = std::max(overlap, now.overlap);
  }
  const State last = state_of(*scene, *simulation);
  fmt::print("{}\n", nlohmann::ordered_json{{"dimension", dimension},
                                            {"balls", balls},
                                            {"friction", friction},
                                            {"steps", steps},
                                            {"mean_ms", spent_ms / steps},
                                            {"longest_ms", longest_ms},
                                            {"impacts", simulation->tally().impacts},
                                            {"energy_J", last.energy_J},
                                            {"kinetic_J", last.kinetic_J},
                                            {"most_gained_in_a_step", gained_J / last.energy_J},
                                            {"overlap", overlap}}
                         .dump());
}

}  // namespace
}  // namespace carom::benchmark

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 4) return 2;
  carom::benchmark::measure(std::stoi(words[0]), std::stoul(words[1]), std::stod(words[2]),
                            std::stoi(words[3]), words.size() > 4 ? words[4] : "");
}
