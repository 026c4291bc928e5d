#include "report/page/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "report/page/study_plot.h"
#include "report/page/study_scene.h"
#include "report/page/wording.h"
#include "report/study_words.h"
#include "study/analyse.h"
#include "study/growth.h"

namespace carom::page {

namespace {

void append_new(std::vector<std::string>& words, const std::string& word) {
  if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
}

std::vector<std::string> labels_of(const Study& study) {
  std::vector<std::string> labels;
  for (const StudyScene& scene : study.scenes) {
    for (const StudyEngine& engine : scene.engines) append_new(labels, engine.label);
  }
  return labels;
}

/// "carom's front lies at or below every peer's in 5 of 6 scenes", with what is ahead of it elsewhere.
void add_result(Node parent, const Study& study) {
  std::size_t held = 0;
  std::size_t taken_part = 0;
  std::vector<const StudyScene*> behind;
  for (const StudyScene& scene : study.scenes) {
    if (!takes_part(scene, study.own)) continue;
    ++taken_part;
    if (leads_over(scene, study.own).empty()) {
      ++held;
    } else {
      behind.push_back(&scene);
    }
  }
  if (taken_part == 0) return;
  Node box = add(parent, "div", {{"class", behind.empty() ? "result pass" : "result fail"}});
  Node line = add(box, "p", {{"class", "headline"}});
  add(line, "span", {{"class", "mark"}, {"aria-hidden", "true"}}, behind.empty() ? "✓" : "✗");
  say(line, fmt::format("The front of {} lies at or below every peer's in {} of {}.", study.own, held,
                        count_of(taken_part, "scene")));
  if (behind.empty()) return;
  Node list = add(box, "ul", {{"class", "violations"}});
  for (const StudyScene* scene : behind) {
    for (const Lead& lead : leads_over(*scene, study.own)) {
      add(add(list, "li"), "a", {{"href", "#" + study_anchor(*scene)}},
          scene->id + ": " + words_of(*scene, study.own, lead));
    }
  }
}

/// One side of a comparison: what all are held to, and what each family comes to; the least is marked.
struct Side {
  std::string held_to;
  std::vector<std::optional<double>> values;  ///< of each family
};

void add_side_row(Node body, const StudyScene& scene, const Side& side, std::string (*words)(double)) {
  std::optional<double> least;
  for (const std::optional<double>& value : side.values) {
    if (value && (!least || *value < *least)) least = value;
  }
  Node row = add(body, "tr");
  add(add(row, "th", {{"scope", "row"}}), "a", {{"href", "#" + study_anchor(scene)}}, scene.id);
  add_number(row, side.held_to);
  for (const std::optional<double>& value : side.values) {
    const bool best = value && value == least;
    add(row, "td", {{"class", best ? "number holds" : "number"}}, value ? words(*value) : "–");
  }
}

std::vector<std::optional<double>> values_of(const Comparison& comparison,
                                             const std::vector<std::string>& families,
                                             std::optional<double> Comparison::Entry::*value) {
  std::vector<std::optional<double>> values(families.size());
  for (const Comparison::Entry& entry : comparison.entries) {
    const auto place = std::find(families.begin(), families.end(), entry.family) - families.begin();
    values[static_cast<std::size_t>(place)] = entry.*value;
  }
  return values;
}

void add_overview_tables(Node parent, const Study& study) {
  std::vector<std::string> families;
  for (const StudyScene& scene : study.scenes) {
    for (const std::string& family : families_of(scene)) append_new(families, family);
  }
  std::vector<Heading> errors = {{"scene", ""}, {"within", "number"}};
  std::vector<Heading> costs = {{"scene", ""}, {"for an error of", "number"}};
  for (const std::string& family : families) {
    errors.push_back({family, "number"});
    costs.push_back({family, "number"});
  }
  Node error_rows = add_table(parent, "measured", "The error at equal cost", errors);
  Node cost_rows = add_table(parent, "measured", "The cost at equal error", costs);
  for (const StudyScene& scene : study.scenes) {
    const std::optional<Comparison> comparison = compare_families(scene);
    if (!comparison) continue;
    const Side at_cost{time_words(comparison->cost_s),
                       values_of(*comparison, families, &Comparison::Entry::error_at_cost)};
    const Side at_error{number(comparison->error) + " " + unit_of(scene),
                        values_of(*comparison, families, &Comparison::Entry::cost_at_error_s)};
    add_side_row(error_rows, scene, at_cost, [](double value) { return number(value); });
    add_side_row(cost_rows, scene, at_error, [](double value) { return time_words(value); });
  }
  add(parent, "p", {{"class", "note"}},
      "Equal cost: the time of the fastest run of the engine whose fastest run is the slowest, so that each "
      "has "
      "a run within it. Equal error: the best of the engine whose best is the worst, so that each reaches "
      "it; in "
      "m, or relative where there is no truth and errors are those of the energy. An engine stands for all "
      "its "
      "variants and settings.");
}

void add_growth_table(Node parent, const Study& study) {
  std::vector<Heading> headings = {{"engine", ""}, {"x in balls^x", "number"}, {"R²", "number"}};
  for (const GrowthPoint& point : study.growths.front().points) {
    headings.push_back({"n = " + given(static_cast<double>(point.balls)), "number"});
  }
  Node body = add_table(parent, "measured",
                        "Nanoseconds per ball and step in a gas of n balls, and the exponent of the "
                        "cost of a step",
                        headings);
  for (const StudyGrowth& growth : study.growths) {
    if (!was_timed(growth)) continue;
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}},
        fmt::format("{}, {}", growth.engine, growth.dimension == 2 ? "plane" : "space"));
    const std::optional<Growth> fit = growth_of(growth);
    add_number(row, fit ? fmt::format("{:.2f}", fit->exponent) : "–");
    add_number(row, fit ? fmt::format("{:.4f}", fit->r_squared) : "–");
    for (const GrowthPoint& point : growth.points) {
      const std::optional<double> ns = per_ball_and_step_ns(point);
      Node cell = add(row, "td", {{"class", "number"}}, ns ? number(*ns) : "–");
      if (!ns) cell.append_attribute("title").set_value(point.reason.c_str());
    }
  }
}

