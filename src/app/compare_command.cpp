#include <fmt/format.h>

#include <algorithm>

#include "app/coefficients.h"
#include "app/commands.h"
#include "app/laws.h"
#include "app/layout.h"
#include "app/machine.h"
#include "app/prepare.h"
#include "app/progress.h"
#include "comparison/baseline.h"
#include "comparison/baseline_file.h"
#include "comparison/check_symmetries.h"
#include "comparison/compare.h"
#include "comparison/examine_textbook.h"
#include "core/files.h"
#include "report/csv.h"
#include "report/json.h"
#include "report/junit.h"
#include "report/page.h"
#include "report/summary.h"
#include "report/table.h"
#include "report/words.h"
#include "study/study_json.h"

namespace carom {

namespace fs = std::filesystem;

namespace {

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
  std::vector<RunSymmetries> symmetries = check_symmetries(*scene, runs, engines, limits, options.parallel);
  return compare(scene, std::move(truth), std::move(runs), engines_under_test(engines),
                 std::move(symmetries));
}

/// Whether the report is of everything: then it says too what impacts deliver, apart from any scene.
bool full_report(const Options& options) {
  const std::vector<std::string>& scenes = options.scenes;
  return !options.report_folder.empty() && std::find(scenes.begin(), scenes.end(), "all") != scenes.end();
}

/// By how much a value may be above the baseline's: rounding changes with a compiler, halves and doubles
/// small errors, and is no regression; what is wrong in an engine changes them by powers of ten.
constexpr double kBaselineFactor = 2.0;

/// The baseline that was asked for; read before anything is run, so that a bad file stops the program at
/// once.
std::optional<Baseline> read_baseline(const Options& options) {
  if (options.baseline_file.empty()) return std::nullopt;
  return parse_baseline(read_file(options.baseline_file), options.baseline_file);
}

void write_baseline(const Options& options, const std::optional<Baseline>& read, const Results& results) {
  if (options.write_baseline_file.empty()) return;
  write_file(options.write_baseline_file,
             baseline_json(merged(read.value_or(Baseline()), baseline_of(results))));
}

/// The study that the page shall show; read before anything is run, like a baseline.
std::optional<Study> read_study(const Options& options) {
  if (options.study_file.empty()) return std::nullopt;
  return parse_study(read_file(options.study_file), options.study_file);
}

void write_outputs(const Options& options, const Results& results, const std::optional<Study>& study) {
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
    write_file(page, render_page(results, web_folder(), viewer_folder(), study ? &*study : nullptr));
    if (!options.quiet) fmt::print("The page is {}\n", page.string());
  }
}

}  // namespace

ExitCode compare_command(const Options& options) {
  const EngineCatalog catalog(engine_folder(), options.engines_from, options.threads);
  const std::vector<ScenarioPtr> scenes = load_scenes(options, catalog);
  const std::optional<Baseline> baseline = read_baseline(options);
  const std::optional<Study> study = read_study(options);
  const ProcessLimits limits{options.timeout_s, options.memory_mib};

  Results results;
  results.seed = options.seed;
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
  if (full_report(options)) {
    results.coefficients = measure_coefficients(engines, limits, options.parallel);
    results.textbook = examine_textbook();
    results.laws.push_back(examine_right_law(true));
    for (const LawFile& law : all_laws()) results.laws.push_back(examine_law(law));
  }
  if (baseline) hold_against(*baseline, options.baseline_factor.value_or(kBaselineFactor), results);
  if (!options.quiet || !results.holds()) {
    fmt::print("{}", results_table(results, options.color));
  } else {
    for (const std::string& line : baseline_lines(results)) fmt::print("baseline: {}\n", line);
  }
  write_outputs(options, results, study);
  write_baseline(options, baseline, results);
  return results.holds() ? ExitCode::holds : ExitCode::violated;
}

}  // namespace carom
