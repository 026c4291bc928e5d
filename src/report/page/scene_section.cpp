#include "report/page/scene_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/page/energy_causes.h"
#include "report/page/overview.h"
#include "report/page/paths.h"
#include "report/page/player.h"
#include "report/page/plots.h"
#include "report/page/statistics.h"
#include "report/page/wording.h"
#include "scenario/features.h"

namespace carom::page {

namespace {

void add_fact(Node list, const std::string& name, const std::string& fact) {
  Node pair = add(list, "div");
  add(pair, "dt", {}, name);
  add(pair, "dd", {}, fact);
}

std::string describe(const Contact& contact) {
  std::string text = "e = " + given(contact.restitution);
  if (contact.friction > 0.0) {
    text += ", μ = " + given(contact.friction) + ", β₀ = " + given(contact.tangential_restitution);
  }
  return text;
}

std::string describe(const Truth& truth) {
  if (!truth.known()) return "none" + (truth.reason.empty() ? "" : ": " + truth.reason);
  std::string text = truth.kind;
  if (truth.uncertainty_m > 0.0) text += fmt::format(", sure to {} m", number(truth.uncertainty_m));
  if (truth.solution.digits > 0) text += fmt::format(", certified with {} digits", truth.solution.digits);
  if (truth.solution.known_until_s) {
    text += fmt::format(", known until t = {} s: {}", number(*truth.solution.known_until_s),
                        truth.solution.limit);
  }
  if (truth.horizon_s) text += fmt::format("; positions compared until t = {} s", number(*truth.horizon_s));
  return text;
}

/// The steps that the engines took, where they agree on a number.
std::string describe_step(const SceneComparison& scene) {
  std::string text = "at most " + given(scene.scene->step_s) + " s";
  for (const RunComparison& run : scene.runs) {
    if (run.run.status == RunStatus::ok)
      return fmt::format("{}, {}", text, count_of(static_cast<std::size_t>(run.run.steps), "step"));
  }
  return text;
}

void add_facts(Node parent, const SceneComparison& comparison) {
  const Scenario& scene = *comparison.scene;
  std::vector<std::string> effects;
  for (const Feature feature : required_features(scene)) {
    if (feature != Feature::plane && feature != Feature::space) effects.emplace_back(name_of(feature));
  }
  Node list = add(parent, "dl", {{"class", "facts"}});
  add_fact(list, "dimension", scene.dimension == 2 ? "2D" : "3D");
  add_fact(list, "duration", given(scene.duration_s) + " s");
  add_fact(list, "step", describe_step(comparison));
  add_fact(list, "balls", std::to_string(scene.balls.size()));
  add_fact(list, "effects", effects.empty() ? "none" : list_of(effects));
  if (scene.effects.collisions && scene.balls.size() > 1)
    add_fact(list, "ball on ball", describe(scene.ball_contact));
  if (!scene.walls.empty()) add_fact(list, "ball on wall", describe(scene.wall_contact));
  add_fact(list, "truth", describe(comparison.truth));
}

void add_notes(Node parent, const Scenario& scene) {
  if (scene.notes.empty()) return;
  Node list = add(parent, "ul", {{"class", "note"}});
  for (const std::string& note : scene.notes) add(list, "li", {}, note);
}

/// Every engine with its line and its verdict: the legend of the plots, and the reasons of those that have
/// none.
void add_engine_list(Node parent, const SceneComparison& scene, const Legend& legend) {
  Node list = add(parent, "ul", {{"class", "engines"}, {"aria-label", "Engines and their verdicts"}});
  for (const RunComparison& run : scene.runs) {
    Node item = add(list, "li", {{"class", run.run.reason.empty() ? "" : "with-reason"}});
    legend.add_swatch(item, run.run.label());
    add(item, "span", {{"class", "name"}}, run.run.label());
    add_verdict(item, run.verdict);
    if (run.run.status == RunStatus::ok) continue;
    const bool says_more = run.run.status != RunStatus::unsupported;
    add(item, "span", {{"class", "reason"}},
        (says_more ? std::string(name_of(run.run.status)) + ": " : "") + run.run.reason);
  }
}

bool breaks_gate(const RunComparison& run, Metric metric) {
  return std::any_of(run.gates.begin(), run.gates.end(),
                     [&](const GateResult& gate) { return gate.metric == metric && !gate.holds; });
}

std::string accuracy_of(const RunComparison& run) {
  return run.judgement ? std::string(name_of(run.judgement->accuracy)) : "n/a";
}

/// The columns of the table: symmetries are measured only where a scene asks for them.
std::vector<Metric> metrics_of(const Scenario& scene) {
  std::vector<Metric> metrics;
  for (std::size_t i = 0; i < kMetricNames.size(); ++i) {
    const auto metric = static_cast<Metric>(i);
    if (metric != Metric::symmetry || !scene.symmetries.empty()) metrics.push_back(metric);
  }
  return metrics;
}

std::string impacts_of(const Run& run) {
  if (run.trajectory.frames() == 0) return "n/a";
  return std::to_string(run.trajectory.tally(run.trajectory.frames() - 1).impacts);
}

void add_metric_cell(Node row, const RunComparison& run, Metric metric) {
  const bool broken = breaks_gate(run, metric);
  Node cell = add(row, "td", {{"class", broken ? "number broken" : "number"}});
  say(cell, (broken ? "✗ " : "") + number(run.metrics[metric]));
}

void add_metrics(Node parent, const SceneComparison& scene) {
  std::vector<Heading> headings = {{"engine", ""}};
  for (const Metric metric : metrics_of(*scene.scene)) {
    const bool length = metric == Metric::position || metric == Metric::position_rms;
    const char* unit = length                       ? ", m"
                       : metric == Metric::escaped  ? ", balls"
                       : metric == Metric::symmetry ? ", radii"
                                                    : "";
    headings.push_back({title_of(metric) + unit, "number"});
  }
  headings.insert(headings.end(),
                  {{"impacts", "number"}, {"against the truth", ""}, {"first divergence", ""}});
  add(parent, "h3", {}, "Measured");
  Node body =
      add_table(parent, "measured",
                "The largest deviation of each run; what has no unit is a share of its scale", headings);
  for (const RunComparison& run : scene.runs) {
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, run.run.label());
    if (run.run.status != RunStatus::ok) {
      add(row, "td", {{"class", "reason"}, {"colspan", std::to_string(headings.size() - 1)}},
          std::string(name_of(run.run.status)) + ": " + run.run.reason);
      continue;
    }
    for (const Metric metric : metrics_of(*scene.scene)) add_metric_cell(row, run, metric);
    add(row, "td", {{"class", "number"}}, impacts_of(run.run));
    add(row, "td", {}, accuracy_of(run));
    add(row, "td", {{"class", "divergence"}},
        scene.truth.known() ? page::describe(run.first_divergence) : "n/a");
  }
  if (!scene.truth.known() || scene.position_tolerance_m <= 0.0) return;
  add(parent, "p", {{"class", "note"}},
      fmt::format(
          "A run has diverged where a ball is more than {} m from the truth, or where energy or momentum "
          "clearly differ from it.",
          number(scene.position_tolerance_m)));
}

void add_gates(Node parent, const SceneComparison& scene) {
  const bool any = std::any_of(scene.runs.begin(), scene.runs.end(),
                               [](const RunComparison& run) { return !run.gates.empty(); });
  if (!any) return;
  add(parent, "h3", {}, "Gates");
  Node body =
      add_table(parent, "gates", "Limits that must hold",
                {{"engine", ""}, {"metric", ""}, {"limit", "number"}, {"value", "number"}, {"holds", ""}});
  for (const RunComparison& run : scene.runs) {
    for (const GateResult& gate : run.gates) {
      Node row = add(body, "tr");
      add(row, "th", {{"scope", "row"}}, run.run.label());
      add(row, "td", {}, title_of(gate.metric));
      add(row, "td", {{"class", "number"}}, "≤ " + given(gate.limit));
      add(row, "td", {{"class", "number"}}, value_of(gate.metric, gate.value));
      add(row, "td", {{"class", gate.holds ? "holds" : "broken"}}, gate.holds ? "✓ yes" : "✗ no");
    }
  }
}

void add_pairs(Node parent, const SceneComparison& scene) {
  if (scene.pairs.empty()) return;
  Node details = add_details(parent, "Every pair of engines against each other");
  Node body = add_table(details, "pairs", "The largest differences between two runs",
                        {{"engine", ""},
                         {"engine", ""},
                         {"position, m", "number"},
                         {"position rms, m", "number"},
                         {"energy", "number"},
                         {"momentum", "number"},
                         {"first divergence", ""}});
  for (const PairComparison& pair : scene.pairs) {
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, scene.runs[pair.a].run.label());
    add(row, "td", {}, scene.runs[pair.b].run.label());
    for (const std::optional<double>& value :
         {std::optional(pair.position_m), std::optional(pair.position_rms_m), pair.energy, pair.momentum}) {
      add(row, "td", {{"class", "number"}}, number(value));
    }
    add(row, "td", {{"class", "divergence"}}, page::describe(pair.first_divergence));
  }
}

