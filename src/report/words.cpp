#include "report/words.h"

#include <fmt/format.h>

namespace carom {

std::string short_number(std::optional<double> value) {
  if (!value) return "n/a";
  if (*value == 0.0) return "0";
  return fmt::format("{:.3g}", *value);
}

std::vector<std::string> violations(const SceneComparison& scene, const RunComparison& run) {
  std::vector<std::string> lines;
  if (!run.violates()) return lines;
  const std::string who = fmt::format("{}: {}", scene.scene->id, run.run.label());
  if (run.run.status != RunStatus::ok) {
    return {fmt::format("{}: {}: {}", who, name_of(run.run.status), run.run.reason)};
  }
  for (const GateResult& gate : run.gates) {
    if (gate.holds) continue;
    if (gate.value) {
      // All digits: a value that is just above its limit must not look equal to it.
      lines.push_back(fmt::format("{}: {} = {} is above its limit {}", who, name_of(gate.metric), *gate.value,
                                  gate.limit));
    } else {
      lines.push_back(fmt::format("{}: {} cannot be told in this scene, so its limit {} cannot hold", who,
                                  name_of(gate.metric), gate.limit));
    }
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
  const auto counted = [](std::size_t count, std::string_view what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
  };
  std::string text = gates == 0 ? "No gate: nothing was checked."
                                : fmt::format("Every gate holds: {} in {}.", counted(gates, "limit"),
                                              counted(scenes, "scene"));
  if (errors > 0) text += fmt::format(" {} not under test ended in error.", counted(errors, "run"));
  return text;
}

}  // namespace carom
