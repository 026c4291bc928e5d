#include "report/page/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "report/page/axis.h"
#include "report/page/canvas.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

constexpr double kSpeedsWidth_px = 330.0;
constexpr double kSpeedsHeight_px = 190.0;

std::string title_of(StatisticKind kind) {
  switch (kind) {
    case StatisticKind::speeds:
      return "speeds";
    case StatisticKind::fourth_moment:
      return "fourth moment";
    case StatisticKind::collision_rate:
      return "collision rate";
    case StatisticKind::wall_pressure:
      return "pressure on the walls";
    case StatisticKind::equipartition:
      return "energy, heavy by light";
    case StatisticKind::cooling:
      return "cooling";
  }
  return {};
}

std::string quantity_of(StatisticKind kind, int dimension) {
  switch (kind) {
    case StatisticKind::speeds:
      return "D";
    case StatisticKind::fourth_moment:
      return "a2";
    case StatisticKind::collision_rate:
      return "per ball, 1/s";
    case StatisticKind::wall_pressure:
      return dimension == 3 ? "N/m²" : "N/m";
    case StatisticKind::equipartition:
      return "ratio";
    case StatisticKind::cooling:
      return "T/T₀";
  }
  return {};
}

const Statistic* find(const RunComparison& run, StatisticKind kind) {
  if (!run.statistics) return nullptr;
  const std::vector<Statistic>& all = run.statistics->all;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Statistic& each) { return each.kind == kind; });
  return found == all.end() ? nullptr : &*found;
}

/// Those that some run answers, in their order.
std::vector<StatisticKind> columns_of(const SceneComparison& scene) {
  std::vector<StatisticKind> columns;
  for (std::size_t i = 0; i < kStatisticNames.size(); ++i) {
    const auto kind = static_cast<StatisticKind>(i);
    const bool any = std::any_of(scene.runs.begin(), scene.runs.end(),
                                 [&](const RunComparison& run) { return find(run, kind) != nullptr; });
    if (any) columns.push_back(kind);
  }
  return columns;
}

std::string why_not(const RunComparison& run, StatisticKind kind) {
  if (run.run.status != RunStatus::ok) return std::string(name_of(run.run.status));
  if (run.statistics) {
    for (const NotAsked& each : run.statistics->not_asked) {
      if (each.kind == kind) return "n/a: " + each.reason;
    }
  }
  return "n/a";
}

void add_cell(Node row, const RunComparison& run, StatisticKind kind) {
  const Statistic* statistic = find(run, kind);
  if (statistic == nullptr) {
    add(row, "td", {{"class", "reason"}}, why_not(run, kind));
    return;
  }
  const std::string look = statistic->as_expected() ? "pass" : "fail";
  Node cell = add(row, "td", {{"title", statistic->detail}});
  Node words = add(cell, "span", {{"class", "verdict " + look}});
  add(words, "span", {{"class", "mark"}, {"aria-hidden", "true"}}, statistic->as_expected() ? "✓" : "✗");
  say(words, statistic->as_expected() ? " as expected" : " off by " + number(statistic->deviations));
  add(cell, "span", {{"class", "value"}},
      fmt::format("{}; {} ± {}", number(statistic->value), number(statistic->expected),
                  number(statistic->allowance)));
}

void add_table_of(Node parent, const SceneComparison& scene, const std::vector<StatisticKind>& columns) {
  std::vector<Heading> headings = {{"engine", ""}};
  for (const StatisticKind kind : columns) {
    headings.push_back({title_of(kind) + ", " + quantity_of(kind, scene.scene->dimension), ""});
  }
  Node body = add_table(
      parent, "statistics",
      "Measured; expected ± allowance. Off by so many allowances; up to four are as expected", headings);
  for (const RunComparison& run : scene.runs) {
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, run.run.label());
    for (const StatisticKind kind : columns) add_cell(row, run, kind);
  }
}

void add_explanations(Node parent, const SceneStatistics& asked, const std::vector<StatisticKind>& columns) {
  Node details = add_details(parent, "What is compared, and where the allowances come from");
  Node list = add(details, "dl");
  for (const StatisticKind kind : columns) {
    add(list, "dt", {}, title_of(kind));
    add(list, "dd", {}, std::string(explanation_of(kind)));
  }
  for (const NotAsked& each : asked.not_asked) {
    add(list, "dt", {}, title_of(each.kind));
    add(list, "dd", {}, "Does not apply: " + each.reason + ".");
  }
}

