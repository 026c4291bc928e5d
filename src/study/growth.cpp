#include "study/growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "comparison/statistics/gas.h"
#include "scenario/parse.h"
#include "study/budget.h"
#include "study/timing.h"

namespace carom {

namespace {

constexpr std::int64_t kGrowthSteps = 20;
constexpr double kGrowthStep_s = 0.1;
/// Ten times the balls are taken to be ten times the work and a bit: a logarithm of cells and queues.
constexpr double kForeseenPower = 1.1;

/// What a process that was to time a scene says instead where the engine does not run it.
constexpr std::string_view kUnsupported = "unsupported: ";

std::string time_or_refuse(const Scenario& scene, const EngineChoice& choice) {
  const std::string reason = unsupported_reason(choice.source.open(), scene, choice.profile);
  return reason.empty() ? timing_text(time_run(scene, choice)) : std::string(kUnsupported) + reason;
}

void take(const ProcessOutcome& outcome, GrowthPoint& point) {
  if (outcome.end != ProcessEnd::finished) {
    point.status = outcome.end == ProcessEnd::timed_out ? RunStatus::timeout : RunStatus::crashed;
    point.reason = outcome.reason;
  } else if (outcome.payload.starts_with(kUnsupported)) {
    point.status = RunStatus::unsupported;
    point.reason = outcome.payload.substr(kUnsupported.size());
  } else {
    const Timing timing = timing_from(outcome.payload);
    point.status = RunStatus::ok;
    point.impacts = timing.impacts;
    point.cpu_s.push_back(timing.cpu_s);
  }
}

/// Whether the number of balls before this one foretells a run longer than the limit, or none.
bool is_foreseen_too_long(const GrowthPoint* before, double limit_s, GrowthPoint& point) {
  if (before == nullptr || before->status == RunStatus::ok) {
    if (before == nullptr || before->cpu_s.empty()) return false;
    const double more = static_cast<double>(point.balls) / static_cast<double>(before->balls);
    const double foreseen_s =
        *std::min_element(before->cpu_s.begin(), before->cpu_s.end()) * std::pow(more, kForeseenPower);
    if (foreseen_s <= limit_s) return false;
    point.reason = fmt::format("foreseen to take {:.2g} s, longer than {:g} s", foreseen_s, limit_s);
  } else {
    point.reason = "fewer balls did not end well already";
  }
  point.status = before->status == RunStatus::unsupported ? RunStatus::unsupported : RunStatus::timeout;
  if (before->status == RunStatus::unsupported) point.reason = before->reason;
  return true;
}

StudyGrowth& growth_in(std::vector<StudyGrowth>& all, const GasKind& kind, const std::string& engine) {
  for (StudyGrowth& growth : all) {
    if (is_of(growth, kind) && growth.engine == engine) return growth;
  }
  StudyGrowth& growth = all.emplace_back();
  growth.dimension = kind.dimension;
  growth.packing = kind.packing;
  growth.engine = engine;
  for (const std::int64_t balls : growth_balls()) {
    GrowthPoint& point = growth.points.emplace_back();
    point.balls = balls;
    point.steps = kGrowthSteps;
  }
  return growth;
}

}  // namespace

std::vector<std::int64_t> growth_balls() {
  return {10, 100, 1000, 10'000, 100'000};
}

ScenarioPtr gas_to_grow(int dimension, double packing, std::int64_t balls) {
  const double ball = dimension == 2 ? std::numbers::pi : 4.0 / 3.0 * std::numbers::pi;
  const double side = std::pow(ball * static_cast<double>(balls) / packing, 1.0 / dimension);
  const std::string low = dimension == 2 ? "[0, 0]" : "[0, 0, 0]";
  const std::string high =
      dimension == 2 ? fmt::format("[{0}, {0}]", side) : fmt::format("[{0}, {0}, {0}]", side);
  const std::string text = fmt::format(
      "title = \"A gas of {0} balls\"\ndimension = {1}\nduration = {2}\nstep = {3}\nframes = 1\n"
      "[box]\nmin = {4}\nmax = {5}\n"
      "[[balls]]\nkind = \"gas\"\ncount = {0}\nseed = 1\nradius = 1.0\nspeed = 1.0\n"
      "[truth]\nkind = \"none\"\n",
      balls, dimension, kGrowthStep_s * static_cast<double>(kGrowthSteps), kGrowthStep_s, low, high);
  return parse_scene(text, fmt::format("a gas of {} balls", balls));
}

std::vector<GasKind> gas_kinds(const std::vector<ScenarioPtr>& scenes) {
  std::vector<GasKind> kinds;
  for (const ScenarioPtr& scene : scenes) {
    const std::optional<Gas> gas = gas_of(*scene);
    if (!gas || !scene->effects.collisions) continue;
    const bool known = std::any_of(kinds.begin(), kinds.end(),
                                   [&](const GasKind& kind) { return kind.dimension == scene->dimension; });
    if (!known) kinds.push_back({scene->dimension, gas->packing});
  }
  return kinds;
}

void measure_growth(const GasKind& kind, const std::vector<EngineChoice>& engines, const StudyLimits& limits,
                    const StudyWatch& watch, std::vector<StudyGrowth>& into) {
  // The time of what runs before and after the stepping, placing the balls above all, is not that of the run.
  const ProcessLimits process{ProcessLimits().wall_seconds, limits.memory_mib};
  const std::vector<std::int64_t> counts = growth_balls();
  watch.more(counts.size() * engines.size() * kGrowthRepeats);
  const CpuBudget budget(limits.budget_s);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    ScenarioPtr scene;
    for (int round = 0; round < kGrowthRepeats; ++round) {
      for (const EngineChoice& engine : engines) {
        StudyGrowth& growth = growth_in(into, kind, engine_label(engine.source.name, engine.profile));
        GrowthPoint& point = growth.points[k];
        watch.done(fmt::format("{} balls in {}", point.balls, growth.engine));
        if (point.status && point.status != RunStatus::ok) continue;
        if (static_cast<int>(point.cpu_s.size()) > round) continue;
        const GrowthPoint* before = k > 0 ? &growth.points[k - 1] : nullptr;
        if (is_foreseen_too_long(before, limits.timeout_s, point)) continue;
        if (watch.stopped()) return;
        if (budget.left_s() <= 0.0) {
          if (point.status) continue;  // fewer runs than the others
          point.status = RunStatus::timeout;
          point.reason = fmt::format("the budget of {:g} s for a kind of gas was used up", limits.budget_s);
          continue;
        }
        if (!scene) scene = gas_to_grow(kind.dimension, kind.packing, point.balls);
        take(run_isolated({[&] { return time_or_refuse(*scene, engine); }}, process, 1).front(), point);
        watch.changed();
      }
    }
  }
}

}  // namespace carom
