#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/commands.h"
#include "app/engines.h"
#include "app/layout.h"
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

void list_engine(const EngineInfo& info) {
  if (info.about.empty()) {
    fmt::print("  {:<12} cannot be opened: {}\n", info.name, info.version);
    return;
  }
  fmt::print("  {:<12} {} {}, {}\n", info.name, info.version, info.precision, info.about);
  for (const Profile& profile : info.profiles) {
    fmt::print("    @{:<10} {}\n", profile.name, profile.about);
  }
  std::vector<std::string_view> can;
  for (const FeatureName& feature : all_features()) {
    if (!info.cannot.contains(feature.feature)) can.push_back(feature.name);
  }
  fmt::print("    can: {}\n", fmt::join(can, ", "));
  for (const auto& [feature, reason] : info.cannot)
    fmt::print("    cannot: {} ({})\n", name_of(feature), reason);
}

void list_engines(const Options& options) {
  const EngineCatalog catalog(engine_folder(), options.engines_from);
  fmt::print("Engines (--engine NAME or NAME@PROFILE):\n");
  const ProcessLimits limits{options.timeout_s, options.memory_mib};
  for (const EngineInfo& info : describe_engines(catalog.sources(), limits, options.parallel))
    list_engine(info);
  for (const MissingEngine& engine : catalog.missing()) {
    fmt::print("  {:<12} is not built: {} is not installed\n", engine.name, engine.package);
  }
}

void list_effects() {
  fmt::print("Effects and other things a scene can ask for:\n");
  for (const FeatureName& feature : all_features())
    fmt::print("  {:<24} {}\n", feature.name, feature.meaning);
}

}  // namespace

ExitCode list_command(const Options& options) {
  if (options.topic.empty() || options.topic == "scenarios") list_scenarios();
  if (options.topic.empty()) fmt::print("\n");
  if (options.topic.empty() || options.topic == "engines") list_engines(options);
  if (options.topic.empty()) fmt::print("\n");
  if (options.topic.empty() || options.topic == "effects") list_effects();
  return ExitCode::holds;
}

}  // namespace carom