/// The middles of the cells.
Polyline line_of(const Canvas& canvas, const SceneStatistics& asked, const std::vector<double>& density) {
  Polyline line;
  for (std::size_t cell = 0; cell < density.size(); ++cell) {
    line.push_back(canvas.at((static_cast<double>(cell) + 0.5) * asked.cell_width, density[cell]));
  }
  return line;
}

void add_speeds(Node parent, const SceneComparison& scene, const Legend& legend) {
  const SceneStatistics& asked = *scene.statistics;
  if (asked.speed_density.empty()) return;
  // Far above the law's own peak there is nothing to read: who is there is cut off.
  constexpr double kHighest = 1.8;
  const double high = kHighest * *std::max_element(asked.speed_density.begin(), asked.speed_density.end());
  Node plots = add(parent, "div", {{"class", "plots"}});
  Node figure = add(plots, "figure", {{"class", "plot"}});
  Node caption = add(figure, "figcaption");
  add(caption, "strong", {}, "Speeds");
  say(caption,
      " of all balls in the frames that are asked. The wide pale line is the exact law; what is far above it "
      "is cut off.");
  const double fastest = asked.cell_width * static_cast<double>(asked.speed_density.size());
  const Canvas canvas = add_canvas(
      figure, {"Speeds", "The share of balls by their speed, for each engine, with the exact law."},
      Axis::linear(0.0, fastest), Axis::linear(0.0, high), kSpeedsWidth_px, kSpeedsHeight_px,
      {5, "speed by √(T/m)"}, {5, "density"});
  add(canvas.area, "path",
      {{"class", "truth"}, {"d", path_data(line_of(canvas, asked, asked.speed_density))}});
  for (const RunComparison& run : scene.runs) {
    if (!run.statistics) continue;
    const LineStyle style = legend.style(run.run.label());
    Node path = add(canvas.area, "path",
                    {{"class", "line " + style.colour_class},
                     {"d", path_data(line_of(canvas, asked, run.statistics->speed_density))}});
    if (!style.dashes.empty()) path.append_attribute("stroke-dasharray").set_value(style.dashes.c_str());
  }
}

std::string parting_of(const SceneComparison& scene, std::size_t a, std::size_t b) {
  if (a == b) return "";
  for (const PairComparison& pair : scene.pairs) {
    if (pair.a != std::min(a, b) || pair.b != std::max(a, b)) continue;
    return pair.first_divergence ? number(pair.first_divergence->time_s) : "never";
  }
  return "n/a";
}

void add_parting(Node parent, const SceneComparison& scene) {
  if (scene.pairs.empty()) return;
  std::vector<Heading> headings = {{"engine", ""}};
  for (const RunComparison& run : scene.runs) headings.push_back({run.run.label(), "number"});
  Node body = add_table(parent, "parting",
                        "When two engines part, s: the first frame in which they clearly differ", headings);
  for (std::size_t a = 0; a < scene.runs.size(); ++a) {
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, scene.runs[a].run.label());
    for (std::size_t b = 0; b < scene.runs.size(); ++b) add_number(row, parting_of(scene, a, b));
  }
}

}  // namespace

void add_statistics(Node parent, const SceneComparison& scene, const Legend& legend) {
  if (!scene.statistics) return;
  const SceneStatistics& asked = *scene.statistics;
  add(parent, "h3", {}, "Statistics");
  if (!asked.reason.empty()) {
    add(parent, "p", {{"class", "note"}}, "Not asked: " + asked.reason + ".");
  } else {
    const std::string before =
        asked.warm_up_s > 0.0
            ? fmt::format(
                  "Where the balls are nobody can say for long; how they move on the whole is known. The "
                  "first {} s are left out, in which they forget their start; after that each has about "
                  "{} collisions.",
                  number(asked.warm_up_s), number(asked.collisions_per_ball))
            : "Where the balls are nobody can say for long; how fast they are on the whole is known.";
    add(parent, "p", {{"class", "note"}}, before);
    const std::vector<StatisticKind> columns = columns_of(scene);
    if (!columns.empty()) add_table_of(parent, scene, columns);
    add_speeds(parent, scene, legend);
    add_explanations(parent, asked, columns);
  }
  add_parting(parent, scene);
}

}  // namespace carom::page
