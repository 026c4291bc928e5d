#include "report/page/study_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/page/study_plot.h"
#include "report/page/wording.h"
#include "report/study_words.h"
#include "study/analyse.h"

namespace carom::page {

namespace {

std::string truth_of(const StudyScene& scene) {
  if (scene.truth == "none") {
    return fmt::format("There is no truth ({}); errors are those of the energy.", scene.no_truth);
  }
  const std::string until =
      scene.horizon_s ? fmt::format("up to its horizon at {} s", number(scene.horizon_s)) : "throughout";
  return fmt::format("The truth is {}, known to {} m; errors are measured against it {}.", scene.truth,
                     number(scene.uncertainty_m), until);
}

/// "413 ns (410 – 428)": the median, and the quartiles where there is more than one run.
std::string spread_words(const Spread& spread) {
  return fmt::format("{} ({} – {})", time_words(spread.median), time_words(spread.lower_quartile),
                     time_words(spread.upper_quartile));
}

void add_leads(Node parent, const StudyScene& scene, const std::string& own) {
  if (!takes_part(scene, own)) return;
  const std::vector<Lead> leads = leads_over(scene, own);
  if (leads.empty()) {
    add(parent, "p", {{"class", "about"}},
        fmt::format("The front of {} lies at or below every peer's: no engine gives a smaller error for the "
                    "same time.",
                    own));
    return;
  }
  add(parent, "p", {{"class", "about"}}, fmt::format("Where a peer is ahead of {}:", own));
  Node list = add(parent, "ul", {{"class", "violations"}});
  for (const Lead& lead : leads) add(list, "li", {}, words_of(scene, own, lead));
}

void add_cheapest(Node parent, const StudyScene& scene, const std::vector<carom::Mark>& marks) {
  Node body = add_table(parent, "gates", "The cheapest setting of all for an error of at most …",
                        {{unit_of(scene), "number"},
                         {"setting", ""},
                         {"CPU time (quartiles)", "number"},
                         {"error", "number"},
                         {"a digit more than the line above: time ×", "number"}});
  std::optional<carom::Mark> above;
  for (const double tolerance : kTolerances) {
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, given(tolerance));
    const std::optional<carom::Mark> mark = cheapest(marks, tolerance);
    add(row, "td", {}, mark ? words_of(scene, scene.points[mark->point]) : "none is as good");
    add_number(row, mark ? spread_words(mark->cpu_s) : "–");
    add_number(row, mark ? number(mark->error) : "–");
    const bool priced = mark && above;
    add_number(row,
               priced ? number(std::pow(mark->cpu_s.median / above->cpu_s.median, 1.0 / kDigitsApart)) : "–");
    above = mark;
  }
}

/// The least value of what a run costs among those of a series that were timed.
std::optional<double> least(const StudyScene& scene, const Series& series,
                            std::optional<double> Cost::*what) {
  std::optional<double> result;
  for (const std::size_t i : series.points) {
    if (scene.points[i].cpu_s.empty()) continue;
    const std::optional<double> value = cost_of(scene, scene.points[i]).*what;
    if (value && (!result || *value < *result)) result = value;
  }
  return result;
}

std::optional<double> best_error(const std::vector<carom::Mark>& marks, const Series& series) {
  std::optional<double> best;
  for (const carom::Mark& mark : marks) {
    const bool own = std::find(series.points.begin(), series.points.end(), mark.point) != series.points.end();
    if (own && (!best || mark.error < *best)) best = mark.error;
  }
  return best;
}

void add_series(Node parent, const StudyScene& scene, const std::vector<carom::Mark>& marks,
                const Legend& legend) {
  Node body = add_table(parent, "measured", "How errors fall with the step, and what that costs",
                        {{"engine and setting", ""},
                         {"p claimed", "number"},
                         {"p fitted", "number"},
                         {"R²", "number"},
                         {"runs in the fit", "number"},
                         {"best error", "number"},
                         {"a digit more: time ×", "number"},
                         {"ns per ball and step, at best", "number"},
                         {"ns per impact, at best", "number"}});
  for (const Series& series : series_of(scene)) {
    if (!scene.points[series.points.front()].everywhere) continue;
    const Order order = order_of(scene, series);
    const bool fitted = order.kind == Order::Kind::fitted;
    Node row = add(body, "tr");
    Node name = add(row, "th", {{"scope", "row"}});
    legend.add_swatch(name, series.engine);
    say(name, " " + words_of(series));
    add_number(row, claim_of(scene, series.engine));
    add_number(row, words_of(order));
    add_number(row, fitted ? fmt::format("{:.4f}", order.r_squared) : "–");
    add_number(row, fmt::format("{} of {}", order.used, series.points.size()));
    add_number(row, number(best_error(marks, series)));
    const std::optional<double> price = price_of_digit(scene, series);
    add_number(row, price ? number(*price) : "–");
    add_number(row, number(least(scene, series, &Cost::per_ball_and_step_ns)));
    add_number(row, number(least(scene, series, &Cost::per_impact_ns)));
  }
}

void add_point(Node body, const StudyScene& scene, const StudyPoint& point, bool on_front) {
  Node row = add(body, "tr");
  add(row, "th", {{"scope", "row"}}, words_of(scene, point));
  if (point.status != RunStatus::ok) {
    const std::string status = point.status ? std::string(name_of(*point.status)) : "not run yet";
    add(row, "td", {{"colspan", "9"}, {"class", "reason"}}, status + ": " + point.reason);
    return;
  }
  const StudyErrors& errors = point.errors;
  add_number(row, point.cpu_s.empty() ? "untimed: " + point.untimed : spread_words(spread_of(point.cpu_s)));
  add_number(row, point.cpu_s.empty() ? "–" : time_words(spread_of(point.cpu_s).least));
  for (const std::optional<double>& error :
       {errors.position_m, errors.final_position_m, errors.energy, errors.momentum, errors.angular_momentum,
        errors.impact_time_s}) {
    add_number(row, number(error));
  }
  add_number(row, on_front ? "●" : "");
}

void add_points(Node parent, const StudyScene& scene, const std::vector<carom::Mark>& marks) {
  Node box = add_details(parent, fmt::format("Every run of {}", scene.id));
  Node body = add_table(box, "measured", "Every run, coarse steps first",
                        {{"engine, setting and step", ""},
                         {"CPU time (quartiles)", "number"},
                         {"its least", "number"},
                         {"position, m", "number"},
                         {"final position, m", "number"},
                         {"energy", "number"},
                         {"momentum", "number"},
                         {"angular momentum", "number"},
                         {"impact time, s", "number"},
                         {"on the front", "number"}});
  const std::vector<carom::Mark> front = front_of(marks);
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const bool on_front =
        std::any_of(front.begin(), front.end(), [i](const carom::Mark& mark) { return mark.point == i; });
    add_point(body, scene, scene.points[i], on_front);
  }
}

}  // namespace

std::string study_anchor(const StudyScene& scene) {
  std::string anchor = "study-" + scene.id;
  std::replace(anchor.begin(), anchor.end(), '/', '-');
  return anchor;
}

void add_study_scene(Node parent, const StudyScene& scene, const std::string& own, const Legend& legend) {
  add(parent, "h3", {{"id", study_anchor(scene)}}, scene.title);
  add(parent, "p", {{"class", "id"}},
      fmt::format("{}. {} in dimension {} for {} s. {}", scene.id, count_of(scene.balls, "ball"),
                  scene.dimension, given(scene.duration_s), truth_of(scene)));
  const std::vector<carom::Mark> marks = marks_of(scene);
  if (!marks.empty()) {
    add_work_precision(parent, scene, legend);
    add_leads(parent, scene, own);
    add_cheapest(parent, scene, marks);
  }
  add_series(parent, scene, marks, legend);
  add_points(parent, scene, marks);
}

}  // namespace carom::page
