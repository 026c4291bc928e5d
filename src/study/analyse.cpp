#include "study/analyse.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "core/least_squares.h"

namespace carom {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kFloorsToTell = 2.0;
constexpr double kTimesRounding = 4.0;
constexpr double kSaturation = 0.1;
constexpr std::size_t kFewestBallCounts = 3;

std::optional<double> error_of(const StudyPoint& point, StudyMeasure measure) {
  if (point.status != RunStatus::ok) return std::nullopt;
  return measure == StudyMeasure::position_m ? point.errors.position_m : point.errors.energy;
}

/// Faster, then better, then as they came.
bool comes_first(const Mark& a, const Mark& b) {
  if (a.cpu_s.median != b.cpu_s.median) return a.cpu_s.median < b.cpu_s.median;
  if (a.error != b.error) return a.error < b.error;
  return a.point < b.point;
}

/// The errors of a series that can be fitted, coarse steps first.
std::vector<ErrorAtStep> fittable(const std::vector<ErrorAtStep>& errors, double floor, double saturation) {
  std::vector<ErrorAtStep> used;
  if (errors.empty()) return used;
  const auto least =
      std::min_element(errors.begin(), errors.end(),
                       [](const ErrorAtStep& a, const ErrorAtStep& b) { return a.error < b.error; });
  // Where the first, at the coarsest step, is the least, errors grow as steps get shorter: that is a finding.
  const bool stops_falling = least != std::prev(errors.end()) && least != errors.begin();
  const auto end = stops_falling ? least : errors.end();
  for (auto each = errors.begin(); each != end; ++each) {
    const bool told = each->error > kFloorsToTell * floor && each->error < saturation;
    if (told && (!stops_falling || each->error >= kTimesRounding * least->error)) used.push_back(*each);
  }
  return used;
}

std::vector<ErrorAtStep> errors_of(const StudyScene& scene, const Series& series) {
  const StudyMeasure measure = measure_of(scene);
  std::vector<ErrorAtStep> errors;
  for (const std::size_t i : series.points) {
    const StudyPoint& point = scene.points[i];
    const std::optional<double> error = error_of(point, measure);
    if (!error) continue;
    // A relative energy takes a rounding of each velocity per step.
    const double rounding =
        measure == StudyMeasure::position_m ? point.rounding_m : kEpsilon * static_cast<double>(point.steps);
    errors.push_back({point.step_s, *error, rounding});
  }
  return errors;
}

/// What a step decides ends where errors are a tenth of all that happens: of the way that a ball goes, or of
/// the energy that there is.
double saturation_of(const StudyScene& scene) {
  return kSaturation * (measure_of(scene) == StudyMeasure::position_m ? scene.reach_m : 1.0);
}

/// What rounding alone may make of the run with the fewest roundings: no run can count on being better.
double least_rounding_of(const StudyScene& scene) {
  if (measure_of(scene) == StudyMeasure::energy) return kEpsilon;
  double least_m = std::numeric_limits<double>::infinity();
  for (const StudyPoint& point : scene.points) {
    if (point.rounding_m > 0.0) least_m = std::min(least_m, point.rounding_m);
  }
  return std::isfinite(least_m) ? least_m : floor_of(scene);
}

/// Whether the peer is neither better nor faster, by more than can be told.
bool is_matched(const Mark& peer, const Mark& own, double rounding) {
  return own.error <= std::max(peer.error, rounding) && own.cpu_s.lower_quartile <= peer.cpu_s.upper_quartile;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return {values.front(), at(0.25), at(0.5), at(0.75)};
}

StudyMeasure measure_of(const StudyScene& scene) {
  return scene.truth == "none" ? StudyMeasure::energy : StudyMeasure::position_m;
}

double floor_of(const StudyScene& scene) {
  if (measure_of(scene) == StudyMeasure::energy) return kEpsilon;
  return std::max(scene.uncertainty_m, kEpsilon * scene.smallest_radius_m);
}

std::vector<Mark> marks_of(const StudyScene& scene) {
  const StudyMeasure measure = measure_of(scene);
  const double floor = floor_of(scene);
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const std::optional<double> error = error_of(scene.points[i], measure);
    if (!error || !std::isfinite(*error) || scene.points[i].cpu_s.empty()) continue;
    marks.push_back({i, std::max(*error, floor), spread_of(scene.points[i].cpu_s)});
  }
  return marks;
}

