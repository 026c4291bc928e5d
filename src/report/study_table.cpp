#include "report/study_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/study_words.h"
#include "report/words.h"

namespace carom {

namespace {

constexpr int kNameWidth = 27;
constexpr int kTimeWidth = 7;

/// To the right of a column; every letter of ours is one column wide.
std::string padded(const std::string& text, int width) {
  return fmt::format("{:>{}}", text, width);
}

std::vector<Mark> marks_of_series(const std::vector<Mark>& marks, const Series& series) {
  std::vector<Mark> own;
  for (const Mark& mark : marks) {
    if (std::find(series.points.begin(), series.points.end(), mark.point) != series.points.end()) {
      own.push_back(mark);
    }
  }
  return own;
}

/// Why nothing came of a series: the reason of its first run that did not end well.
std::string failure_of(const StudyScene& scene, const Series& series) {
  for (const std::size_t i : series.points) {
    const StudyPoint& point = scene.points[i];
    if (!point.status) return "not run yet";
    if (*point.status != RunStatus::ok) return fmt::format("{}: {}", name_of(*point.status), point.reason);
    if (!point.untimed.empty()) return point.untimed;
    if (point.cpu_s.empty()) return "not timed yet";
  }
  return "its error is not known";
}

/// A factor in five letters.
std::string price_words(double factor) {
  if (factor >= 9999.5) return ">9999";
  return fmt::format("{:.{}f}", factor, factor < 99.95 ? 1 : 0);
}

std::string series_row(const StudyScene& scene, const Series& series, const std::vector<Mark>& marks) {
  const std::vector<Mark> own = marks_of_series(marks, series);
  if (own.empty()) return wrapped("  " + words_of(series) + ": ", failure_of(scene, series));
  const Order order = order_of(scene, series);
  const auto best = std::min_element(own.begin(), own.end(),
                                     [](const Mark& a, const Mark& b) { return a.error < b.error; });
  const std::optional<double> price = price_of_digit(scene, series);
  // A setting stands below its engine.
  const std::string name = series.setting.empty() ? "  " + series.engine : "    " + series.setting;
  std::string text = fmt::format("{:<{}}", name, kNameWidth);
  text += padded(words_of(order), 9);
  text += padded(fmt::format("{:.1e}", best->error), 9);
  text += padded(price ? price_words(*price) : "–", 6);
  for (const double tolerance : kTolerances) {
    const std::optional<Mark> mark = cheapest(own, tolerance);
    text += padded(mark ? time_words(mark->cpu_s.median) : "–", kTimeWidth);
  }
  return text + "\n";
}

std::string truth_row(const StudyScene& scene) {
  if (scene.truth == "none") {
    return wrapped("  truth: ", fmt::format("none, {}; errors are those of the energy", scene.no_truth));
  }
  std::string text = fmt::format("{}, known to {:.1g} m", scene.truth, scene.uncertainty_m);
  if (scene.horizon_s) text += fmt::format(" until t = {} s", short_number(scene.horizon_s));
  return wrapped("  truth: ", text);
}

/// Who is the cheapest of all for each tolerance.
std::string cheapest_rows(const StudyScene& scene, const std::vector<Mark>& marks) {
  std::string text;
  for (const double tolerance : kTolerances) {
    const std::optional<Mark> mark = cheapest(marks, tolerance);
    const std::string heading = fmt::format("  cheapest for {:g} {}: ", tolerance, unit_of(scene));
    text += wrapped(heading, mark ? fmt::format("{}, {}", words_of(scene, scene.points[mark->point]),
                                                time_words(mark->cpu_s.median))
                                  : "none is as good");
  }
  return text;
}

std::string lead_rows(const StudyScene& scene, const std::string& own) {
  if (!takes_part(scene, own)) return {};
  const std::vector<Lead> leads = leads_over(scene, own);
  if (leads.empty()) {
    return wrapped("  ", fmt::format("{}'s front lies at or below every peer's: none is better for the same "
                                     "time",
                                     own));
  }
  std::string text;
  for (const Lead& lead : leads) text += wrapped("  ahead: ", words_of(scene, own, lead));
  return text;
}

std::string scene_table(const StudyScene& scene, const std::string& own) {
  const std::vector<Mark> marks = marks_of(scene);
  std::string text = fmt::format("{}: {}\n{}", scene.id, scene.title, truth_row(scene));
  text += fmt::format("{:<{}}{:>9}{:>9}{:>6}{:>28}\n", "  engine", kNameWidth, "order", "best", "digit",
                      "CPU time for an error of");
  text += fmt::format("{:<{}}{:>9}{:>9}{:>6}", "", kNameWidth, "", unit_of(scene), "×");
  for (const double tolerance : kTolerances) text += fmt::format("{:>{}.0e}", tolerance, kTimeWidth);
  text += "\n";
  for (const Series& series : series_of(scene)) {
    const bool single = !scene.points[series.points.front()].everywhere;
    if (!single) text += series_row(scene, series, marks);
  }
  return text + cheapest_rows(scene, marks) + lead_rows(scene, own) + "\n";
}

/// Scenes against families: the error at equal cost and the cost at equal error.
std::string overview_table(const Study& study) {
  std::string text = "At equal cost, at equal error\n";
  for (const StudyScene& scene : study.scenes) {
    const std::optional<Comparison> row = compare_families(scene);
    if (!row) continue;
    text += fmt::format("  {}: errors within {}, times for {} {}\n", scene.id, time_words(row->cost_s),
                        short_number(row->error), unit_of(scene));
    for (const Comparison::Entry& entry : row->entries) {
      const std::string time = entry.cost_at_error_s ? time_words(*entry.cost_at_error_s) : "–";
      text += fmt::format("    {:<20}{:>12} {:<9}{:>12}\n", entry.family, short_number(entry.error_at_cost),
                          entry.error_at_cost ? unit_of(scene) : "", time);
    }
  }
  return text;
}

std::string growth_table(const Study& study) {
  if (study.growths.empty()) return {};
  std::string text = fmt::format(
      "\nNanoseconds per ball and step, gas of so many balls; cost ~ balls^x\n  {:<22}", "engine");
  for (const GrowthPoint& point : study.growths.front().points) {
    text += fmt::format("{:>9.0e}", static_cast<double>(point.balls));
  }
  text += fmt::format("{:>8}\n", "x");
  for (const StudyGrowth& growth : study.growths) {
    if (!was_timed(growth)) continue;
    text += fmt::format("  {:<22}", fmt::format("{}, {}D", growth.engine, growth.dimension));
    for (const GrowthPoint& point : growth.points) {
      const std::optional<double> ns = per_ball_and_step_ns(point);
      text += padded(ns ? fmt::format("{:.3g}", *ns) : "–", 9);
    }
    const std::optional<Growth> fit = growth_of(growth);
    text += padded(fit ? fmt::format("{:.2f}", fit->exponent) : "–", 8) + "\n";
  }
  return text;
}

}  // namespace

std::string study_table(const Study& study) {
  std::string text;
  for (const StudyScene& scene : study.scenes) text += scene_table(scene, study.own);
  return text + overview_table(study) + growth_table(study);
}

}  // namespace carom