/// "20 % in the plane and 10 % in space": how much of their box the balls fill.
std::string packings_of(const Study& study) {
  std::vector<std::string> words;
  for (const StudyGrowth& growth : study.growths) {
    append_new(words, fmt::format("{} % in {}", number(100.0 * growth.packing),
                                  growth.dimension == 2 ? "the plane" : "space"));
  }
  return list_of(words);
}

void add_growth(Node parent, const Study& study, const Legend& legend) {
  if (study.growths.empty()) return;
  add(parent, "h3", {}, "The cost of more balls");
  add(parent, "p", {{"class", "about"}},
      fmt::format(
          "A gas of equal elastic balls that fill {} of their box and move a tenth of "
          "their radius in a step, for twenty steps; the median of {}. An engine that looks at all pairs "
          "takes ten times as long per ball for ten times the balls; one that knows who is near takes about "
          "the same. "
          "Event-driven engines have no steps and are held against the time that the others step "
          "through.",
          packings_of(study), count_of(kGrowthRepeats, "run")));
  Node row = add(parent, "div", {{"class", "plots"}});
  for (const int dimension : {2, 3}) {
    std::vector<StudyGrowth> growths;
    std::copy_if(study.growths.begin(), study.growths.end(), std::back_inserter(growths),
                 [dimension](const StudyGrowth& growth) { return growth.dimension == dimension; });
    if (!growths.empty()) add_growth_plot(row, growths, legend);
  }
  add_growth_table(parent, study);
}

/// "box2d 2.4.1 (float32), bullet 3.24 (float32)"
std::string versions_of(const Study& study) {
  std::vector<std::string> versions;
  for (const StudyScene& scene : study.scenes) {
    for (const StudyPoint& point : scene.points) {
      if (point.version.empty() || family_of(point.engine) != point.engine) continue;
      append_new(versions, fmt::format("{} {} ({})", point.engine, point.version, point.precision));
    }
  }
  return versions.empty() ? "" : " Engines: " + list_of(versions) + ".";
}

void add_how(Node parent, const Study& study) {
  const Machine& machine = study.machine;
  add(parent, "p", {{"class", "note"}},
      fmt::format(
          "How it was measured: Carom {} on {}, {} cores; compiler {}, build {} ({}).{} A time is the CPU "
          "time of the stepping alone, with nothing recorded, the median of {} (3 of a run that takes more "
          "than 0.1 s, fewer where the budget ended), after a warm-up, in rounds over all engines, one run "
          "at a time. A run was given {} s, a scene {} s beside its truth, cheap runs first; what fails, or "
          "is "
          "foreseen to take longer, stands among the runs with its reason.",
          study.version, machine.cpu, machine.cores, machine.compiler, machine.build, machine.flags,
          versions_of(study), count_of(static_cast<std::size_t>(study.limits.repeats), "run"),
          given(study.limits.timeout_s), given(study.limits.budget_s)));
}

}  // namespace

void add_study(Node parent, const Study& study, const std::string& how_to_read) {
  const Legend legend(labels_of(study));
  Node section = add(parent, "section", {{"id", "study"}, {"aria-labelledby", "study-title"}});
  add(section, "h2", {{"id", "study-title"}}, "What accuracy costs");
  add(section, "p", {{"class", "about"}},
      "How wrong is each engine for the time that it takes, what does the next digit cost, and what is the "
      "cheapest "
      "setting that meets a tolerance? Every engine ran each scene with steps over three decades, and with "
      "what "
      "else it can be tuned by.");
  add_result(section, study);
  add_overview_tables(section, study);
  Node guide = add(section, "div", {{"class", "prose"}});
  add_markdown(guide, how_to_read, 1);
  for (const StudyScene& scene : study.scenes) add_study_scene(section, scene, study.own, legend);
  add_growth(section, study, legend);
  add_how(section, study);
}

}  // namespace carom::page
