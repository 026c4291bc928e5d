#include "report/words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace carom {

std::string short_number(std::optional<double> value) {
  if (!value) return "n/a";
  if (*value == 0.0) return "0";
  return fmt::format("{:.3g}", *value);
}

namespace {

std::string describe(const Scenario& scene, const TrueImpact& impact) {
  if (!impact.wall) return fmt::format("balls {} and {} met", impact.ball, impact.partner);
  const bool of_box = scene.box && impact.partner < 2 * static_cast<std::uint32_t>(scene.dimension);
  const std::string wall = of_box ? fmt::format("the box's {} {}", impact.partner % 2 == 0 ? "min" : "max",
                                                "xyz"[impact.partner / 2])
                                  : fmt::format("wall {}", impact.partner);
  return fmt::format("ball {} met {}", impact.ball, wall);
}

/// Characters of UTF-8, each a column wide: the bytes that do not continue one.
std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
  }));
}

}  // namespace

std::string departure(const Scenario& scene, const RunComparison& run) {
  if (!run.judgement) return {};
  const Judgement& judgement = *run.judgement;
  const std::optional<double>& error_m = run.metrics[Metric::position];
  if (!judgement.beyond_rounding_s) {
    return fmt::format("off the truth by {} m at most, no more than rounding could explain",
                       short_number(error_m));
  }
  std::string text = fmt::format("off by more than rounding from t = {} s on, by {} m at most",
                                 short_number(judgement.beyond_rounding_s), short_number(error_m));
  if (!run.first_divergence) return text;
  text = fmt::format("left the truth at t = {} s", short_number(run.first_divergence->time_s));
  if (const auto& cause = run.first_divergence->cause) {
    text += fmt::format(", wrong since {} at t = {} s", describe(scene, *cause), short_number(cause->time_s));
  }
  return text;
}

std::string wrapped(std::string_view heading, std::string_view text) {
  const std::string indent(columns(heading), ' ');
  std::string lines;
  std::string line(heading);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const bool empty = columns(line) == indent.size();
    if (!empty && columns(line) + 1 + columns(text.substr(0, end)) > kColumns) {
      lines += line + "\n";
      line = indent;
    }
    if (columns(line) > indent.size()) line += ' ';
    line += text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines + line + "\n";
}

std::string violation(const GateResult& gate) {
  const std::string_view metric = name_of(gate.metric);
  if (!gate.value) {
    return fmt::format("{} cannot be told in this scene, so its limit {} cannot hold{}", metric, gate.limit,
                       gate.baseline ? fmt::format("; the baseline has {}", *gate.baseline) : "");
  }
  // All digits: a value that is just above its limit must not look equal to it.
  const std::string above = fmt::format("{} = {} is above", metric, *gate.value);
  if (!gate.baseline) return fmt::format("{} its limit {}", above, gate.limit);
  return fmt::format("{} {}, what its baseline {} allows", above, gate.limit, *gate.baseline);
}

std::vector<std::string> violations(const SceneComparison& scene, const RunComparison& run) {
  std::vector<std::string> lines;
  if (!run.violates()) return lines;
  const std::string who = fmt::format("{}: {}", scene.scene->id, run.run.label());
  if (run.run.status != RunStatus::ok) {
    return {fmt::format("{}: {}: {}", who, name_of(run.run.status), run.run.reason)};
  }
  for (const GateResult& gate : run.gates) {
    if (!gate.holds) lines.push_back(fmt::format("{}: {}", who, violation(gate)));
  }
  return lines;
}

std::vector<std::string> violations(const Results& results) {
  std::vector<std::string> all;
  for (const SceneComparison& scene : results.scenes) {
    for (const RunComparison& run : scene.runs) {
      const std::vector<std::string> lines = violations(scene, run);
      all.insert(all.end(), lines.begin(), lines.end());
    }
  }
  return all;
}

namespace {

std::string counted(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// "a, b, c and 7 more": enough to know what is meant.
std::string first_few(const std::vector<std::string>& all) {
  constexpr std::size_t kNamed = 8;
  const std::vector<std::string> named(
      all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(kNamed, all.size())));
  const std::string text = fmt::format("{}", fmt::join(named, ", "));
  return all.size() <= kNamed ? text : fmt::format("{} and {} more", text, all.size() - kNamed);
}

std::string from_baseline(const Results& results) {
  if (!results.baseline) return {};
  return fmt::format(", {} of them made from {}", results.baseline->compared, results.baseline->file);
}

}  // namespace

std::vector<std::string> baseline_lines(const Results& results) {
  std::vector<std::string> lines;
  if (!results.baseline) return lines;
  const BaselineFindings& baseline = *results.baseline;
  for (const BaselineFindings::Group& group : baseline.not_compared) {
    lines.push_back(fmt::format("not compared, {}: {}", group.reason, first_few(group.what)));
  }
  if (baseline.better.empty()) return lines;
  std::vector<std::string> better;
  better.reserve(baseline.better.size());
  for (const BaselineFindings::Better& each : baseline.better) {
    better.push_back(fmt::format("{} {} {} = {} (was {})", each.scene, each.engine, name_of(each.metric),
                                 short_number(each.value), short_number(each.baseline)));
  }
  lines.push_back(
      fmt::format("better than the baseline: {}; carom check … --baseline {} --write-baseline {} "
                  "takes it over",
                  first_few(better), baseline.file, baseline.file));
  return lines;
}

std::string all_is_well(const Results& results) {
  std::size_t gates = 0;
  std::size_t scenes = 0;
  std::size_t errors = 0;
  for (const SceneComparison& scene : results.scenes) {
    std::size_t in_scene = 0;
    for (const RunComparison& run : scene.runs) {
      in_scene += run.gates.size();
      errors += run.verdict == Verdict::error ? 1 : 0;
    }
    gates += in_scene;
    scenes += in_scene > 0 ? 1 : 0;
  }
  std::string text = gates == 0 ? "No gate: nothing was checked."
                                : fmt::format("Every gate holds: {} in {}{}.", counted(gates, "limit"),
                                              counted(scenes, "scene"), from_baseline(results));
  if (errors > 0) text += fmt::format(" {} not under test ended in error.", counted(errors, "run"));
  return text;
}

}  // namespace carom
