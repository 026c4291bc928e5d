#include "report/page/symmetry.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "report/page/wording.h"

namespace carom::page {

namespace {

/// One check of one run in one scene.
struct Cell {
  const SymmetryResult* result = nullptr;
  const SceneComparison* scene = nullptr;
  std::optional<double> floor_radii;
};

Verdict look_of(SymmetryVerdict verdict) {
  switch (verdict) {
    case SymmetryVerdict::to_the_bit:
    case SymmetryVerdict::to_rounding:
      return Verdict::pass;
    case SymmetryVerdict::broken:
      return Verdict::fail;
    case SymmetryVerdict::twin_did_not_run:
      return Verdict::error;
    case SymmetryVerdict::does_not_apply:
      break;
  }
  return Verdict::unsupported;
}

/// How bad a verdict is: the worst of several scenes stands for all. One that does not apply says nothing.
int badness(SymmetryVerdict verdict) {
  switch (verdict) {
    case SymmetryVerdict::does_not_apply:
      return 0;
    case SymmetryVerdict::to_the_bit:
      return 1;
    case SymmetryVerdict::to_rounding:
      return 2;
    case SymmetryVerdict::broken:
      return 3;
    case SymmetryVerdict::twin_did_not_run:
      return 4;
  }
  return 0;
}

bool worse(const SymmetryResult& a, const SymmetryResult& b) {
  const auto rank = [](const SymmetryResult& result) {
    return std::pair(badness(result.verdict), result.position_radii.value_or(0.0));
  };
  return rank(a) > rank(b);
}

std::string radii(const std::optional<double>& value) {
  return number(value) + " radii";
}

std::string words_of(const SymmetryResult& result) {
  if (result.verdict == SymmetryVerdict::broken) return "breaks";
  return std::string(name_of(result.verdict));
}

/// Everything that is known of a check, for the tooltip.
std::string numbers(const Cell& cell) {
  const SymmetryResult& result = *cell.result;
  if (!result.reason.empty()) return cell.scene->scene->title + ": " + result.reason;
  return fmt::format("{}: {} apart, energy {} of its scale; rounding can make up to {}",
                     cell.scene->scene->title, radii(result.position_radii), number(result.energy),
                     radii(cell.floor_radii));
}

void add_cell(Node row, const Cell& cell, bool name_scene) {
  if (cell.result == nullptr) {
    add(row, "td", {{"class", "cell absent"}}, "not asked");
    return;
  }
  const SymmetryResult& result = *cell.result;
  const Verdict verdict = look_of(result.verdict);
  const std::string look(name_of(verdict));
  Node box = add(row, "td", {{"class", "cell " + look}});
  Node link = add(box, "a", {{"href", "#" + anchor_of(*cell.scene->scene)}, {"title", numbers(cell)}});
  Node words = add(link, "span", {{"class", "verdict " + look}});
  add(words, "span", {{"class", "mark"}, {"aria-hidden", "true"}}, std::string(glyph_of(verdict)));
  say(words, " " + words_of(result));
  // 0 radii say no more than "to the bit".
  const bool says_more = result.position_radii && result.verdict != SymmetryVerdict::to_the_bit;
  if (says_more) add(link, "span", {{"class", "value"}}, radii(result.position_radii));
  if (name_scene && verdict == Verdict::fail) {
    add(link, "span", {{"class", "value"}}, cell.scene->scene->id);
  }
}

/// The checks that some scene asks for, in the order of the list.
std::vector<Symmetry> columns_of(const Results& results) {
  std::vector<Symmetry> columns;
  for (std::size_t i = 0; i < kSymmetryNames.size(); ++i) {
    const auto symmetry = static_cast<Symmetry>(i);
    const bool asked =
        std::any_of(results.scenes.begin(), results.scenes.end(), [&](const SceneComparison& scene) {
          const std::vector<Symmetry>& checks = scene.scene->symmetries;
          return std::find(checks.begin(), checks.end(), symmetry) != checks.end();
        });
    if (asked) columns.push_back(symmetry);
  }
  return columns;
}

Cell cell_of(const SceneComparison& scene, const std::string& label, Symmetry symmetry) {
  for (const RunComparison& run : scene.runs) {
    if (run.run.label() != label) continue;
    for (const SymmetryResult& result : run.symmetries.checks) {
      if (result.symmetry == symmetry) return {&result, &scene, run.symmetries.floor_radii};
    }
  }
  return {};
}

Cell worst_of(const std::vector<const SceneComparison*>& scenes, const std::string& label,
              Symmetry symmetry) {
  Cell worst;
  for (const SceneComparison* scene : scenes) {
    const Cell cell = cell_of(*scene, label, symmetry);
    if (cell.result != nullptr && (worst.result == nullptr || worse(*cell.result, *worst.result))) {
      worst = cell;
    }
  }
  return worst;
}

/// The floors of a run over some scenes: "1e-10" or "6e-12 … 8e-10".
std::string floors_of(const std::vector<const SceneComparison*>& scenes, const std::string& label) {
  std::vector<double> floors;
  for (const SceneComparison* scene : scenes) {
    for (const RunComparison& run : scene->runs) {
      if (run.run.label() == label && run.symmetries.floor_radii)
        floors.push_back(*run.symmetries.floor_radii);
    }
  }
  if (floors.empty()) return number(std::nullopt);
  const auto [low, high] = std::minmax_element(floors.begin(), floors.end());
  return floors.size() == 1 ? number(*low) : number(*low) + " … " + number(*high);
}

/// One row for each engine and profile, the worst of these scenes in each cell.
void add_matrix(Node parent, const std::string& caption, const std::vector<Symmetry>& columns,
                const std::vector<const SceneComparison*>& scenes, const Legend& legend) {
  std::vector<Heading> headings = {{"engine", ""}};
  for (const Symmetry symmetry : columns) headings.push_back({std::string(name_of(symmetry)), ""});
  headings.push_back({"floor, radii", "number"});
  Node body = add_table(parent, "matrix", caption, headings);
  for (const std::string& label : legend.labels()) {
    const bool took_part = std::any_of(columns.begin(), columns.end(), [&](Symmetry symmetry) {
      return worst_of(scenes, label, symmetry).result != nullptr;
    });
    if (!took_part) continue;
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, label);
    for (const Symmetry symmetry : columns) {
      add_cell(row, worst_of(scenes, label, symmetry), scenes.size() > 1);
    }
    add_number(row, floors_of(scenes, label));
  }
}

constexpr const char* kHowToRead =
    "No truth is needed here. Each engine runs a scene, and then the same scene as it looks in a mirror, "
    "turned by "
    "90° or by one radian, from a frame that moves as fast as the fastest ball, with other numbers on the "
    "balls, in "
    "units that are powers of two of the old (rescale-2: a length of 1 is 8, a time ¼, a mass 16) or are not "
    "(rescale-1.7: 1.7, 1.3, 2.3), or from its own end back in time. Seen from the scene again the second "
    "run must "
    "be the first. A cell has the largest distance of any ball in any frame, in radii of the smallest ball, "
    "the worst "
    "of all scenes. To the bit: every digit of every state agrees. To rounding: no further apart than the "
    "floor, which "
    "is what becomes of a disturbance as large as all roundings of the run together can be in the engine's "
    "precision, "
    "measured in the same engine. Where a floor is as large as a radius, single precision leaves nothing to "
    "be told. "
    "An engine that works in fixed steps may keep every symmetry and be wrong all the same; but one that "
    "breaks one is "
    "wrong without any truth.";

}  // namespace

bool has_symmetries(const Results& results) {
  return !columns_of(results).empty();
}

void add_symmetries(Node parent, const Results& results, const Legend& legend) {
  const std::vector<Symmetry> columns = columns_of(results);
  if (columns.empty()) return;
  Node section = add(parent, "section", {{"id", "symmetry"}, {"aria-labelledby", "symmetry-title"}});
  add(section, "h2", {{"id", "symmetry-title"}}, "Which engine keeps which symmetry");
  std::vector<const SceneComparison*> scenes;
  for (const SceneComparison& scene : results.scenes) {
    if (!scene.scene->symmetries.empty()) scenes.push_back(&scene);
  }
  add_matrix(section, "The worst of " + count_of(scenes.size(), "scene"), columns, scenes, legend);
  add(section, "p", {{"class", "note"}}, kHowToRead);
  if (scenes.size() < 2) return;
  Node details = add_details(section, "Scene by scene");
  for (const SceneComparison* scene : scenes) {
    add_matrix(details, scene->scene->title, columns, {scene}, legend);
  }
}

}  // namespace carom::page