std::vector<Mark> front_of(std::vector<Mark> marks) {
  std::sort(marks.begin(), marks.end(), comes_first);
  std::vector<Mark> front;
  for (const Mark& mark : marks) {
    if (front.empty() || mark.error < front.back().error) front.push_back(mark);
  }
  return front;
}

std::string family_of(const std::string& label) {
  const std::size_t colon = label.find(':');
  if (colon == std::string::npos) return label;
  const std::size_t profile = label.find('@', colon);
  return label.substr(0, colon) + (profile == std::string::npos ? "" : label.substr(profile));
}

std::vector<std::string> families_of(const StudyScene& scene) {
  std::vector<std::string> families;
  for (const StudyEngine& engine : scene.engines) {
    const std::string family = family_of(engine.label);
    if (std::find(families.begin(), families.end(), family) == families.end()) families.push_back(family);
  }
  return families;
}

std::vector<Mark> marks_of_family(const StudyScene& scene, const std::vector<Mark>& marks,
                                  const std::string& family) {
  std::vector<Mark> own;
  std::copy_if(marks.begin(), marks.end(), std::back_inserter(own),
               [&](const Mark& mark) { return family_of(scene.points[mark.point].engine) == family; });
  return own;
}

std::optional<Mark> cheapest(const std::vector<Mark>& marks, double tolerance) {
  std::optional<Mark> best;
  for (const Mark& mark : marks) {
    if (mark.error <= tolerance && (!best || comes_first(mark, *best))) best = mark;
  }
  return best;
}

std::optional<Mark> best_within(const std::vector<Mark>& marks, double cpu_s) {
  std::optional<Mark> best;
  for (const Mark& mark : marks) {
    if (mark.cpu_s.median <= cpu_s && (!best || mark.error < best->error)) best = mark;
  }
  return best;
}

std::vector<Series> series_of(const StudyScene& scene) {
  std::vector<Series> all;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const StudyPoint& point = scene.points[i];
    const auto known = std::find_if(all.begin(), all.end(), [&](const Series& each) {
      return each.engine == point.engine && each.setting == point.setting;
    });
    if (known == all.end()) {
      all.push_back({point.engine, point.setting, {i}});
    } else {
      known->points.push_back(i);
    }
  }
  return all;
}

Order fit_order(const std::vector<ErrorAtStep>& errors, double floor, double saturation) {
  Order result;
  const bool is_rounding = std::all_of(errors.begin(), errors.end(), [&](const ErrorAtStep& each) {
    return each.error <= std::max(each.rounding, floor);
  });
  if (!errors.empty() && is_rounding) {
    result.kind = Order::Kind::rounding;
    return result;
  }
  std::vector<double> log_step;
  std::vector<double> log_error;
  for (const ErrorAtStep& each : fittable(errors, floor, saturation)) {
    log_step.push_back(std::log(each.step_s));
    log_error.push_back(std::log(each.error));
  }
  result.used = log_step.size();
  const bool same =
      std::adjacent_find(log_error.begin(), log_error.end(), std::not_equal_to<>()) == log_error.end();
  if (result.used < kFewestToFit || same) return result;
  const FittedLine line = line_through(log_step, log_error);
  result.kind = Order::Kind::fitted;
  result.order = line.slope;
  result.r_squared = line.r_squared;
  return result;
}

Order order_of(const StudyScene& scene, const Series& series) {
  return fit_order(errors_of(scene, series), floor_of(scene), saturation_of(scene));
}

std::optional<double> price_of_digit(const StudyScene& scene, const Series& series) {
  const std::vector<ErrorAtStep> used =
      fittable(errors_of(scene, series), floor_of(scene), saturation_of(scene));
  std::vector<double> digits;
  std::vector<double> log_cost;
  for (const std::size_t i : series.points) {
    const StudyPoint& point = scene.points[i];
    const auto fits = std::find_if(used.begin(), used.end(),
                                   [&](const ErrorAtStep& each) { return each.step_s == point.step_s; });
    if (fits == used.end() || point.cpu_s.empty()) continue;
    digits.push_back(-std::log10(fits->error));
    log_cost.push_back(std::log10(spread_of(point.cpu_s).median));
  }
  if (digits.size() < kFewestToFit || digits.back() <= digits.front()) return std::nullopt;
  const FittedLine line = line_through(digits, log_cost);
  if (!(line.slope > 0.0)) return std::nullopt;
  return std::pow(10.0, line.slope);
}

