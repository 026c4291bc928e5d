#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
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
  std::set<std::string> ids;
  for (const std::string& word : options.scenes) {
    for (const fs::path& file : catalog.resolve(word)) {
      if (!seen.insert(fs::canonical(file)).second) continue;
      scenes.push_back(load_scene(file, scene_options));
      if (!ids.insert(scenes.back()->id).second) {
        throw InputError(
            fmt::format("{}: another scene has the id {} too", file.string(), scenes.back()->id));
      }
    }
  }
  return scenes;
}

/// An engine that was asked for, and what it says of itself.
struct Participant {
  EngineSource source;
  std::optional<std::string> profile;  ///< none: every profile it has
  EngineInfo info;
};

/// Every engine that was built, or those that were named.
std::vector<Participant> participants(const Options& options, const EngineCatalog& catalog,
                                      const ProcessLimits& limits) {
  std::vector<Participant> all;
  if (options.engines.empty()) {
    for (const EngineSource& source : catalog.sources()) all.push_back({source, std::nullopt, {}});
  }
  for (const std::string& word : options.engines) {
    const std::size_t at = word.find('@');
    const std::string profile = at == std::string::npos ? "faithful" : word.substr(at + 1);
    all.push_back({catalog.find(word.substr(0, at)), profile, {}});
  }
  std::vector<EngineSource> sources;
  sources.reserve(all.size());
  for (const Participant& each : all) sources.push_back(each.source);
  std::vector<EngineInfo> infos = describe_engines(sources, limits, options.parallel);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].info = std::move(infos[i]);
  return all;
}

/// Each engine in the profiles asked for, every pair once.
std::vector<EngineChoice> choose_engines(const std::vector<Participant>& participants) {
  std::vector<EngineChoice> choices;
  const auto add = [&](const EngineSource& source, const std::string& profile) {
    const bool named_before = std::any_of(choices.begin(), choices.end(), [&](const EngineChoice& other) {
      return other.source.name == source.name && other.profile == profile;
    });
    if (!named_before) choices.push_back({source, profile});
  };
  for (const Participant& each : participants) {
    std::vector<std::string> profiles;
    for (const Profile& profile : each.info.profiles) profiles.push_back(profile.name);
    // One that cannot even be opened takes part all the same, and its row says why.
    if (profiles.empty()) profiles.push_back(each.profile.value_or("faithful"));
    if (!each.profile) {
      for (const std::string& profile : profiles) add(each.source, profile);
    } else if (std::find(profiles.begin(), profiles.end(), *each.profile) != profiles.end()) {
      add(each.source, *each.profile);
    } else {
      throw InputError(fmt::format("{} has no profile \"{}\"; allowed: {}", each.source.name, *each.profile,
                                   fmt::join(profiles, ", ")));
    }
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

SceneComparison compare_scene(const ScenarioPtr& scene, const std::vector<EngineChoice>& engines,
                              const Options& options, Progress& progress) {
  const ProcessLimits limits{options.timeout_s, options.memory_mib};
  Truth truth = record_truth(*scene, truth_sources(), limits);
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
  const std::vector<Participant> taking_part = participants(options, catalog, limits);
  const std::vector<EngineChoice> engines = choose_engines(taking_part);
  for (const Participant& each : taking_part) {
    const bool told = std::any_of(results.engines.begin(), results.engines.end(),
                                  [&](const EngineInfo& info) { return info.name == each.info.name; });
    if (!told) results.engines.push_back(each.info);
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
