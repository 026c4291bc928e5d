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
  say(line, fmt::format("{}'s front lies at or below every peer's in {} of {}.", study.own, held,
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

/// The best of a column's values gets a mark of its own.
void add_entry(Node row, const std::string& text, bool best) {
  add(row, "td", {{"class", best ? "number holds" : "number"}}, text);
}

void add_overview_row(Node body, const StudyScene& scene, const Comparison& comparison,
                      const std::vector<std::string>& families) {
  std::optional<double> least_error;
  std::optional<double> least_cost_s;
  for (const Comparison::Entry& entry : comparison.entries) {
    if (entry.error_at_cost) least_error = std::min(*entry.error_at_cost, least_error.value_or(1e300));
    if (entry.cost_at_error_s) least_cost_s = std::min(*entry.cost_at_error_s, least_cost_s.value_or(1e300));
  }
  Node row = add(body, "tr");
  add(add(row, "th", {{"scope", "row"}}), "a", {{"href", "#" + study_anchor(scene)}}, scene.id);
  const auto entry_of = [&](const std::string& family) {
    const auto found = std::find_if(comparison.entries.begin(), comparison.entries.end(),
                                    [&](const Comparison::Entry& entry) { return entry.family == family; });
    return found == comparison.entries.end() ? Comparison::Entry() : *found;
  };
  add_number(row, time_words(comparison.cost_s));
  for (const std::string& family : families) {
    const Comparison::Entry entry = entry_of(family);
    add_entry(row, entry.error_at_cost ? number(*entry.error_at_cost) : "–",
              entry.error_at_cost && entry.error_at_cost == least_error);
  }
  add_number(row, number(comparison.error) + " " + unit_of(scene));
  for (const std::string& family : families) {
    const Comparison::Entry entry = entry_of(family);
    add_entry(row, entry.cost_at_error_s ? time_words(*entry.cost_at_error_s) : "–",
              entry.cost_at_error_s && entry.cost_at_error_s == least_cost_s);
  }
}

void add_overview_table(Node parent, const Study& study) {
  std::vector<std::string> families;
  for (const StudyScene& scene : study.scenes) {
    for (const std::string& family : families_of(scene)) append_new(families, family);
  }
  std::vector<Heading> headings = {{"scene", ""}, {"errors within", "number"}};
  for (const std::string& family : families) headings.push_back({family, "number"});
  headings.push_back({"times for", "number"});
  for (const std::string& family : families) headings.push_back({family, "number"});
  Node body = add_table(parent, "measured", "Left: the error at equal cost. Right: the cost at equal error.",
                        headings);
  for (const StudyScene& scene : study.scenes) {
    const std::optional<Comparison> comparison = compare_families(scene);
    if (comparison) add_overview_row(body, scene, *comparison, families);
  }
  add(parent, "p", {{"class", "note"}},
      "Equal cost: the time of the fastest run of the engine whose fastest run is the slowest, so that each "
      "has a "
      "run within it. Equal error: the best of the engine whose best is the worst, so that each reaches it. "
      "An "
      "engine stands for all its variants and settings.");
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
          "their radius in a step, for twenty steps. An engine that looks at all pairs takes ten times "
          "as long per ball for ten times the balls; one that knows who is near takes about the same. "
          "Event-driven engines have no steps and are held against the time that the others step "
          "through.",
          packings_of(study)));
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
          "than 0.1 s), after a warm-up, in rounds over all engines, one run at a time. A run was given {} "
          "s; "
          "what fails, or is foreseen to take longer, stands among the runs with its reason.",
          study.version, machine.cpu, machine.cores, machine.compiler, machine.build, machine.flags,
          versions_of(study), count_of(static_cast<std::size_t>(study.limits.repeats), "run"),
          given(study.limits.timeout_s)));
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
  add_overview_table(section, study);
  Node guide = add(section, "div", {{"class", "prose"}});
  add_markdown(guide, how_to_read, 1);
  for (const StudyScene& scene : study.scenes) add_study_scene(section, scene, study.own, legend);
  add_growth(section, study, legend);
  add_how(section, study);
}

}  // namespace carom::page