Cost cost_of(const StudyScene& scene, const StudyPoint& point) {
  const double cpu_ns = 1e9 * spread_of(point.cpu_s).median;
  Cost cost;
  const auto engine = std::find_if(scene.engines.begin(), scene.engines.end(),
                                   [&](const StudyEngine& each) { return each.label == point.engine; });
  const bool takes_steps = engine == scene.engines.end() || engine->takes_steps;
  if (takes_steps && point.steps > 0) {
    cost.per_ball_and_step_ns =
        cpu_ns / (static_cast<double>(scene.balls) * static_cast<double>(point.steps));
  }
  if (point.impacts > 0) cost.per_impact_ns = cpu_ns / static_cast<double>(point.impacts);
  return cost;
}

bool was_timed(const StudyGrowth& growth) {
  return std::any_of(growth.points.begin(), growth.points.end(),
                     [](const GrowthPoint& point) { return !point.cpu_s.empty(); });
}

std::optional<double> per_ball_and_step_ns(const GrowthPoint& point) {
  if (point.status != RunStatus::ok || point.cpu_s.empty()) return std::nullopt;
  return 1e9 * spread_of(point.cpu_s).median /
         (static_cast<double>(point.balls) * static_cast<double>(point.steps));
}

std::vector<Lead> leads_over(const StudyScene& scene, const std::string& family) {
  const std::vector<Mark> marks = marks_of(scene);
  const std::vector<Mark> own = marks_of_family(scene, marks, family);
  std::vector<Lead> leads;
  if (own.empty()) return leads;
  const double rounding = least_rounding_of(scene);
  for (const std::string& peer : families_of(scene)) {
    if (peer == family) continue;
    for (const Mark& mark : front_of(marks_of_family(scene, marks, peer))) {
      const bool matched = std::any_of(own.begin(), own.end(),
                                       [&](const Mark& each) { return is_matched(mark, each, rounding); });
      if (matched) continue;
      leads.push_back({peer, mark, cheapest(own, mark.error), best_within(own, mark.cpu_s.upper_quartile)});
    }
  }
  return leads;
}

std::optional<Comparison> compare_families(const StudyScene& scene) {
  const std::vector<Mark> marks = marks_of(scene);
  Comparison result;
  std::vector<std::vector<Mark>> by_family;
  const std::vector<std::string> families = families_of(scene);
  bool any = false;
  for (const std::string& family : families) {
    by_family.push_back(marks_of_family(scene, marks, family));
    const std::vector<Mark> front = front_of(by_family.back());
    if (front.empty()) continue;
    any = true;
    result.cost_s = std::max(result.cost_s, front.front().cpu_s.median);
    result.error = std::max(result.error, front.back().error);
  }
  if (!any) return std::nullopt;
  for (std::size_t i = 0; i < families.size(); ++i) {
    Comparison::Entry& entry = result.entries.emplace_back();
    entry.family = families[i];
    if (const auto best = best_within(by_family[i], result.cost_s)) entry.error_at_cost = best->error;
    if (const auto mark = cheapest(by_family[i], result.error)) entry.cost_at_error_s = mark->cpu_s.median;
  }
  return result;
}

std::optional<Growth> growth_of(const StudyGrowth& growth) {
  std::vector<double> log_balls;
  std::vector<double> log_cost;
  for (const GrowthPoint& point : growth.points) {
    if (point.status != RunStatus::ok || point.cpu_s.empty()) continue;
    log_balls.push_back(std::log(static_cast<double>(point.balls)));
    log_cost.push_back(std::log(spread_of(point.cpu_s).median / static_cast<double>(point.steps)));
  }
  if (log_balls.size() < kFewestBallCounts) return std::nullopt;
  const FittedLine line = line_through(log_balls, log_cost);
  return Growth{line.slope, line.r_squared};
}

}  // namespace carom
