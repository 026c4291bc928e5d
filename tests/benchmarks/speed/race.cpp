#include "tests/benchmarks/speed/race.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <map>
#include <utility>

#include "app/layout.h"
#include "carom/carom_engine.h"
#include "core/error.h"
#include "engine/modules.h"

namespace carom::benchmark {

namespace {

constexpr double kStep_s = 1.0 / 240.0;
/// What an engine sets up in its first steps, and what a lattice of balls is like before they have met, is
/// not timed.
constexpr std::int64_t kStepsBefore = 3;
/// As in a comparison of 1000 steps at 100 frames.
constexpr std::int64_t kStepsInAFrame = 10;
constexpr double kNanosecondsPerSecond = 1e9;

bool is_own(const std::string& engine) {
  return engine.starts_with("carom");
}

std::unique_ptr<Simulation> set_up(const Runner& runner) {
  // Made here and kept: a simulation may go on using its engine.
  static std::map<std::pair<std::string, std::size_t>, std::unique_ptr<Engine>> own;
  if (is_own(runner.engine)) {
    std::unique_ptr<Engine>& engine = own[{runner.engine, runner.threads}];
    if (!engine) engine = make_carom_engine(runner.engine, runner.threads);
    return engine->create(*runner.scene, "faithful");
  }
  return open_engine_module(engine_folder() / (runner.engine + ".so")).create(*runner.scene, "faithful");
}

/// Of balls with each other.
std::int64_t ball_impacts(const Simulation& simulation) {
  const Tally tally = simulation.tally();
  return tally.impacts - tally.wall_impacts;
}

/// Takes what Google Benchmark measured, by the name of the benchmark, which is the number of its runner. One
/// that it repeats to find out how long to measure is told once, at the end.
class Taker final : public ::benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& /*context*/) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const double count = run.counters.at("count");
      const bool real = run.run_name.time_type == "real_time";
      const double taken_s = real ? run.real_accumulated_time : run.cpu_accumulated_time;
      costs[run.run_name.function_name].values.push_back(kNanosecondsPerSecond * taken_s / count);
    }
  }

  std::map<std::string, Samples> costs;
};

/// The body of a benchmark.
void advance(::benchmark::State& state, const Runner& runner, Simulation& simulation) {
  const std::int64_t impacts_before = ball_impacts(simulation);
  for (auto _ : state) simulation.advance(kStep_s, kStepsInAFrame);
  const auto steps = static_cast<double>(state.iterations() * kStepsInAFrame);
  state.counters["count"] = runner.unit == Unit::ball_step
                                ? steps * static_cast<double>(runner.scene->balls.size())
                                : static_cast<double>(ball_impacts(simulation) - impacts_before);
}

}  // namespace

std::vector<Cost> race(const std::vector<Runner>& runners, int rounds, double shortest_s) {
  Taker taker;
  std::vector<std::unique_ptr<Simulation>> simulations;
  ::benchmark::ClearRegisteredBenchmarks();
  for (const Runner& runner : runners) {
    const std::string number = fmt::format("{}", simulations.size());
    simulations.push_back(set_up(runner));
    Simulation& simulation = *simulations.back();
    simulation.advance(kStep_s, kStepsBefore);
    auto* timed = ::benchmark::RegisterBenchmark(
        number.c_str(),
        [&runner, &simulation](::benchmark::State& state) { advance(state, runner, simulation); });
    timed->MinTime(shortest_s * runner.longer);
    if (runner.real_time) timed->UseRealTime();
  }
  for (int round = 0; round < rounds; ++round) ::benchmark::RunSpecifiedBenchmarks(&taker, "all");
  std::vector<Cost> costs;
  costs.reserve(runners.size());
  for (const Runner& runner : runners) {
    const std::string number = fmt::format("{}", costs.size());
    costs.push_back({runner.engine, runner.scene->balls.size(), taker.costs.at(number)});
  }
  return costs;
}

}  // namespace carom::benchmark