void add_settings(Node parent, const SceneComparison& scene) {
  Node details = add_details(parent, "The settings that every engine ran with");
  for (const RunComparison& run : scene.runs) {
    if (run.run.settings.empty()) continue;
    add(details, "h4", {}, run.run.label());
    Node list = add(details, "dl", {{"class", "settings"}});
    for (const auto& [name, value] : run.run.settings) add_fact(list, name, given(value));
  }
  if (!details.child("dl")) parent.remove_child(details);
}

}  // namespace

void add_scene(Node parent, const SceneComparison& scene, const Legend& legend, bool plays) {
  const std::string anchor = anchor_of(*scene.scene);
  const std::string title_id = anchor + "-title";
  Node section = add(parent, "section", {{"class", "scene"}, {"id", anchor}, {"aria-labelledby", title_id}});
  add(section, "h2", {{"id", title_id}}, scene.scene->title);
  Node line = add(section, "p", {{"class", "id"}});
  add(line, "code", {}, scene.scene->id);
  say(line, " · ");
  add(line, "a", {{"href", "#overview"}}, "all scenes");
  Node about = add(section, "div", {{"class", "about"}});
  add_markdown(about, scene.scene->about, 2);
  if (!about.first_child()) section.remove_child(about);
  add_facts(section, scene);
  add_notes(section, *scene.scene);
  add_engine_list(section, scene, legend);
  if (plays) add_player(section, scene);
  add_paths(section, scene, legend);
  add_plots(section, scene, legend);
  add_metrics(section, scene);
  add_statistics(section, scene, legend);
  add_energy_causes(section, scene, legend);
  add_gates(section, scene);
  add_pairs(section, scene);
  add_settings(section, scene);
}

}  // namespace carom::page
