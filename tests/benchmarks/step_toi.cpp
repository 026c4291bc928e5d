// What a ball and a step cost in the evolvers of fixed steps, beside a plain program in the same run:
//
//   carom-step-toi --benchmark_enable_random_interleaving=true --benchmark_repetitions=9
//
// Rows are EVOLVER/DIMENSION/KIND/BALLS; `ns` is nanoseconds per ball and step, `bytes` what the simulation
// holds per ball. Rows that end in N-threads are for the gain by threads, and their `ns` are of real time:
// the machine must have as many cores to spare. Only ratios of one run carry over to other machines.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "carom/compose.h"
#include "scenario/parse.h"
#include "tests/benchmarks/live_bytes.h"
#include "tests/benchmarks/plain_gas.h"

namespace carom::benchmark {
namespace {

constexpr double kStep_s = 1.0 / 240.0;
constexpr double kRadius_m = 0.5;
constexpr double kPacking = 0.1;

/// Steps in which simulations take their memory, and bring the balls into their order.
constexpr std::int64_t kFirstSteps = 20;
constexpr std::int64_t kStepsInCorner = 40;

/// How the balls lie: equal ones all over the box; sizes mixed 1:20; equal ones, four times as dense, all in
/// one corner of a box that is four times as wide.
enum class Kind { equal, mixed, corner };

std::string name_of(Kind kind) {
  if (kind == Kind::equal) return "equal";
  return kind == Kind::mixed ? "mixed" : "corner";
}

double side_of(int dimension, Kind kind, std::size_t balls) {
  const double r = kRadius_m;
  // Radii uniform in [r/10, 2 r]: their mean square is 1.4033 r², their mean cube 2.1053 r³.
  const double mixed = kind == Kind::mixed ? (dimension == 2 ? 1.4033 : 2.1053) : 1.0;
  const double volume =
      (dimension == 2 ? std::numbers::pi * r * r : 4.0 / 3.0 * std::numbers::pi * r * r * r);
  const double packing = kind == Kind::corner ? 4.0 * kPacking : kPacking;
  return std::pow(static_cast<double>(balls) * mixed * volume / packing, 1.0 / dimension);
}

const Scenario& gas(int dimension, Kind kind, std::size_t balls) {
  static std::map<std::tuple<int, Kind, std::size_t>, ScenarioPtr> scenes;
  ScenarioPtr& scene = scenes[{dimension, kind, balls}];
  if (scene) return *scene;
  const double side = side_of(dimension, kind, balls);
  const std::string low = dimension == 2 ? "0, 0" : "0, 0, 0";
  const std::string high =
      dimension == 2 ? fmt::format("{0}, {0}", side) : fmt::format("{0}, {0}, {0}", side);
  scene = parse_scene(
      fmt::format(
          "title = \"gas\"\ndimension = {}\nduration = 1.0\nstep = {}\nframes = 1\n[box]\nmin = [{}]\n"
          "max = [{}]\n[[balls]]\nkind = \"{}\"\ncount = {}\nseed = 1\n{}mass = 1.0\nspeed = 1.0\n",
          dimension, kStep_s, low, high, kind == Kind::corner ? "lattice" : "gas", balls,
          kind == Kind::mixed
              ? fmt::format("radius = [{}, {}]\npacking = {}\n", 0.1 * kRadius_m, 2.0 * kRadius_m, kPacking)
              : fmt::format("radius = {}\n", kRadius_m)),
      "gas");
  if (kind == Kind::corner) {
    auto wide = std::make_shared<Scenario>(*scene);
    for (std::size_t wall = 1; wall < wide->walls.size(); wall += 2) wide->walls[wall].offset *= 4.0;
    wide->box->max *= 4.0;
    scene = wide;
  }
  return *scene;
}

/// Nanoseconds per ball and step.
void report(::benchmark::State& state, std::size_t balls, std::int64_t steps) {
  using ::benchmark::Counter;
  const double work = static_cast<double>(balls) * static_cast<double>(steps);
  state.counters["ns"] = Counter(work * 1e-9, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

/// As many steps at once as serve many lists of pairs.
std::int64_t steps_for(std::size_t balls) {
  return std::max<std::int64_t>(60, 20'000'000 / static_cast<std::int64_t>(balls));
}

void run_evolver(::benchmark::State& state, const std::string& evolver, int dimension, Kind kind,
                 std::size_t balls, std::size_t threads = 1) {
  const Scenario& scene = gas(dimension, kind, balls);
  const Variant variant{evolver, {}, Listed::kNear, threads};
  const std::int64_t heap_before = live_bytes();
  std::unique_ptr<Simulation> simulation = compose(scene, variant);
  simulation->advance(kStep_s, kFirstSteps);
  // Balls do not stay in a corner: these begin anew, so that for any number of them it is as full.
  const std::int64_t steps = kind == Kind::corner ? kStepsInCorner : steps_for(balls);
  for (auto _ : state) {
    simulation->advance(kStep_s, steps);
    if (kind != Kind::corner) continue;
    state.PauseTiming();
    simulation = compose(scene, variant);
    simulation->advance(kStep_s, kFirstSteps);
    state.ResumeTiming();
  }
  report(state, balls, steps);
  state.counters["bytes"] = static_cast<double>(live_bytes() - heap_before) / static_cast<double>(balls);
}

template <int Dim>
void run_plain(::benchmark::State& state, std::size_t balls) {
  PlainGas<Dim> plain(gas(Dim, Kind::equal, balls));
  plain.advance(kStep_s, kFirstSteps);
  const std::int64_t steps = steps_for(balls);
  for (auto _ : state) plain.advance(kStep_s, steps);
  report(state, balls, steps);
}

void add_threads() {
  for (const std::size_t balls : {10'000U, 100'000U, 1'000'000U}) {
    for (const char* evolver : {"step", "toi"}) {
      for (const std::size_t threads : {1U, 2U}) {
        const auto name = fmt::format("{}/3d/equal/{}/{}-threads", evolver, balls, threads);
        ::benchmark::RegisterBenchmark(name.c_str(), [=](::benchmark::State& state) {
          run_evolver(state, evolver, 3, Kind::equal, balls, threads);
        })->UseRealTime();
      }
    }
  }
}

void add_all() {
  for (const int dimension : {2, 3}) {
    for (const std::size_t balls : {1'000U, 10'000U, 100'000U, 1'000'000U}) {
      const auto plain = fmt::format("plain/{}d/equal/{}", dimension, balls);
      ::benchmark::RegisterBenchmark(plain.c_str(), [=](::benchmark::State& state) {
        dimension == 2 ? run_plain<2>(state, balls) : run_plain<3>(state, balls);
      });
      for (const Kind kind : {Kind::equal, Kind::mixed, Kind::corner}) {
        for (const char* evolver : {"step", "toi"}) {
          const auto name = fmt::format("{}/{}d/{}/{}", evolver, dimension, name_of(kind), balls);
          ::benchmark::RegisterBenchmark(name.c_str(), [=](::benchmark::State& state) {
            run_evolver(state, evolver, dimension, kind, balls);
          });
        }
      }
    }
  }
}

}  // namespace
}  // namespace carom::benchmark

int main(int argc, char** argv) {
  carom::benchmark::add_all();
  carom::benchmark::add_threads();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
