#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "app/commands.h"
#include "app/engines.h"
#include "app/layout.h"
#include "app/machine.h"
#include "app/progress.h"
#include "comparison/compare.h"
#include "core/error.h"
#include "core/files.h"
#include "report/csv.h"
#include "report/json.h"
#include "report/junit.h"
#include "report/page.h"
#include "report/summary.h"
#include "report/table.h"
#include "scenario/catalog.h"
#include "scenario/parse.h"

namespace carom {

namespace fs = std::filesystem;

namespace {

std::vector<ScenarioPtr> load_scenes(const Options& options, const EngineCatalog& engines) {
  const Catalog catalog(scenario_folder());
  const SceneOptions scene_options{options.step_s, options.seed, engines.names()};
  std::vector<ScenarioPtr> scenes;
  std::set<fs::path> seen;
  for (const std::string& word : options.scenes) {
    for (const fs::path& file : catalog.resolve(word)) {
      if (seen.insert(fs::canonical(file)).second) scenes.push_back(load_scene(file, scene_options));
    }
  }
  return scenes;
}

/// Every engine that was built in each of its profiles, or those that were named.
std::vector<EngineChoice> choose_engines(const Options& options, const EngineCatalog& catalog,
                                         const std::vector<EngineInfo>& infos) {
  std::vector<EngineChoice> choices;
  if (options.engines.empty()) {
    for (std::size_t i = 0; i < infos.size(); ++i) {
      const EngineSource& source = catalog.sources()[i];
      if (infos[i].profiles.empty()) choices.push_back({source, "faithful"});
      for (const Profile& profile : infos[i].profiles) choices.push_back({source, profile.name});
    }
    return choices;
  }
  for (const std::string& word : options.engines) {
    const std::size_t at = word.find('@');
    const EngineSource& source = catalog.find(word.substr(0, at));
    EngineChoice choice{source, at == std::string::npos ? "faithful" : word.substr(at + 1)};
    std::vector<std::string> profiles = {"faithful"};
    for (const EngineInfo& info : infos) {
      if (info.name != source.name || info.profiles.empty()) continue;
      profiles.clear();
      for (const Profile& profile : info.profiles) profiles.push_back(profile.name);
    }
    if (std::find(profiles.begin(), profiles.end(), choice.profile) == profiles.end()) {
      throw InputError(fmt::format("{} has no profile \"{}\"; allowed: {}", source.name, choice.profile,
                                   fmt::join(profiles, ", ")));
    }
    choices.push_back(std::move(choice));
  }
  return choices;
}

/// Carom and its variants where they take part, else every engine that was named.
std::vector<std::string> engines_under_test(const std::vector<EngineChoice>& choices) {
  std::vector<std::string> own;
  std::vector<std::string> all;
  for (const EngineChoice& choice : choices) {
    const std::string& name = choice.source.name;
    all.push_back(engine_label(name, choice.profile));
    if (name == "carom" || name.starts_with("carom:")) own.push_back(all.back());
  }
  return own.empty() ? all : own;
}

/// Why no closed form is asked for this truth; empty where one is.
std::string no_closed_form_asked(TruthKind kind) {
  switch (kind) {
    case TruthKind::automatic:
    case TruthKind::closed_form:
      return {};
    case TruthKind::none:
      return "the scene asks for none";
    case TruthKind::exact:
      return "an exact solution is not available in this version";
    case TruthKind::converged:
      return "a converged solution is not available in this version";
  }
  return {};
}

/// How far, relative to the time, "just before" and "just after" a frame are: far above the rounding of an
/// impact time, far below what anything but an impact changes.
constexpr double kAround = 1e-9;

/// The truth of a scene, recorded from an engine that knows it.
Truth record_truth(const Scenario& scene, const ProcessLimits& limits, int parallel) {
  Truth truth;
  truth.reason = no_closed_form_asked(scene.truth);
  if (!truth.reason.empty()) return truth;
  const auto recorded_over = [&](double duration_share) {
    Scenario stretched = scene;
    stretched.duration_s *= duration_share;
    return run_engines(stretched, {{closed_form_source(), "faithful"}}, limits, parallel).front();
  };
  const Run run = recorded_over(1.0);
  truth.reason = run.reason;
  if (run.status != RunStatus::ok) return truth;
  truth.kind = run.engine;
  truth.uncertainty_m = run.uncertainty_m;
  truth.trajectory = run.trajectory;
  for (const double share : {1.0 - kAround, 1.0 + kAround}) {
    const Run around = recorded_over(share);
    if (around.status == RunStatus::ok) truth.around.push_back(around.trajectory);
  }
  return truth;
}

SceneComparison compare_scene(const ScenarioPtr& scene, const std::vector<EngineChoice>& engines,
                              const Options& options, Progress& progress) {
  const ProcessLimits limits{options.timeout_s, options.memory_mib};
  Truth truth = record_truth(*scene, limits, options.parallel);
  std::vector<Run> runs = run_engines(*scene, engines, limits, options.parallel, [&](std::size_t done) {
    progress.advance(fmt::format("{} {}", scene->id, engines[done].source.name));
  });
  return compare(scene, std::move(truth), std::move(runs), engines_under_test(engines));
}

void write_outputs(const Options& options, const Results& results) {
  if (!options.json_file.empty()) write_file(options.json_file, results_json(results, options.all_balls));
  if (!options.junit_file.empty()) write_file(options.junit_file, results_junit(results));
  if (!options.summary_file.empty()) write_file(options.summary_file, results_summary(results));
  if (!options.csv_folder.empty()) {
    for (const SceneComparison& scene : results.scenes) {
      for (const RunComparison& run : scene.runs) {
        if (run.run.status != RunStatus::ok) continue;
        write_file(fs::path(options.csv_folder) / scene.scene->id / (run.run.label() + ".csv"),
                   trajectory_csv(run.run.trajectory));
      }
    }
  }
  if (!options.report_folder.empty()) {
    const fs::path page = fs::path(options.report_folder) / "index.html";
    write_file(page, render_page(results, web_folder()));
    if (!options.quiet) fmt::print("The page is {}\n", page.string());
  }
}

}  // namespace

ExitCode compare_command(const Options& options) {
  const EngineCatalog catalog(engine_folder(), options.engines_from);
  const std::vector<ScenarioPtr> scenes = load_scenes(options, catalog);
  const ProcessLimits limits{options.timeout_s, options.memory_mib};

  Results results;
  results.version = CAROM_VERSION;
  results.machine = this_machine();
  results.missing = catalog.missing();
  const std::vector<EngineInfo> infos = describe_engines(catalog.sources(), limits, options.parallel);
  const std::vector<EngineChoice> engines = choose_engines(options, catalog, infos);
  for (const EngineInfo& info : infos) {
    const bool takes_part = std::any_of(engines.begin(), engines.end(), [&](const EngineChoice& choice) {
      return choice.source.name == info.name;
    });
    if (takes_part) results.engines.push_back(info);
  }

  {
    Progress progress(scenes.size() * engines.size(), options.quiet);
    for (const ScenarioPtr& scene : scenes) {
      results.scenes.push_back(compare_scene(scene, engines, options, progress));
    }
  }
  if (!options.quiet || !results.holds()) fmt::print("{}", results_table(results, options.color));
  write_outputs(options, results);
  return results.holds() ? ExitCode::holds : ExitCode::violated;
}

}  // namespace carom
