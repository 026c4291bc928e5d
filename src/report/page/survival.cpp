#include "report/page/survival.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "comparison/overlap.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

constexpr std::string_view kGroup = "hard/";

// Who survives is asked of every engine alike, so these are as coarse as what an eye would miss, and far
// above what single precision or a late contact does: a hundredth of the energy and of the momentum, a tenth
// of a radius.
constexpr double kMostGain = 0.01;
constexpr double kMostMomentum = 0.01;
constexpr double kMostOverlap = 0.1;
/// A loss is no failure, for friction and late contacts lose too, but it is told.
constexpr double kLossTold = 0.01;

/// A criterion that a run does not meet.
struct Failure {
  double factor = 0.0;  ///< the value by its limit
  std::string words;
};

/// What stands in a cell: a verdict's look, one word or a few, and smaller lines below.
struct Outcome {
  Verdict look = Verdict::shown;
  std::string words;
  std::vector<std::string> details;
};

bool is_hard(const SceneComparison& scene) {
  return scene.scene->id.compare(0, kGroup.size(), kGroup) == 0;
}

std::string percent(double share) {
  return number(100.0 * share) + " %";
}

double overlap_at_start(const Scenario& scene) {
  std::vector<BallState> balls;
  for (const Ball& ball : scene.balls) balls.push_back({ball.position, ball.velocity, ball.spin});
  return deepest_overlap(scene, balls);
}

/// The highest that the energy comes to above what it was at the start, by that. Not the metric energy_gain,
/// which holds a run against the truth of the same moment: a bounce that loses energy and comes a step late
/// is no gain. Nothing where moving immovable balls may do work, as for the metric.
double highest_gain(const RunComparison& run) {
  double highest = 0.0;
  if (!run.metrics[Metric::energy_gain]) return highest;
  for (const double gain : run.series.energy) {
    if (gain > highest) highest = gain;  // false for what is not known, NaN
  }
  return highest;
}

/// Under gravity the momentum hangs on the account of what bears a resting ball, and an engine that lets it
/// sleep has none.
double momentum_error(const Scenario& scene, const Metrics& metrics) {
  return scene.effects.gravity ? 0.0 : metrics[Metric::momentum].value_or(0.0);
}

/// What the run fails in, the worst first. A metric that does not apply cannot be failed.
std::vector<Failure> failures(const Scenario& scene, const RunComparison& run) {
  const Metrics& metrics = run.metrics;
  std::vector<Failure> found;
  const auto judge = [&](double value, double limit, const std::string& words) {
    if (value > limit) found.push_back({value / limit, words});
  };
  const double outside = metrics[Metric::escaped].value_or(0.0);
  const double gain = highest_gain(run);
  const double momentum = momentum_error(scene, metrics);
  const double overlap = metrics[Metric::penetration].value_or(0.0);
  judge(outside, 0.0, number(outside) + " outside");
  judge(gain, kMostGain, "gains energy ×" + number(1.0 + gain));
  judge(momentum, kMostMomentum, "momentum off " + percent(momentum));
  judge(overlap - overlap_at_start(scene), kMostOverlap, "overlap " + percent(overlap));
  std::stable_sort(found.begin(), found.end(),
                   [](const Failure& a, const Failure& b) { return a.factor > b.factor; });
  return found;
}

/// Whether the run holds every limit that the scene sets for the engine under test.
bool is_right(const Gate& gate, const Metrics& metrics) {
  return !gate.under_test.empty() &&
         std::all_of(gate.under_test.begin(), gate.under_test.end(), [&](const auto& limit) {
           const std::optional<double>& value = metrics[limit.first];
           return value && *value <= limit.second;
         });
}

double smallest_radius(const Scenario& scene) {
  const auto smallest = std::min_element(scene.balls.begin(), scene.balls.end(),
                                         [](const Ball& a, const Ball& b) { return a.radius < b.radius; });
  return smallest->radius;
}

/// How far from right a run is that fails in nothing, in a few words or none.
std::vector<std::string> shortfall(const SceneComparison& scene, const Metrics& metrics) {
  const double loss = metrics[Metric::energy_loss].value_or(0.0);
  if (loss > kLossTold) return {"loses " + percent(loss) + " energy"};
  const double off_m = metrics[Metric::position].value_or(0.0);
  if (off_m <= scene.position_tolerance_m) return {};
  return {number(off_m / smallest_radius(*scene.scene)) + " radii off"};
}

Outcome outcome_of_recorded(const SceneComparison& scene, const RunComparison& run) {
  if (is_right(scene.scene->gate, run.metrics)) return {Verdict::pass, "right", {}};
  std::vector<Failure> failed = failures(*scene.scene, run);
  if (failed.empty()) return {Verdict::shown, "survives", shortfall(scene, run.metrics)};
  Outcome outcome{Verdict::fail, std::move(failed.front().words), {}};
  for (std::size_t i = 1; i < failed.size(); ++i) outcome.details.push_back(std::move(failed[i].words));
  return outcome;
}

