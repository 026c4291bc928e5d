#include "report/study_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "report/words.h"

namespace carom {

std::string words_of(const Series& series) {
  return series.setting.empty() ? series.engine : series.engine + ", " + series.setting;
}

std::string words_of(const StudyScene& scene, const StudyPoint& point) {
  std::string words = words_of(Series{point.engine, point.setting, {}});
  const auto engine = std::find_if(scene.engines.begin(), scene.engines.end(),
                                   [&](const StudyEngine& each) { return each.label == point.engine; });
  if (engine != scene.engines.end() && !engine->takes_steps) return words;
  return fmt::format("{}, step {} s", words, short_number(point.step_s));
}

std::string words_of(const Order& order) {
  switch (order.kind) {
    case Order::Kind::fitted:
      return fmt::format("{}{:.2f}", order.r_squared < kStraight ? "~" : "", order.order);
    case Order::Kind::rounding:
      return "rounding";
    case Order::Kind::too_few:
      break;
  }
  return "–";
}

std::string claim_of(const StudyScene& scene, const std::string& engine) {
  for (const StudyEngine& each : scene.engines) {
    if (each.label != engine || !each.claims) continue;
    return each.claimed_order ? fmt::format("{}", *each.claimed_order) : "exact";
  }
  return "–";
}

std::string time_words(double cpu_s) {
  struct Unit {
    double seconds;
    const char* name;
  };
  constexpr std::array kUnits = {Unit{1.0, "s"}, Unit{1e-3, "ms"}, Unit{1e-6, "µs"}, Unit{1e-9, "ns"}};
  // What would be rounded up to a thousand is one of the next unit.
  const auto unit = std::find_if(kUnits.begin(), std::prev(kUnits.end()),
                                 [&](const Unit& each) { return cpu_s >= 0.9995 * each.seconds; });
  const double value = cpu_s / unit->seconds;
  return fmt::format("{:.{}f} {}", value, value < 9.95 ? 1 : 0, unit->name);
}

std::string unit_of(const StudyScene& scene) {
  return measure_of(scene) == StudyMeasure::position_m ? "m" : "relative";
}

std::string words_of(const StudyScene& scene, const std::string& own, const Lead& lead) {
  std::string text =
      fmt::format("{}: {} {} in {}", words_of(scene, scene.points[lead.mark.point]),
                  short_number(lead.mark.error), unit_of(scene), time_words(lead.mark.cpu_s.median));
  text += lead.own_at_error
              ? fmt::format("; {} needs {} for that", own, time_words(lead.own_at_error->cpu_s.median))
              : fmt::format("; {} is never as good", own);
  text += lead.own_at_cost
              ? fmt::format(" and is off by {} in that time", short_number(lead.own_at_cost->error))
              : " and is never as fast";
  return text;
}

bool takes_part(const StudyScene& scene, const std::string& family) {
  return !marks_of_family(scene, marks_of(scene), family).empty();
}

}  // namespace carom
