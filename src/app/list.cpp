#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/commands.h"
#include "app/engines.h"
#include "app/layout.h"
#include "carom/carom_engine.h"
#include "carom/textbook/textbook.h"
#include "report/words.h"
#include "scenario/catalog.h"
#include "scenario/features.h"
#include "scenario/parse.h"

namespace carom {

namespace {

void list_scenarios() {
  fmt::print("Scenarios (carom run ID):\n");
  for (const auto& file : Catalog(scenario_folder()).all()) {
    const ScenarioPtr scene = load_scene(file);
    fmt::print("  {:<28} {}\n", scene->id, scene->title);
  }
}

void print_wrapped(std::string_view heading, std::string_view text) {
  fmt::print("{}", wrapped(heading, text));
}

void list_engine(const EngineInfo& info) {
  if (info.about.empty()) {
    print_wrapped(fmt::format("  {:<12} ", info.name), "cannot be opened: " + info.version);
    return;
  }
  print_wrapped(fmt::format("  {:<12} ", info.name),
                fmt::format("{}, {}. {}", info.version, info.precision, info.about));
  for (const Profile& profile : info.profiles) {
    print_wrapped(fmt::format("    @{:<9} ", profile.name), profile.about);
  }
  for (const std::string& limit : info.limits) print_wrapped("    limit      ", limit);
  for (const auto& [feature, reason] : info.cannot) {
    print_wrapped("    cannot     ", fmt::format("{}: {}", name_of(feature), reason));
  }
}

std::vector<EngineInfo> described(const Options& options, const EngineCatalog& catalog) {
  return describe_engines(catalog.sources(), {options.timeout_s, options.memory_mib}, options.parallel);
}

void list_engines(const Options& options, const EngineCatalog& catalog) {
  fmt::print("Engines (--engine NAME or NAME@PROFILE):\n");
  for (const EngineInfo& info : described(options, catalog)) list_engine(info);
  list_engine(make_carom_engine(std::string(kTextbookName))->info());
  print_wrapped("  variants     ", fmt::format("{}", fmt::join(carom_variant_names(), ", ")));
  for (const MissingEngine& engine : catalog.missing()) {
    fmt::print("  {:<12} is not built: {} is not installed\n", engine.name, engine.package);
  }
}

void list_effects(const Options& options, const EngineCatalog& catalog) {
  fmt::print("Effects and what else a scene can ask for, and the engines that can do it:\n");
  const std::vector<EngineInfo> infos = described(options, catalog);
  for (const FeatureName& feature : all_features()) {
    std::vector<std::string> able;
    for (const EngineInfo& info : infos) {
      if (!info.about.empty() && !info.cannot.contains(feature.feature)) able.push_back(info.name);
    }
    fmt::print("  {:<23} {}\n", feature.name, feature.meaning);
    print_wrapped(std::string(26, ' '),
                  able.empty() ? "no engine yet" : fmt::format("{}", fmt::join(able, ", ")));
  }
}

}  // namespace

ExitCode list_command(const Options& options) {
  if (options.topic.empty() || options.topic == "scenarios") list_scenarios();
  if (options.topic.empty()) fmt::print("\n");
  const EngineCatalog catalog(engine_folder(), options.engines_from);
  if (options.topic.empty() || options.topic == "engines") list_engines(options, catalog);
  if (options.topic.empty()) fmt::print("\n");
  if (options.topic.empty() || options.topic == "effects") list_effects(options, catalog);
  return ExitCode::holds;
}

}  // namespace carom
