#include "report/page/costs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "report/page/growth.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

using Json = nlohmann::json;

constexpr const char* kBare = "bare";
/// It has no steps: what it does is counted by the impact.
constexpr const char* kStepless = "event";

/// What stands with a scene and an evolver in one of the file's lists; null where nothing does.
const Json* find(const Json& rows, const std::string& scene, const std::string& evolver) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Json& row) {
    return row.at("scene") == scene && row.at("evolver") == evolver;
  });
  return found == rows.end() ? nullptr : &*found;
}

/// The values of a key, each once, in the order in which they come.
std::vector<std::string> each(const Json& rows, const char* key) {
  std::vector<std::string> values;
  for (const Json& row : rows) {
    const std::string value = row.at(key);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

/// Instructions per ball and step, or per impact where there are no steps.
double instructions(const Json& row) {
  const double pieces = row.at("evolver") == kStepless
                            ? row.at("impacts").get<double>()
                            : row.at("balls").get<double>() * row.at("steps").get<double>();
  return row.at("instructions").get<double>() / pieces;
}

double bytes_per_ball(const Json& row, const char* key) {
  return row.at(key).get<double>() / row.at("balls").get<double>();
}

std::string rounded(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : number(value);
}

/// Two columns for each evolver, and a row for each scene; what an evolver does not take stays open.
template <class First, class Second>
void add_scene_table(Node parent, const std::string& caption, const Json& rows, const Heading& second_heading,
                     const First& first, const Second& second) {
  const std::vector<std::string> evolvers = each(rows, "evolver");
  std::vector<Heading> headings = {{"scene", ""}};
  for (const std::string& evolver : evolvers) {
    headings.push_back({evolver, "number"});
    headings.push_back(second_heading);
  }
  Node body = add_table(parent, "measured", caption, headings);
  for (const std::string& scene : each(rows, "scene")) {
    Node line = add(body, "tr");
    add(line, "th", {{"scope", "row"}}, scene);
    for (const std::string& evolver : evolvers) {
      const Json* row = find(rows, scene, evolver);
      add_number(line, row == nullptr ? "–" : first(*row));
      add_number(line, row == nullptr ? "" : second(*row));
    }
  }
}

/// "spin (toi, step)": where a scene takes exactly the instructions of the bare one, to the last.
std::string exactly_bare(const Json& rows) {
  std::vector<std::string> found;
  for (const Json& row : rows) {
    const Json* bare = find(rows, kBare, row.at("evolver"));
    if (row.at("scene") == kBare || bare == nullptr) continue;
    if (row.at("instructions") != bare->at("instructions")) continue;
    found.push_back(row.at("scene").get<std::string>() + " in " + row.at("evolver").get<std::string>());
  }
  return found.empty()
             ? ""
             : " Exactly the instructions of the bare scene, to the last one: " + list_of(found) + ".";
}

void add_instructions(Node parent, const Json& rows) {
  add_scene_table(
      parent, "Instructions per ball and step; event has no steps: per impact", rows, {"× bare", "number"},
      [](const Json& row) { return rounded(instructions(row), 0); },
      [&](const Json& row) {
        const Json* bare = find(rows, kBare, row.at("evolver"));
        return bare == nullptr ? number(std::nullopt) : rounded(instructions(row) / instructions(*bare), 3);
      });
  add(parent, "p", {{"class", "note"}},
      "Bare: balls that collide, and nothing else. Every other scene has the same balls and the one thing "
      "that "
      "it is named for; walls-only has walls, and balls that pass through each other. An effect that a scene "
      "does not name is not compiled into the loops that run. The counts hold what an effect brings about, "
      "too: "
      "between walls the gas stays dense and has more impacts. In event an impact on a wall counts like one "
      "of "
      "two balls, and is cheaper." +
          exactly_bare(rows));
}

void add_alone(Node parent, const Json& rows, const Json& alone) {
  Node body = add_table(
      parent, "measured", "The bare scene, instructions per ball and step",
      {{"evolver", ""}, {"in the whole engine", "number"}, {"alone", "number"}, {"difference", "number"}});
  for (const Json& row : alone) {
    const std::string evolver = row.at("evolver");
    const Json* whole = find(rows, kBare, evolver);
    if (whole == nullptr) continue;
    Node line = add(body, "tr");
    add(line, "th", {{"scope", "row"}}, evolver);
    add_number(line, rounded(instructions(*whole), 1));
    add_number(line, rounded(instructions(row), 1));
    add_number(line, number(100.0 * (instructions(*whole) / instructions(row) - 1.0)) + " %");
  }
  add(parent, "p", {{"class", "note"}},
      "Alone: a program of one evolver, one impact law and one broad phase, put together by hand, that has "
      "never "
      "heard of effects. What is left of a difference is how the compiler arranged the same code.");
}

void add_memory(Node parent, const Json& rows) {
  add_scene_table(
      parent, "Bytes per ball", rows, {"running", "number"},
      [](const Json& row) { return rounded(bytes_per_ball(row, "bytes"), 1); },
      [](const Json& row) { return rounded(bytes_per_ball(row, "bytes_in_use"), 1); });
  add(parent, "p", {{"class", "note"}},
      "First as set up, then after a step, with the lists of the broad phase and of pairs that may meet. A "
      "number takes eight bytes, so a place and a velocity take 48, radius and mass 16; spin and moment of "
      "inertia take 32 more, and are there only where a scene names spin.");
}

void add_all(Node section, const Json& costs) {
  add(section, "p", {{"class", "about"}},
      fmt::format(
          "Counted once by the benchmark (tests/benchmarks/run; {}, build {}), not by the run that made "
          "this page. It counts the processor's instructions, bytes and tests of pairs, not seconds: "
          "such numbers do not depend on what else a machine is doing.",
          costs.at("compiler").get<std::string>(), costs.at("build").get<std::string>()));
  add_instructions(section, costs.at("instructions"));
  add_alone(section, costs.at("instructions"), costs.at("alone"));
  add_memory(section, costs.at("memory"));
  add_growth(section, costs.at("broad_phases"));
}

}  // namespace

void add_costs(Node parent, const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return;
  Node section = add(parent, "section", {{"id", "costs"}, {"aria-labelledby", "costs-title"}});
  add(section, "h2", {{"id", "costs-title"}}, "Only what a scene calls for");
  try {
    add_all(section, Json::parse(read_file(file)));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: {}; tests/benchmarks/run writes it anew", file.string(), error.what()));
  }
}

}  // namespace carom::page
