#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>

#include "app/commands.h"
#include "app/laws.h"
#include "app/layout.h"
#include "app/machine.h"
#include "app/prepare.h"
#include "app/stop_request.h"
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

/// The scenes of which there is nothing yet, not even what they are.
void drop_what_is_not_begun(Study& study) {
  std::erase_if(study.scenes, [](const StudyScene& scene) { return scene.id.empty(); });
}

/// A study that is kept in a file while it goes. What the file has of other scenes stays in it.
class Kept {
 public:
  Kept(const Study& study, const Study& before, std::string file)
      : study_(study), before_(before), file_(std::move(file)) {}

  /// Not after every run of a few milliseconds: writing is not to take more than a twentieth of the time.
  void changed() {
    if (!file_.empty() && Clock::now() >= next_) write();
  }
  void write() {
    if (file_.empty()) return;
    constexpr int kTimesWriting = 20;
    const Clock::time_point start = Clock::now();
    Study whole = study_;
    drop_what_is_not_begun(whole);
    for (const StudyScene& other : before_.scenes) {
      const bool own = std::any_of(study_.scenes.begin(), study_.scenes.end(),
                                   [&](const StudyScene& scene) { return scene.id == other.id; });
      if (!own) whole.scenes.push_back(other);
    }
    write_file(file_, study_json(whole));
    const Clock::time_point end = Clock::now();
    next_ = end + std::max<Clock::duration>(std::chrono::seconds(1), kTimesWriting * (end - start));
  }

 private:
  using Clock = std::chrono::steady_clock;

  const Study& study_;
  const Study& before_;
  std::string file_;
  Clock::time_point next_;
};

std::string words_of(const StudyLimits& limits) {
  return fmt::format("--timeout {:g} --memory {:g} --repeats {} --budget {:g}", limits.timeout_s,
                     limits.memory_mib, limits.repeats, limits.budget_s);
}

/// What there is of this study in the file; nothing where there is no file yet.
/// @throws InputError where times of it and of what is to come could not stand side by side
Study taken_up(const Study& study, const std::string& file) {
  if (file.empty() || !std::filesystem::exists(file)) return {};
  Study before = parse_study(read_file(file), file);
  if (before.version != study.version || before.machine != study.machine) {
    throw InputError(
        fmt::format("{}: a study of Carom {} on {} ({}, {} {}); allowed: one of this program on this machine",
                    file, before.version, before.machine.cpu, before.machine.compiler, before.machine.build,
                    before.machine.flags));
  }
  if (before.limits != study.limits) {
    throw InputError(fmt::format("{}: a study with {}, found {}; allowed: the same", file,
                                 words_of(before.limits), words_of(study.limits)));
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

/// Of the growths before those of these gases.
std::vector<StudyGrowth> taken_up(const Study& before, const std::vector<GasKind>& gases) {
  std::vector<StudyGrowth> growths;
  std::copy_if(before.growths.begin(), before.growths.end(), std::back_inserter(growths),
               [&](const StudyGrowth& growth) {
                 return std::any_of(gases.begin(), gases.end(),
                                    [&](const GasKind& gas) { return is_of(growth, gas); });
               });
  return growths;
}

void measure(const std::vector<ScenarioPtr>& scenes, const std::vector<EngineChoice>& engines,
             const Options& options, const Study& before, const StopRequest& stop, Study& study) {
  const std::vector<GasKind> gases = gas_kinds(scenes);
  Kept kept(study, before, options.resume_file);
  StudyProgress progress(scenes.size() + gases.size(), options.quiet);
  StudyWatch watch;
  watch.more = [&](std::size_t runs) { progress.more(runs); };
  watch.done = [&](const std::string& what) { progress.done(what); };
  watch.changed = [&] { kept.changed(); };
  watch.stopped = [&] { return stop.made(); };
  study.growths = taken_up(before, gases);
  for (const ScenarioPtr& scene : scenes) {
    study.scenes.push_back(taken_up(before, *scene, options.seed));
    study.scenes.back().seed = options.seed;
  }
  for (std::size_t i = 0; i < scenes.size() && !stop.made(); ++i) {
    progress.begin_part(scenes[i]->id);
    measure_scene(scenes[i], engines, truth_sources(), study.limits, options.parallel, watch,
                  study.scenes[i]);
  }
  for (const GasKind& gas : gases) {
    if (stop.made()) break;
    progress.begin_part(fmt::format("more balls in dimension {}", gas.dimension));
    measure_growth(gas, engines, study.limits, watch, study.growths);
  }
  if (!stop.made()) progress.end_part();
  kept.write();
  drop_what_is_not_begun(study);
}

/// For who has stopped it.
std::string how_to_go_on(const Options& options) {
  if (!options.resume_file.empty()) return "The same command goes on.";
  if (!options.json_file.empty()) return fmt::format("With --resume {} it goes on.", options.json_file);
  return "With --resume FILE it could go on.";
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
  study.limits = {options.study_timeout_s, options.memory_mib, options.repeats, options.budget_s};
  const Study before = taken_up(study, options.resume_file);
  const StopRequest stop;
  measure(scenes, engines, options, before, stop, study);

  if (!options.quiet) fmt::print("{}", study_table(study));
  if (!options.json_file.empty()) write_file(options.json_file, study_json(study));
  if (!options.report_folder.empty()) {
    const std::filesystem::path page = std::filesystem::path(options.report_folder) / "index.html";
    write_file(page, render_study_page(study, web_folder()));
    if (!options.quiet) fmt::print("The page is {}\n", page.string());
  }
  if (!options.csv_file.empty()) write_file(options.csv_file, study_csv(study));
  if (stop.made()) fmt::print(stderr, "carom: stopped; this is what there is. {}\n", how_to_go_on(options));
  stop.obey();
  return ExitCode::holds;
}

}  // namespace carom
