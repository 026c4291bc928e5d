#include "report/page/overview.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "report/page/wording.h"
#include "report/words.h"

namespace carom::page {

namespace {

constexpr const char* kWhatThisIs =
    "The same scenes of moving and colliding balls were run in several physics engines, each in a process of "
    "its "
    "own. Every run is held against the exact solution where there is one, against what physics conserves, "
    "and "
    "against every other engine.";

struct VerdictMeaning {
  Verdict verdict;
  const char* meaning;
};

constexpr VerdictMeaning kVerdicts[] = {
    {Verdict::pass, "meets every gate of the scene"},
    {Verdict::fail, "breaks a gate"},
    {Verdict::shown, "measured, but no gate is set for it"},
    {Verdict::unsupported, "cannot run this scene, and says why"},
    {Verdict::error, "crashed, hung or gave values that are not numbers"},
};

/// In how many of its gated scenes an engine under test holds every gate.
struct Score {
  std::size_t holds = 0;
  std::size_t gated = 0;
};

std::vector<std::pair<std::string, Score>> scores(const Results& results, const Legend& legend) {
  std::map<std::string, Score> found;
  for (const SceneComparison& scene : results.scenes) {
    for (const RunComparison& run : scene.runs) {
      if (!run.under_test || (run.gates.empty() && !run.violates())) continue;
      Score& score = found[run.run.label()];
      ++score.gated;
      if (!run.violates()) ++score.holds;
    }
  }
  std::vector<std::pair<std::string, Score>> ordered;
  for (const std::string& label : legend.labels()) {
    if (found.count(label) > 0) ordered.emplace_back(label, found[label]);
  }
  return ordered;
}

void add_violations(Node parent, const Results& results) {
  Node list = add(parent, "ul", {{"class", "violations"}});
  for (const SceneComparison& scene : results.scenes) {
    for (const RunComparison& run : scene.runs) {
      for (const std::string& line : violations(scene, run)) {
        add(add(list, "li"), "a", {{"href", "#" + anchor_of(*scene.scene)}}, line);
      }
    }
  }
  if (!list.first_child()) parent.remove_child(list);
}

void add_result(Node parent, const Results& results, const Legend& legend) {
  const bool holds = results.holds();
  Node box = add(parent, "div", {{"class", holds ? "result pass" : "result fail"}});
  Node line = add(box, "p", {{"class", "headline"}});
  add(line, "span", {{"class", "mark"}, {"aria-hidden", "true"}}, holds ? "✓" : "✗");
  const auto ordered = scores(results, legend);
  if (!holds) say(line, "Not every gate holds. ");
  for (const auto& [label, score] : ordered) {
    add(line, "strong", {}, label);
    say(line, fmt::format(" holds every gate in {} of {}. ", score.holds, count_of(score.gated, "scene")));
  }
  if (ordered.empty()) say(line, "No engine is under test here. ");
  add_violations(box, results);
}

void add_signs(Node parent) {
  Node list = add(parent, "ul", {{"class", "key"}, {"aria-label", "Meaning of the verdicts"}});
  for (const VerdictMeaning& row : kVerdicts) {
    Node item = add(list, "li");
    add_verdict(item, row.verdict);
    say(item, std::string(" ") + row.meaning);
  }
}

/// The gate that is missed by the largest factor.
const GateResult* worst_gate(const RunComparison& run) {
  const GateResult* worst = nullptr;
  const auto factor = [](const GateResult& gate) { return gate.value ? *gate.value / gate.limit : 0.0; };
  for (const GateResult& gate : run.gates) {
    if (!gate.holds && (worst == nullptr || factor(gate) > factor(*worst))) worst = &gate;
  }
  return worst;
}

/// The number that tells the most: what broke a gate, else the distance from the truth, else the energy.
std::string telling_number(const RunComparison& run) {
  if (run.verdict == Verdict::error) return std::string(name_of(run.run.status));
  if (run.run.status != RunStatus::ok) return {};
  if (const GateResult* gate = worst_gate(run)) {
    return title_of(gate->metric) + " " + value_of(gate->metric, gate->value);
  }
  if (run.metrics[Metric::position]) return value_of(Metric::position, run.metrics[Metric::position]);
  if (run.metrics[Metric::energy]) return "ΔE " + number(run.metrics[Metric::energy]);
  if (run.metrics[Metric::energy_gain]) return "ΔE gained " + number(run.metrics[Metric::energy_gain]);
  return {};
}

void add_cell(Node row, const SceneComparison& scene, const std::string& label) {
  const auto run = std::find_if(scene.runs.begin(), scene.runs.end(),
                                [&](const RunComparison& each) { return each.run.label() == label; });
  if (run == scene.runs.end()) {
    add(row, "td", {{"class", "cell absent"}}, "not run");
    return;
  }
  Node cell = add(row, "td", {{"class", "cell " + std::string(name_of(run->verdict))}});
  Node link = add(cell, "a", {{"href", "#" + anchor_of(*scene.scene)}});
  add_verdict(link, run->verdict);
  const std::string telling = telling_number(*run);
  if (!telling.empty()) add(link, "span", {{"class", "value"}}, telling);
}

void add_matrix(Node parent, const Results& results, const Legend& legend) {
  std::vector<Heading> headings = {{"scene", ""}};
  for (const std::string& label : legend.labels()) headings.push_back({label, ""});
  Node body = add_table(parent, "matrix", "Verdicts by scene and engine", headings);
  std::string group;
  for (const SceneComparison& scene : results.scenes) {
    const std::string& id = scene.scene->id;
    const std::string own_group = id.substr(0, id.find('/'));
    if (own_group != group) {
      group = own_group;
      if (body.first_child()) body = add(body.parent(), "tbody");
      Node heading = add(add(body, "tr", {{"class", "group"}}), "th",
                         {{"scope", "rowgroup"}, {"colspan", std::to_string(headings.size())}});
      add(heading, "span", {}, group);
    }
    Node row = add(body, "tr", {{"data-scene", anchor_of(*scene.scene)}});
    Node name = add(row, "th", {{"scope", "row"}});
    add(name, "a", {{"href", "#" + anchor_of(*scene.scene)}}, scene.scene->title);
    for (const std::string& label : legend.labels()) add_cell(row, scene, label);
  }
}

void add_missing(Node parent, const Results& results) {
  if (results.missing.empty()) return;
  Node note = add(parent, "p", {{"class", "note"}}, "Not built, and so not compared: ");
  std::vector<std::string> names;
  for (const MissingEngine& engine : results.missing) {
    names.push_back(fmt::format("{} (comes with the package {})", engine.name, engine.package));
  }
  say(note, list_of(names) + ".");
}

}  // namespace

void add_verdict(Node parent, Verdict verdict) {
  const std::string word(name_of(verdict));
  Node badge = add(parent, "span", {{"class", "verdict " + word}});
  add(badge, "span", {{"class", "mark"}, {"aria-hidden", "true"}}, std::string(glyph_of(verdict)));
  say(badge, " " + word);
}

void add_overview(Node parent, const Results& results, const Legend& legend) {
  Node header = add(parent, "header", {{"class", "top"}});
  add(header, "h1", {}, "Carom report");
  add(header, "p", {{"class", "lead"}}, kWhatThisIs);
  add_result(header, results, legend);
  Node overview = add(parent, "section", {{"id", "overview"}, {"aria-labelledby", "overview-title"}});
  add(overview, "h2", {{"id", "overview-title"}}, "All scenes");
  add(overview, "p", {{"class", "note"}},
      "Below each verdict stands the largest distance of any ball from the truth, in metres; where there is "
      "no "
      "truth, the largest change of energy, ΔE, as a share of the energy at the start; where a gate is "
      "broken, "
      "what broke it.");
  add_signs(overview);
  add(overview, "div", {{"id", "filter"}});
  add_matrix(overview, results, legend);
  add_missing(overview, results);
}

}  // namespace carom::page