Outcome outcome_of(const SceneComparison& scene, const RunComparison& run) {
  switch (run.run.status) {
    case RunStatus::ok:
      return outcome_of_recorded(scene, run);
    case RunStatus::unsupported:
      return {Verdict::unsupported, "cannot", {}};
    case RunStatus::crashed:
    case RunStatus::timeout:
      return {Verdict::error, std::string(name_of(run.run.status)), {}};
    case RunStatus::invalid:
      return {Verdict::error, "NaN", {}};
  }
  return {};
}

/// The numbers behind a cell, or why there are none.
std::string numbers(const Scenario& scene, const RunComparison& run) {
  if (run.run.status != RunStatus::ok) return sentence(run.run.reason);
  const Metrics& m = run.metrics;
  return fmt::format(
      "energy above the start {}, above the truth {}, below it {}; momentum off by {}; overlap {} of a "
      "radius, {} at the start; outside {}; "
      "off the truth by {}",
      number(highest_gain(run)), number(m[Metric::energy_gain]), number(m[Metric::energy_loss]),
      number(m[Metric::momentum]), number(m[Metric::penetration]), number(overlap_at_start(scene)),
      number(m[Metric::escaped]), value_of(Metric::position, m[Metric::position]));
}

const RunComparison* run_of(const SceneComparison& scene, const std::string& label) {
  for (const RunComparison& run : scene.runs) {
    if (run.run.label() == label) return &run;
  }
  return nullptr;
}

void add_cell(Node row, const SceneComparison& scene, const RunComparison* run) {
  if (run == nullptr) {
    add(row, "td", {{"class", "cell absent"}}, "not run");
    return;
  }
  const Outcome outcome = outcome_of(scene, *run);
  const std::string look(name_of(outcome.look));
  Node cell = add(row, "td", {{"class", "cell " + look}});
  Node link =
      add(cell, "a", {{"href", "#" + anchor_of(*scene.scene)}, {"title", numbers(*scene.scene, *run)}});
  Node words = add(link, "span", {{"class", "verdict " + look}});
  add(words, "span", {{"class", "mark"}, {"aria-hidden", "true"}}, std::string(glyph_of(outcome.look)));
  say(words, " " + outcome.words);
  for (const std::string& detail : outcome.details) add(link, "span", {{"class", "value"}}, detail);
}

/// The runs of hard scenes, in the order of the page.
std::vector<std::string> columns_of(const Results& results, const Legend& legend) {
  std::vector<std::string> columns;
  for (const std::string& label : legend.labels()) {
    const bool takes_part = std::any_of(
        results.scenes.begin(), results.scenes.end(),
        [&](const SceneComparison& scene) { return is_hard(scene) && run_of(scene, label) != nullptr; });
    if (takes_part) columns.push_back(label);
  }
  return columns;
}

void add_outcomes(Node parent, const Results& results, const Legend& legend) {
  const std::vector<std::string> columns = columns_of(results, legend);
  std::vector<Heading> headings = {{"scene", ""}};
  for (const std::string& label : columns) headings.push_back({label, ""});
  Node body = add_table(parent, "matrix", "Who survives what", headings);
  for (const SceneComparison& scene : results.scenes) {
    if (!is_hard(scene)) continue;
    Node row = add(body, "tr");
    Node name = add(row, "th", {{"scope", "row"}});
    add(name, "a", {{"href", "#" + anchor_of(*scene.scene)}}, scene.scene->title);
    for (const std::string& label : columns) add_cell(row, scene, run_of(scene, label));
  }
}

std::string criteria() {
  return fmt::format(
      "Right: the run holds every limit that the scene sets for the engine under test. Survives: it does "
      "not, "
      "but it ends by itself with finite numbers, never has {} more energy than at the start, keeps the "
      "momentum within {} (not asked under gravity, where it hangs on the account of what bears a resting "
      "ball), overlaps less than {} of a radius beyond what the scene starts with, and leaves nobody outside "
      "the walls. These limits are the same for every engine, and coarse enough for single precision; a "
      "second "
      "line says how far from right the run is all the same. Otherwise the cell says what failed, the worst "
      "first: ×1.43 is the highest energy by that at the start. The numbers behind a cell are in its tooltip "
      "and in the chapter of the scene.",
      percent(kMostGain), percent(kMostMomentum), percent(kMostOverlap));
}

}  // namespace

bool has_hard_cases(const Results& results) {
  return std::any_of(results.scenes.begin(), results.scenes.end(), is_hard);
}

void add_survival(Node parent, const Results& results, const Legend& legend) {
  if (!has_hard_cases(results)) return;
  Node section = add(parent, "section", {{"id", "survival"}, {"aria-labelledby", "survival-title"}});
  add(section, "h2", {{"id", "survival-title"}}, "Hard cases: who survives what");
  add_outcomes(section, results, legend);
  add(section, "p", {{"class", "note"}}, criteria());
}

}  // namespace carom::page
