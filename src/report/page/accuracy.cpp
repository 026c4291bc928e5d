#include "report/page/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "report/page/wording.h"
#include "report/words.h"

namespace carom::page {

namespace {

struct Meaning {
  Accuracy accuracy;
  const char* look;   ///< class of the style sheet
  const char* glyph;  ///< so that colour is never the only sign
  const char* meaning;
};

constexpr std::array kMeanings = {
    Meaning{Accuracy::exact, "pass", "✓", "within what rounding makes of the engine's precision"},
    Meaning{Accuracy::within_tolerance, "shown", "≈",
            "off by more than rounding, but by less than would show"},
    Meaning{Accuracy::chaos, "unsupported", "~",
            "parted from the truth, by no more than the scene makes of the first rounding errors"},
    Meaning{Accuracy::systematic, "fail", "✗", "parted from the truth, and rounding does not explain it"},
};

const Meaning& meaning_of(Accuracy accuracy) {
  return *std::find_if(kMeanings.begin(), kMeanings.end(),
                       [&](const Meaning& each) { return each.accuracy == accuracy; });
}

void add_badge(Node parent, Accuracy accuracy) {
  const Meaning& meaning = meaning_of(accuracy);
  Node badge = add(parent, "span", {{"class", std::string("verdict ") + meaning.look}});
  add(badge, "span", {{"class", "mark"}, {"aria-hidden", "true"}}, meaning.glyph);
  say(badge, " " + std::string(name_of(accuracy)));
}

void add_accuracy_key(Node parent) {
  Node list = add(parent, "ul", {{"class", "key"}, {"aria-label", "Meaning of the words"}});
  for (const Meaning& meaning : kMeanings) {
    Node item = add(list, "li");
    add_badge(item, meaning.accuracy);
    say(item, std::string(" ") + meaning.meaning);
  }
}

bool has_judgement(const SceneComparison& scene) {
  return std::any_of(scene.runs.begin(), scene.runs.end(),
                     [](const RunComparison& run) { return run.judgement.has_value(); });
}

/// How many scenes each engine got how right.
void add_totals(Node parent, const Results& results, const Legend& legend) {
  std::vector<Heading> headings = {{"engine", ""}};
  for (const Meaning& meaning : kMeanings)
    headings.push_back({std::string(name_of(meaning.accuracy)), "number"});
  Node body =
      add_table(parent, "totals", "Scenes with a truth, by how right each engine is in them", headings);
  for (const std::string& label : legend.labels()) {
    std::array<std::size_t, kMeanings.size()> counts{};
    for (const SceneComparison& scene : results.scenes) {
      for (const RunComparison& run : scene.runs) {
        if (run.run.label() != label || !run.judgement) continue;
        ++counts[static_cast<std::size_t>(&meaning_of(run.judgement->accuracy) - kMeanings.data())];
      }
    }
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, label);
    for (const std::size_t count : counts) add_number(row, std::to_string(count));
  }
}

void add_accuracy_cell(Node row, const SceneComparison& scene, const std::string& label) {
  const auto run = std::find_if(scene.runs.begin(), scene.runs.end(),
                                [&](const RunComparison& each) { return each.run.label() == label; });
  if (run == scene.runs.end() || !run->judgement) {
    add(row, "td", {{"class", "cell absent"}},
        run == scene.runs.end() ? "not run" : std::string(name_of(run->run.status)));
    return;
  }
  const Meaning& meaning = meaning_of(run->judgement->accuracy);
  Node cell = add(row, "td", {{"class", std::string("cell ") + meaning.look}});
  Node link =
      add(cell, "a", {{"href", "#" + anchor_of(*scene.scene)}, {"title", departure(*scene.scene, *run)}});
  add_badge(link, run->judgement->accuracy);
  if (run->metrics[Metric::position]) {
    add(link, "span", {{"class", "value"}}, value_of(Metric::position, run->metrics[Metric::position]));
  }
}

void add_accuracy_matrix(Node parent, const Results& results, const Legend& legend) {
  std::vector<Heading> headings = {{"scene", ""}, {"truth", ""}};
  for (const std::string& label : legend.labels()) headings.push_back({label, ""});
  Node body = add_table(parent, "matrix", "How right each engine is, scene by scene", headings);
  for (const SceneComparison& scene : results.scenes) {
    if (!has_judgement(scene)) continue;
    Node row = add(body, "tr");
    Node name = add(row, "th", {{"scope", "row"}});
    add(name, "a", {{"href", "#" + anchor_of(*scene.scene)}}, scene.scene->title);
    add(row, "td", {}, scene.truth.kind);
    for (const std::string& label : legend.labels()) add_accuracy_cell(row, scene, label);
  }
}

std::string or_none(const std::optional<double>& value, const char* none) {
  return value ? number(*value) : none;
}

/// What it took to know the truth, and for how long it can be held against a run.
void add_truths(Node parent, const Results& results) {
  Node details = add_details(parent, "What each truth took, and until when it can be held against a run");
  Node body = add_table(details, "truths", "Truths that are not closed forms",
                        {{"scene", ""},
                         {"kind", ""},
                         {"digits", "number"},
                         {"CPU, s", "number"},
                         {"impacts", "number"},
                         {"sure to, m", "number"},
                         {"certified until, s", "number"},
                         {"λ, 1/s", "number"},
                         {"predictable until, s", "number"},
                         {"ties", "number"},
                         {"why not longer", ""}});
  for (const SceneComparison& scene : results.scenes) {
    const Truth& truth = scene.truth;
    if (!truth.known() || truth.kind == "closed-form") continue;
    Node row = add(body, "tr");
    Node name = add(row, "th", {{"scope", "row"}});
    add(name, "a", {{"href", "#" + anchor_of(*scene.scene)}}, scene.scene->id);
    add(row, "td", {}, truth.kind);
    add_number(row, truth.solution.digits > 0 ? std::to_string(truth.solution.digits) : "n/a");
    add_number(row, number(truth.cpu_seconds));
    add_number(row, std::to_string(truth.solution.impact_count));
    add_number(row, number(truth.uncertainty_m));
    add_number(row, or_none(truth.solution.known_until_s, "the end"));
    add_number(row, or_none(scene.predictability.growth_rate_per_s, "n/a"));
    add_number(row, or_none(scene.predictability.horizon_s, "the end"));
    add_number(row, std::to_string(truth.solution.ties.size()));
    add(row, "td", {}, truth.solution.limit);
  }
  if (!body.first_child()) parent.remove_child(details);
}

constexpr const char* kNote =
    "An error in a gas grows until nobody can follow it: from the moment at which the rounding of a double "
    "would be seen, positions are no longer compared, and the page marks that horizon; beyond it only "
    "statistics mean something. How much errors grow is measured on the truth itself, by a twin whose start "
    "is "
    "changed a little. Up to the horizon an engine that parts from the truth by more than that growth makes "
    "of "
    "its own rounding has another reason: a threshold, a step that finds impacts late, a wrong law. The "
    "tooltip "
    "of a cell says when and by which impact.";

}  // namespace

bool has_judgements(const Results& results) {
  return std::any_of(results.scenes.begin(), results.scenes.end(), has_judgement);
}

void add_accuracy(Node parent, const Results& results, const Legend& legend) {
  if (!has_judgements(results)) return;
  Node section = add(parent, "section", {{"id", "accuracy"}, {"aria-labelledby", "accuracy-title"}});
  add(section, "h2", {{"id", "accuracy-title"}}, "Against the truth: who is right");
  add(section, "p", {{"class", "note"}}, kNote);
  add_accuracy_key(section);
  add_totals(section, results, legend);
  add_accuracy_matrix(section, results, legend);
  add_truths(section, results);
}

}  // namespace carom::page
