// What a collision costs in the event-driven evolver, beside a ball's step in Bullet in the same run:
//
//   carom-event --benchmark_enable_random_interleaving=true --benchmark_repetitions=9
//
// Rows are event/nσ³/BALLS and bullet-f64/nσ³/BALLS, hard spheres in a box; 0.2 stands for the gas of packing
// 0.1, in which the evolvers of fixed steps are raced. `ns` is nanoseconds of CPU per collision, or per ball
// and step; `per_s` collisions per second; `bytes` what the simulation holds per ball. Only ratios of one run
// carry over to other machines.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "carom/compose.h"
#include "engine/modules.h"
#include "scenario/parse.h"
#include "tests/benchmarks/live_bytes.h"

namespace carom::benchmark {
namespace {

using ::benchmark::Counter;

constexpr double kThinDensity = 0.6 / std::numbers::pi;  ///< nσ³ of packing 0.1
constexpr double kBulletStep_s = 1.0 / 240.0;

/// Balls of diameter 1 m in a cube, with the root mean square speed 1 m/s. Where they stand too close to be
/// put at random they start on the lattice of the densest packing, and melt.
const Scenario& hard_spheres(double density, std::size_t balls) {
  constexpr double kMostAtRandom = 0.8;
  static std::map<std::pair<double, std::size_t>, ScenarioPtr> scenes;
  ScenarioPtr& scene = scenes[{density, balls}];
  if (!scene) {
    const double side = std::cbrt(static_cast<double>(balls) / density);
    scene = parse_scene(
        fmt::format(
            "title = \"gas\"\ndimension = 3\nduration = 1.0\nstep = {0}\nframes = 1\n[box]\n"
            "min = [0, 0, 0]\nmax = [{1}, {1}, {1}]\n[[balls]]\n{2}\ncount = {3}\nseed = 1\n"
            "radius = 0.5\nmass = 1.0\nspeed = 1.0\n",
            kBulletStep_s, side,
            density < kMostAtRandom ? "kind = \"gas\"" : "kind = \"lattice\"\narrangement = \"close\"",
            balls),
        "gas");
  }
  return *scene;
}

/// The time between two collisions of a ball, s: 1/Γ of Enskog's with the contact value of Carnahan and
/// Starling.
double time_between(double density) {
  const double eta = density * std::numbers::pi / 6.0;
  const double contact = (1.0 - 0.5 * eta) / std::pow(1.0 - eta, 3);
  return 1.0 / (4.0 * density * contact * std::sqrt(std::numbers::pi / 3.0));
}

void run_event(::benchmark::State& state, double density, std::size_t balls) {
  // Collisions of a ball: until the run counts, so that speeds are mixed, and in one piece of the run.
  constexpr std::int64_t kBefore = 8;
  const auto in_a_piece = std::max<std::int64_t>(2, 200'000 / static_cast<std::int64_t>(balls));
  const Scenario& scene = hard_spheres(density, balls);
  const std::int64_t heap_before = live_bytes();
  const std::unique_ptr<Simulation> simulation = compose(scene, {"event", {}});
  const double wait_s = time_between(density);
  simulation->advance(wait_s, kBefore);
  const std::int64_t impacts_before = simulation->tally().impacts;
  for (auto _ : state) simulation->advance(wait_s, in_a_piece);
  const auto impacts = static_cast<double>(simulation->tally().impacts - impacts_before);
  state.counters["ns"] = Counter(impacts * 1e-9, Counter::kIsRate | Counter::kInvert);
  state.counters["per_s"] = Counter(impacts, Counter::kIsRate);
  state.counters["bytes"] = static_cast<double>(live_bytes() - heap_before) / static_cast<double>(balls);
}

void run_bullet(::benchmark::State& state, double density, std::size_t balls) {
  const auto steps = std::max<std::int64_t>(5, 200'000 / static_cast<std::int64_t>(balls));
  const Engine& bullet = open_engine_module(CAROM_BULLET_MODULE);
  const std::unique_ptr<Simulation> simulation = bullet.create(hard_spheres(density, balls), "faithful");
  simulation->advance(kBulletStep_s, 20);  // finds the pairs, and takes the memory
  for (auto _ : state) simulation->advance(kBulletStep_s, steps);
  const double work = static_cast<double>(balls) * static_cast<double>(steps);
  state.counters["ns"] = Counter(work * 1e-9, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void add_all() {
  for (const std::size_t balls : {1'000U, 10'000U, 100'000U, 1'000'000U}) {
    for (const double density : {0.5, 0.9}) {
      const auto name = fmt::format("event/{}/{}", density, balls);
      ::benchmark::RegisterBenchmark(name.c_str(),
                                     [=](::benchmark::State& state) { run_event(state, density, balls); });
    }
    // No goal speaks of a million of them.
    if (balls > 100'000) continue;
    for (const double density : {kThinDensity, 0.5}) {
      ::benchmark::RegisterBenchmark(fmt::format("bullet-f64/{:.1}/{}", density, balls).c_str(),
                                     [=](::benchmark::State& state) { run_bullet(state, density, balls); });
    }
  }
}

}  // namespace
}  // namespace carom::benchmark

int main(int argc, char** argv) {
  carom::benchmark::add_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
