#include "tests/gates/catches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "core/files.h"
#include "engine/modules.h"
#include "tests/support/folder.h"

namespace carom::gates {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kEngine = "plain";

/// The runs of one scene, as `carom check --json` writes them.
Json checked(const std::filesystem::path& modules, const std::string& scene,
             const std::vector<std::string>& engines) {
  const test::TestFolder folder;
  const std::filesystem::path file = folder / "results.json";
  Options options;
  options.command = "check";
  options.scenes = {scene};
  options.engines = engines;
  options.engines_from = {modules.string()};
  options.json_file = file.string();
  options.parallel = 2;
  options.quiet = true;
  compare_command(options);
  return Json::parse(read_file(file)).at("scenes").at(0).at("runs");
}

const Catcher* catcher_of(std::string_view defect) {
  const auto* found = std::find_if(kCatchers.begin(), kCatchers.end(),
                                   [defect](const Catcher& row) { return row.defect == defect; });
  return found == kCatchers.end() ? nullptr : found;
}

void take_gate(const Json& runs, Catch& row) {
  for (const Json& run : runs) {
    if (fmt::format("{}@{}", run.at("engine").get<std::string>(), run.at("profile").get<std::string>()) !=
        row.engine) {
      continue;
    }
    for (const Json& gate : run.at("gates")) {
      if (gate.at("metric") != row.metric || gate.at("value").is_null()) continue;
      row.value = gate.at("value");
      row.limit = gate.at("limit");
      row.caught = !gate.at("holds").get<bool>();
    }
  }
}

/// Three digits: the fourth may be another compiler's.
double rounded(double value) {
  return std::strtod(fmt::format("{:.3g}", value).c_str(), nullptr);
}

}  // namespace

std::vector<Catch> run_catches(const std::filesystem::path& modules) {
  std::vector<Catch> catches;
  std::map<std::string, std::vector<std::string>> engines_in;  // by scene
  const EngineInfo info = open_engine_module(modules / fmt::format("{}.so", kEngine)).info();
  for (const Profile& profile : info.profiles) {
    if (profile.name == "faithful") continue;
    Catch& row = catches.emplace_back();
    row.engine = fmt::format("{}@{}", kEngine, profile.name);
    row.broken = profile.about;
    const Catcher* catcher = catcher_of(profile.name);
    if (catcher == nullptr) continue;
    row.scene = catcher->scene;
    row.metric = name_of(catcher->metric);
    engines_in[row.scene].push_back(row.engine);
  }
  for (const auto& [scene, engines] : engines_in) {
    const Json runs = checked(modules, scene, engines);
    for (Catch& row : catches) {
      if (row.scene == scene) take_gate(runs, row);
    }
  }
  return catches;
}

std::string catches_json(const std::vector<Catch>& catches) {
  Json json = {{"catches", Json::array()}};
  for (const Catch& row : catches) {
    json["catches"].push_back({{"engine", row.engine},
                               {"broken", row.broken},
                               {"scene", row.scene},
                               {"metric", row.metric},
                               {"value", rounded(row.value)},
                               {"limit", row.limit},
                               {"caught", row.caught}});
  }
  return json.dump(2) + "\n";
}

}  // namespace carom::gates
