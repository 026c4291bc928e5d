#include "report/study_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

#include "study/analyse.h"

namespace carom {

namespace {

/// As RFC 4180 has it: in quotes where it needs them, with quotes doubled.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return quoted + "\"";
}

std::string field(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : std::string();
}

std::string row(const StudyScene& scene, const StudyPoint& point, bool on_front) {
  const StudyErrors& errors = point.errors;
  std::string text = fmt::format("{},{},{},{},{},{},{},{}", field(scene.id), scene.balls, field(point.engine),
                                 field(point.setting), point.steps_per_frame, point.step_s,
                                 point.status ? name_of(*point.status) : "", field(point.reason));
  for (const std::optional<double>& error :
       {errors.position_m, errors.final_position_m, errors.energy, errors.momentum, errors.angular_momentum,
        errors.impact_time_s, std::optional(scene.uncertainty_m)}) {
    text += "," + field(error);
  }
  text += fmt::format(",{},{},{}", point.steps, point.impacts, point.cpu_s.size());
  if (point.cpu_s.empty()) return text + ",,,,,,,\n";
  const Spread cpu_s = spread_of(point.cpu_s);
  const Cost cost = cost_of(scene, point);
  return text + fmt::format(",{},{},{},{},{},{},{}\n", cpu_s.least, cpu_s.lower_quartile, cpu_s.median,
                            cpu_s.upper_quartile, field(cost.per_ball_and_step_ns), field(cost.per_impact_ns),
                            on_front ? 1 : 0);
}

/// A number of balls of a growing gas: no errors are measured there.
std::string row(const StudyGrowth& growth, const GrowthPoint& point) {
  std::string text = fmt::format("gas of {} balls in dimension {},{},{},,,,{},{},,,,,,,,{},{},{}",
                                 point.balls, growth.dimension, point.balls, field(growth.engine),
                                 point.status ? name_of(*point.status) : "", field(point.reason), point.steps,
                                 point.impacts, point.cpu_s.size());
  if (point.cpu_s.empty()) return text + ",,,,,,,\n";
  const Spread cpu_s = spread_of(point.cpu_s);
  return text + fmt::format(",{},{},{},{},{},,\n", cpu_s.least, cpu_s.lower_quartile, cpu_s.median,
                            cpu_s.upper_quartile, field(per_ball_and_step_ns(point)));
}

}  // namespace

std::string study_csv(const Study& study) {
  std::string csv =
      "scene,balls,engine,setting,steps_per_frame,step,status,reason,position,final_position,energy,momentum,"
      "angular_momentum,impact_time,truth_uncertainty,steps,impacts,timed_runs,cpu_least,cpu_lower_quartile,"
      "cpu_median,cpu_upper_quartile,ns_per_ball_and_step,ns_per_impact,on_front\n";
  for (const StudyScene& scene : study.scenes) {
    const std::vector<Mark> front = front_of(marks_of(scene));
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
      const bool on_front =
          std::any_of(front.begin(), front.end(), [&](const Mark& mark) { return mark.point == i; });
      csv += row(scene, scene.points[i], on_front);
    }
  }
  for (const StudyGrowth& growth : study.growths) {
    for (const GrowthPoint& point : growth.points) csv += row(growth, point);
  }
  return csv;
}

}  // namespace carom
