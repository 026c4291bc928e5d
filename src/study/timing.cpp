#include "study/timing.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "trajectory/cpu_time.h"
#include "trajectory/staged_run.h"

namespace carom {

namespace {

constexpr int kMostRuns = 1000;

/// Some frames at a time are enough to look at the clock between them.
void warm_up(const Scenario& scene, const EngineChoice& choice) {
  const std::unique_ptr<Simulation> simulation = create_simulation(choice.source.open(), scene, choice);
  const std::int64_t steps = steps_per_frame(scene);
  const double step_s = scene.duration_s / static_cast<double>(scene.frames) / static_cast<double>(steps);
  const double start_s = cpu_now();
  for (std::int64_t frame = 0; frame < scene.frames && cpu_now() - start_s < kWarm_s; ++frame) {
    simulation->advance(step_s, steps);
  }
}

/// A run with events, which starts anew after each: that is a part of what it takes. @return s
double time_stages(const Scenario& scene, const EngineChoice& choice, std::int64_t& impacts) {
  StagedRun run(
      scene, [&](const Scenario& stage) { return create_simulation(choice.source.open(), stage, choice); });
  const double before_s = cpu_now();
  for (std::int64_t frame = 0; frame < scene.frames; ++frame) run.to_next_frame();
  const double taken_s = cpu_now() - before_s;
  impacts = run.tally().impacts;
  return taken_s;
}

}  // namespace

Timing time_run(const Scenario& scene, const EngineChoice& choice) {
  warm_up(scene, choice);
  const Engine& engine = choice.source.open();
  const std::int64_t steps = steps_per_frame(scene);
  const double step_s = scene.duration_s / static_cast<double>(scene.frames) / static_cast<double>(steps);
  Timing timing;
  double total_s = 0.0;
  int runs = 0;
  while (runs == 0 || (total_s < kLeast_s && runs < kMostRuns)) {
    if (!scene.events.empty()) {
      total_s += time_stages(scene, choice, timing.impacts);
    } else {
      const std::unique_ptr<Simulation> simulation = create_simulation(engine, scene, choice);
      const double before_s = cpu_now();
      simulation->advance(step_s, steps * scene.frames);
      total_s += cpu_now() - before_s;
      timing.impacts = simulation->tally().impacts;
    }
    ++runs;
  }
  timing.cpu_s = total_s / runs;
  return timing;
}

ProcessOutcome time_isolated(const Scenario& scene, const EngineChoice& choice, const ProcessLimits& limits) {
  return run_isolated({[&] { return timing_text(time_run(scene, choice)); }}, limits, 1).front();
}

std::string timing_text(const Timing& timing) {
  return nlohmann::json{timing.cpu_s, timing.impacts}.dump();
}

Timing timing_from(const std::string& payload) {
  const auto json = nlohmann::json::parse(payload);
  return {json.at(0), json.at(1)};
}

}  // namespace carom
