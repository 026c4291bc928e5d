#include "app/prepare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "app/laws.h"
#include "app/layout.h"
#include "carom/law_engine.h"
#include "core/error.h"
#include "scenario/catalog.h"
#include "scenario/parse.h"

namespace carom {

namespace fs = std::filesystem;

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
  if (!options.laws.empty()) all.push_back({law_source(load_laws(options.laws)), std::nullopt, {}});
  std::vector<EngineSource> sources;
  sources.reserve(all.size());
  for (const Participant& each : all) sources.push_back(each.source);
  std::vector<EngineInfo> infos = describe_engines(sources, limits, options.parallel);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].info = std::move(infos[i]);
  return all;
}

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

}  // namespace carom
