#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "app/commands.h"
#include "app/laws.h"
#include "app/layout.h"
#include "app/prepare.h"
#include "app/progress.h"
#include "comparison/compare.h"
#include "comparison/explain.h"
#include "core/error.h"
#include "core/files.h"
#include "report/explanation.h"

namespace carom {

namespace {

/// As many runs as are under way at a time: each keeps its trajectory until it is measured.
constexpr std::size_t kTrialsAtOnce = 16;

/// The one scene of the command line.
ScenarioPtr scene_to_explain(const Options& options, const EngineCatalog& catalog) {
  const std::vector<ScenarioPtr> scenes = load_scenes(options, catalog);
  if (scenes.size() == 1) return scenes.front();
  throw InputError(
      fmt::format("explain takes one scene, found {}: {}", scenes.size(), fmt::join(options.scenes, " ")));
}

/// The profile that `profile` is held against; nothing where the engine does not have two.
std::optional<std::string> other_profile(const EngineInfo& info, const std::string& profile) {
  if (info.profiles.size() != 2) return std::nullopt;
  return info.profiles[info.profiles[0].name == profile ? 1 : 0].name;
}

/// What is to be explained: an engine in a profile, with what it says of itself.
struct Explained {
  EngineChoice engine;
  EngineInfo info;
};

/// The engine of the command line; or its law of impact, whose other profile is the right law.
Explained engine_to_explain(const Options& options, const EngineCatalog& catalog) {
  if (options.laws.empty() && options.engines.empty()) {
    throw InputError("explain takes --engine E or --law FILE, found neither");
  }
  if (options.laws.empty()) {
    const std::vector<Participant> named =
        participants(options, catalog, {options.timeout_s, options.memory_mib});
    return {choose_engines(named).front(), named.front().info};
  }
  std::vector<LawFile> laws = load_laws(options.laws);
  std::string asked = laws.front().id;
  if (asked != kRightLaw) laws.push_back(load_laws({std::string(kRightLaw)}).front());
  EngineSource source = law_source(std::move(laws));
  EngineInfo info = source.open().info();
  return {{std::move(source), std::move(asked)}, std::move(info)};
}

/// Runs one engine on one scene in whatever settings are asked for, and measures each run against the truth.
class Laboratory {
 public:
  Laboratory(ScenarioPtr scene, EngineChoice engine, const Options& options)
      : scene_(std::move(scene)),
        engine_(std::move(engine)),
        options_(options),
        limits_{options.timeout_s, options.memory_mib},
        truth_(record_truth(*scene_, truth_sources(), limits_)) {
    auto half = std::make_shared<Scenario>(*scene_);
    half->step_s *= 0.5;
    half_step_ = std::move(half);
  }

  const Truth& truth() const { return truth_; }

  RunComparison measured(const ScenarioPtr& scene, Run run) const {
    std::vector<Run> one;
    one.push_back(std::move(run));
    return std::move(compare(scene, truth_, std::move(one), {}).runs.front());
  }

  RunComparison run_profile(const std::string& profile) const {
    return measured(scene_, run_engines(*scene_, {{engine_.source, profile}}, limits_, 1).front());
  }

  /// The metric's value for each trial, in order.
  std::vector<std::optional<double>> run(const std::vector<Trial>& trials, Metric metric) const {
    std::vector<std::optional<double>> values(trials.size());
    Progress progress(trials.size(), options_.quiet);
    for (const bool half_step : {false, true}) {
      std::vector<std::size_t> which;
      for (std::size_t i = 0; i < trials.size(); ++i) {
        if (trials[i].half_step == half_step) which.push_back(i);
      }
      for (std::size_t from = 0; from < which.size(); from += kTrialsAtOnce) {
        const std::size_t to = std::min(which.size(), from + kTrialsAtOnce);
        run_some(trials,
                 {which.begin() + static_cast<std::ptrdiff_t>(from),
                  which.begin() + static_cast<std::ptrdiff_t>(to)},
                 half_step ? half_step_ : scene_, metric, values, progress);
      }
    }
    return values;
  }

 private:
  void run_some(const std::vector<Trial>& trials, const std::vector<std::size_t>& which,
                const ScenarioPtr& scene, Metric metric, std::vector<std::optional<double>>& values,
                Progress& progress) const {
    std::vector<EngineChoice> choices;
    choices.reserve(which.size());
    for (const std::size_t i : which) {
      choices.push_back({engine_.source, engine_.profile, trials[i].switched});
    }
    std::vector<Run> runs = run_engines(*scene, choices, limits_, options_.parallel, [&](std::size_t done) {
      progress.advance(fmt::format("{} {}", scene->id, fmt::join(choices[done].switched, " ")));
    });
    for (std::size_t k = 0; k < which.size(); ++k) {
      const RunComparison result = measured(scene, std::move(runs[k]));
      if (result.run.status == RunStatus::ok) values[which[k]] = result.metrics[metric];
    }
  }

  ScenarioPtr scene_;
  ScenarioPtr half_step_;
  EngineChoice engine_;
  const Options& options_;
  ProcessLimits limits_;
  Truth truth_;
};

/// The metric asked for, or the one that tells the most of this run.
Metric metric_to_explain(const Options& options, const RunComparison& run) {
  const auto named = std::find(kMetricNames.begin(), kMetricNames.end(), options.metric);
  const std::optional<Metric> metric = named != kMetricNames.end()
                                           ? std::optional(static_cast<Metric>(named - kMetricNames.begin()))
                                           : telling_metric(run);
  if (metric && run.metrics[*metric]) return *metric;
  throw InputError(
      fmt::format("{}: {} cannot be told in this scene", run.run.label(),
                  metric ? std::string(name_of(*metric)) : "an error of position, energy or momentum"));
}

}  // namespace

ExitCode explain_command(const Options& options) {
  const EngineCatalog catalog(engine_folder(), options.engines_from, options.threads);
  const ScenarioPtr scene = scene_to_explain(options, catalog);
  const auto [engine, info] = engine_to_explain(options, catalog);

  const Laboratory laboratory(scene, engine, options);
  RunComparison start = laboratory.run_profile(engine.profile);
  if (start.run.status != RunStatus::ok) {
    fmt::print("{}: {}: {}: {}\n", scene->id, start.run.label(), name_of(start.run.status), start.run.reason);
    return ExitCode::violated;
  }
  ExplainedScene explained{scene, metric_to_explain(options, start), laboratory.truth().kind, {}, {}, {}};
  const DivergenceScale scale = divergence_scale(explained.metric, *scene, laboratory.truth(), start.run);
  explained.run = std::move(start.run);
  const std::optional<std::string> other = other_profile(info, engine.profile);
  if (other) explained.other = laboratory.run_profile(*other).run;
  explained.explanation =
      explain(other ? info.switches : std::vector<Switch>(), scale,
              [&](const std::vector<Trial>& trials) { return laboratory.run(trials, explained.metric); });

  fmt::print("{}", explanation_table(explained));
  if (!options.json_file.empty()) {
    write_file(options.json_file, explanation_json(explained, CAROM_VERSION));
  }
  return ExitCode::holds;
}

}  // namespace carom
