#include "tests/benchmarks/gas.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "scenario/parse.h"
#include "tests/benchmarks/live_bytes.h"

namespace carom::benchmark {

namespace {

/// Share of the box that the balls fill.
constexpr double kPacking = 0.1;
constexpr double kRadius_m = 0.1;

/// The side of the cube in which balls of kRadius_m have kPacking, m.
double side_of(std::size_t balls) {
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(kRadius_m, 3);
  return std::cbrt(static_cast<double>(balls) * volume / kPacking);
}

/// A ball flies a twentieth of its radius in a step and meets another in about fifty. The effects change its
/// velocity by a few percent in a hundred steps: they do their work, and hardly change the impacts.
std::string toml_of(std::size_t balls) {
  const double side = side_of(balls);
  return fmt::format(R"(
title = "A gas with everything"
about = "What every scene can name"
dimension = 3
duration = 1.0
step = 0.005
frames = 1

[effects]
gravity = [0, -0.1, 0]
drag = {{ quadratic = 0.05 }}
spin = true
magnus = 0.01

[contact]
restitution = 1.0
friction = 0.1

[box]
min = [0, 0, 0]
max = [{0}, {0}, {0}]

[[slab]]
normal = [1, 0, 0]
offset = {1}
thickness = 0.05

[[barrier]]
normal = [1, 0, 0]
offset = {2}
thickness = 0.05
height = 0.5
hbar = 0.05
seed = 1

[[balls]]
kind = "gas"
count = {3}
seed = 1
packing = {4}
mass = 1.0
speed = 1.0
)",
                     side, side / 3.0, 2.0 * side / 3.0, balls, kPacking);
}

/// What callgrind is told to count: the name stands in tests/benchmarks/run.
[[gnu::noinline]] void count_here(Simulation& simulation, double step_s, std::int64_t steps) {
  simulation.advance(step_s, steps);
}

}  // namespace

Scenario full_gas(std::size_t balls) {
  Scenario scene = *parse_scene(toml_of(balls), "gas");
  // As fast at the surface as in flight, about another axis.
  for (Ball& ball : scene.balls) {
    ball.spin = Vec3(ball.velocity.y(), ball.velocity.z(), ball.velocity.x()) / ball.radius;
  }
  return scene;
}

Scenario bare_gas(std::size_t balls) {
  Scenario scene = full_gas(balls);
  scene.effects = {};
  scene.ball_contact = scene.wall_contact = {};
  scene.box.reset();
  scene.walls.clear();
  scene.slabs.clear();
  scene.barriers.clear();
  return scene;
}

std::string measure(Simulation& simulation, const Scenario& scene, const std::string& name,
                    const std::string& evolver, std::int64_t steps, std::int64_t heap_before) {
  const std::int64_t bytes = live_bytes() - heap_before;
  simulation.advance(scene.step_s, 1);  // takes the memory that all later steps use again
  const std::int64_t bytes_in_use = live_bytes() - heap_before;
  const std::int64_t impacts_before = simulation.tally().impacts;
  count_here(simulation, scene.step_s, steps);
  return nlohmann::ordered_json{{"scene", name},
                                {"evolver", evolver},
                                {"balls", scene.balls.size()},
                                {"steps", steps},
                                {"impacts", simulation.tally().impacts - impacts_before},
                                {"bytes", bytes},
                                {"bytes_in_use", bytes_in_use}}
      .dump();
}

}  // namespace carom::benchmark
