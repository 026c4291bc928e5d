#include "report/explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/json_number.h"
#include "report/words.h"

namespace carom {

namespace {

std::string_view name_of(RemainderCause cause) {
  switch (cause) {
    case RemainderCause::nothing:
      return "nothing";
    case RemainderCause::step:
      return "step";
    case RemainderCause::rounding:
      return "rounding";
    case RemainderCause::method:
      return "method";
    case RemainderCause::failure:
      return "failure";
  }
  return "?";
}

std::string value_text(const Settings& settings, const std::string& name) {
  const auto found = settings.find(name);
  if (found == settings.end()) return "?";
  if (const bool* flag = std::get_if<bool>(&found->second)) return *flag ? "on" : "off";
  if (const double* real = std::get_if<double>(&found->second)) return fmt::format("{:.6g}", *real);
  return std::get<std::string>(found->second);
}

std::string change_text(const ExplainedScene& explained, const std::string& name) {
  return fmt::format("{} → {}", value_text(explained.run.settings, name),
                     value_text(explained.other.settings, name));
}

std::string divergence_text(const std::optional<double>& divergence) {
  return divergence ? short_number(divergence) : "fails";
}

std::string share_text(const std::optional<double>& share) {
  // A run that fails counts as far beyond everything, and its share says no more than that.
  if (!share || std::abs(*share) > 10.0) return "n/a";
  return fmt::format("{:.0f} %", 100.0 * *share + 0.0);
}

std::string unit_of(Metric metric) {
  return metric == Metric::position || metric == Metric::position_rms ? " m" : "";
}

std::string measured(const ExplainedScene& explained, const std::optional<double>& divergence) {
  if (!divergence) return "a run that fails";
  return short_number(divergence) + unit_of(explained.metric);
}

/// "position, against the closed-form truth"
std::string measure_text(const ExplainedScene& explained) {
  const std::string what(carom::name_of(explained.metric));
  if (explained.truth == "none") return what + ", against what is conserved";
  return fmt::format("{}, against the {} truth", what, explained.truth);
}

std::string first_text(const ExplainedScene& explained) {
  const Explanation& found = explained.explanation;
  if (found.settings.empty()) return "This engine has no setting that could be switched.";
  const std::string ends =
      fmt::format("from {} to {}", measured(explained, found.start), measured(explained, found.all));
  if (!found.settings_matter) {
    const SettingEffect& most = found.settings.front();
    return fmt::format(
        "The settings do not explain it: all of them together take it {}. The one that moves it most by "
        "itself is "
        "{} ({} is left).",
        ends, most.name, measured(explained, most.alone));
  }
  if (found.pair) {
    return fmt::format(
        "{} and {} come first, together: no setting explains half by itself, these two explain {} ({} is "
        "left). "
        "All settings take it {}.",
        found.pair->first, found.pair->second, share_text(found.pair->share),
        measured(explained, found.pair->divergence), ends);
  }
  const SettingEffect& first = found.settings.front();
  return fmt::format("{} comes first ({}): {} alone explains {} ({} is left). All settings take it {}.",
                     first.name, first.meaning, change_text(explained, first.name),
                     share_text(first.alone_share), measured(explained, first.alone), ends);
}

std::string remainder_text(const ExplainedScene& explained) {
  const Explanation& found = explained.explanation;
  const std::string which =
      found.settings.empty() ? "What is left" : "What is left with every setting switched";
  const std::string left = fmt::format("{}, {},", which, measured(explained, found.all));
  const std::string half = fmt::format("half the step leaves {}", measured(explained, found.all_half_step));
  switch (found.remainder) {
    case RemainderCause::nothing:
      return left + " is as good as nothing.";
    case RemainderCause::step:
      return fmt::format("{} comes from the step: {}, an error of order {:.1f}.", left, half,
                         found.remainder_order);
    case RemainderCause::rounding:
      return fmt::format("{} is no more than one rounding in each step can add up to ({}); {}.", left,
                         explained.run.precision, half);
    case RemainderCause::method:
      return fmt::format("{} is neither a setting, nor the step, nor rounding, but the engine's method: {}.",
                         left, half);
    case RemainderCause::failure:
      return "With every setting switched the run fails: " + explained.other.reason;
  }
  return {};
}

constexpr const char* kRow = "  {:<34} {:>10} {:>10} {:>10}\n";

std::string setting_rows(const ExplainedScene& explained, const SettingEffect& effect) {
  return fmt::format(kRow, effect.name, divergence_text(effect.alone), divergence_text(effect.cumulative),
                     share_text(effect.share)) +
         wrapped("    ", change_text(explained, effect.name));
}

using Json = nlohmann::ordered_json;

Json setting_json(const Settings& settings, const std::string& name) {
  Json json = nullptr;
  const auto found = settings.find(name);
  if (found != settings.end()) std::visit([&json](const auto& value) { json = value; }, found->second);
  return json;
}

}  // namespace

std::string explanation_table(const ExplainedScene& explained) {
  const Explanation& found = explained.explanation;
  const double step_s = explained.scene->step_s;
  std::string text = fmt::format("{}: {}\n", explained.scene->id, explained.scene->title);
  text += fmt::format("  {} is off by {} ({})\n", explained.run.label(), measured(explained, found.start),
                      measure_text(explained));
  text += wrapped("  ", first_text(explained));
  text += fmt::format(kRow, "setting", "alone", "together", "share");
  text += fmt::format(kRow, "  from → to", "", "with above", "added");
  text += fmt::format(kRow, "none: as asked for", divergence_text(found.start), "", "");
  for (const SettingEffect& effect : found.settings) text += setting_rows(explained, effect);
  text += fmt::format(kRow, fmt::format("half the step: {:g} s", 0.5 * step_s),
                      divergence_text(found.start_half_step), divergence_text(found.all_half_step), "");
  text += wrapped("  ", remainder_text(explained));
  if (found.settings_matter) {
    text += wrapped("  ", "Shares are of the powers of ten between the two profiles.");
  }
  return text;
}

std::string explanation_json(const ExplainedScene& explained, const std::string& carom_version) {
  const Explanation& found = explained.explanation;
  Json json = {{"carom", carom_version},
               {"scene", explained.scene->id},
               {"sha256", explained.scene->sha256},
               {"engine", explained.run.engine},
               {"profile", explained.run.profile},
               {"version", explained.run.version},
               {"truth", explained.truth},
               {"metric", carom::name_of(explained.metric)},
               {"step", explained.scene->step_s},
               {"divergence", number_or_null(found.start)},
               {"divergence_half_step", number_or_null(found.start_half_step)},
               {"divergence_all_switched", number_or_null(found.all)},
               {"divergence_all_switched_half_step", number_or_null(found.all_half_step)},
               {"step_share", number_or_null(found.step_share)},
               {"remainder", name_of(found.remainder)},
               {"pair", nullptr},
               {"settings", Json::array()}};
  if (found.pair) {
    json["pair"] = {{"settings", {found.pair->first, found.pair->second}},
                    {"divergence", number_or_null(found.pair->divergence)},
                    {"share", found.pair->share}};
  }
  for (const SettingEffect& effect : found.settings) {
    json["settings"].push_back({{"name", effect.name},
                                {"meaning", effect.meaning},
                                {"from", setting_json(explained.run.settings, effect.name)},
                                {"to", setting_json(explained.other.settings, effect.name)},
                                {"alone", number_or_null(effect.alone)},
                                {"alone_share", number_or_null(effect.alone_share)},
                                {"cumulative", number_or_null(effect.cumulative)},
                                {"share", number_or_null(effect.share)}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace carom
