#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "app/commands.h"
#include "app/laws.h"
#include "app/layout.h"
#include "app/machine.h"
#include "app/prepare.h"
#include "app/study_progress.h"
#include "carom/evolvers/list.h"
#include "core/error.h"
#include "core/files.h"
#include "report/page.h"
#include "report/study_csv.h"
#include "report/study_table.h"
#include "study/growth.h"
#include "study/measure.h"
#include "study/study_json.h"

namespace carom {

namespace {

/// The engine whose front is held against those of the others.
constexpr const char* kOwn = "carom";

/// Carom's evolvers, each by its name, and every other engine that was built, in its first profile.
std::vector<EngineChoice> engines_by_default(const Options& options, const EngineCatalog& catalog,
                                             const ProcessLimits& limits) {
  std::vector<EngineSource> sources;
  for (const Evolver& evolver : all_evolvers()) {
    sources.push_back(catalog.find(fmt::format("{}:{}", kOwn, evolver.name)));
  }
  for (const EngineSource& source : catalog.sources()) {
    if (source.name != kOwn) sources.push_back(source);
  }
  const std::vector<EngineInfo> infos = describe_engines(sources, limits, options.parallel);
  std::vector<EngineChoice> choices;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const bool opened = !infos[i].profiles.empty();
    choices.push_back({sources[i], opened ? infos[i].profiles.front().name : "faithful"});
  }
  return choices;
}

std::vector<EngineChoice> engines_of(const Options& options, const EngineCatalog& catalog) {
  const ProcessLimits limits{ProcessLimits().wall_seconds, options.memory_mib};
  if (!options.engines.empty()) return choose_engines(participants(options, catalog, limits));
  std::vector<EngineChoice> engines = engines_by_default(options, catalog, limits);
  if (!options.laws.empty()) {
    const std::vector<LawFile> laws = load_laws(options.laws);
    for (const LawFile& law : laws) engines.push_back({law_source(laws), law.id});
  }
  return engines;
}

/// A study that is kept in a file while it goes.
class Kept {
 public:
  Kept(Study& study, std::string file) : study_(study), file_(std::move(file)) {}

  /// Not after every run of a few milliseconds: writing would take longer than running.
  void changed() {
    const auto now = std::chrono::steady_clock::now();
    if (file_.empty() || now - written_ < std::chrono::seconds(1)) return;
    write();
  }
  void write() {
    if (file_.empty()) return;
    write_file(file_, study_json(study_));
    written_ = std::chrono::steady_clock::now();
  }

 private:
  Study& study_;
  std::string file_;
  std::chrono::steady_clock::time_point written_;
};

bool is_same(const Machine& a, const Machine& b) {
  return a.cpu == b.cpu && a.cores == b.cores && a.compiler == b.compiler && a.build == b.build &&
         a.flags == b.flags;
}

/// What there is of this study in the file; nothing where there is no file yet.
/// @throws InputError where times of it and of what is to come could not stand side by side
Study taken_up(const Study& study, const std::string& file) {
  if (file.empty() || !std::filesystem::exists(file)) return {};
  Study before = parse_study(read_file(file), file);
  if (before.version != study.version || !is_same(before.machine, study.machine)) {
    throw InputError(
        fmt::format("{}: a study of Carom {} on {} ({}, {} {}); allowed: one of this program on this machine",
                    file, before.version, before.machine.cpu, before.machine.compiler, before.machine.build,
                    before.machine.flags));
  }
  const StudyLimits& was = before.limits;
  const StudyLimits& is = study.limits;
  if (was.timeout_s != is.timeout_s || was.memory_mib != is.memory_mib || was.repeats != is.repeats) {
    throw InputError(fmt::format(
        "{}: a study with --timeout {:g} --memory {:g} --repeats {}, found --timeout {:g} "
        "--memory {:g} --repeats {}; allowed: the same",
        file, was.timeout_s, was.memory_mib, was.repeats, is.timeout_s, is.memory_mib, is.repeats));
  }
  return before;
}

/// The part of a study before that is of this scene as it is now; else nothing.
StudyScene taken_up(const Study& before, const Scenario& scene, const std::optional<std::uint64_t>& seed) {
  for (const StudyScene& each : before.scenes) {
    if (each.id == scene.id && each.sha256 == scene.sha256 && each.seed == seed) return each;
  }
  return {};
}

void measure(const std::vector<ScenarioPtr>& scenes, const std::vector<EngineChoice>& engines,
             const Options& options, const Study& before, Study& study) {
  const std::vector<GasKind> gases = gas_kinds(scenes);
  Kept kept(study, options.resume_file);
  StudyProgress progress(scenes.size() + gases.size(), options.quiet);
  StudyWatch watch;
  watch.more = [&](std::size_t runs) { progress.more(runs); };
  watch.done = [&](const std::string& what) { progress.done(what); };
  watch.changed = [&] { kept.changed(); };
  study.growths = before.growths;
  for (const ScenarioPtr& scene : scenes) {
    study.scenes.push_back(taken_up(before, *scene, options.seed));
    study.scenes.back().seed = options.seed;
  }
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    progress.begin_part();
    measure_scene(scenes[i], engines, truth_sources(), study.limits, options.parallel, watch,
                  study.scenes[i]);
  }
  for (const GasKind& gas : gases) {
    progress.begin_part();
    measure_growth(gas, engines, study.limits, watch, study.growths);
  }
  kept.write();
}

}  // namespace

ExitCode study_command(const Options& options) {
  const EngineCatalog catalog(engine_folder(), options.engines_from);
  const std::vector<ScenarioPtr> scenes = load_scenes(options, catalog);
  const std::vector<EngineChoice> engines = engines_of(options, catalog);
  Study study;
  study.version = CAROM_VERSION;
  study.machine = this_machine();
  study.own = kOwn;
  study.limits = {options.study_timeout_s, options.memory_mib, options.repeats};
  const Study before = taken_up(study, options.resume_file);
  measure(scenes, engines, options, before, study);

  if (!options.quiet) fmt::print("{}", study_table(study));
  if (!options.json_file.empty()) write_file(options.json_file, study_json(study));
  if (!options.report_folder.empty()) {
    const std::filesystem::path page = std::filesystem::path(options.report_folder) / "index.html";
    write_file(page, render_study_page(study, web_folder()));
    if (!options.quiet) fmt::print("The page is {}\n", page.string());
  }
  if (!options.csv_file.empty()) write_file(options.csv_file, study_csv(study));
  return ExitCode::holds;
}

}  // namespace carom
