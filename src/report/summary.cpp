#include "report/summary.h"

#include <fmt/format.h>

#include "report/words.h"

namespace carom {

namespace {

std::string_view mark(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "✅ pass";
    case Verdict::fail:
      return "❌ fail";
    case Verdict::shown:
      return "shown";
    case Verdict::unsupported:
      return "unsupported";
    case Verdict::error:
      return "❌ error";
  }
  return "?";
}

/// Text that comes from outside must not break out of its table cell.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char letter : text) {
    if (letter == '|') escaped += '\\';
    escaped += letter == '\n' ? ' ' : letter;
  }
  return escaped;
}

}  // namespace

std::string results_summary(const Results& results) {
  const std::vector<std::string> broken = violations(results);
  std::string text = "## carom check\n\n";
  text += broken.empty() ? all_is_well(results) + "\n\n" : fmt::format("**{} violated:**\n\n", broken.size());
  for (const std::string& line : broken) text += fmt::format("- {}\n", cell(line));
  if (!broken.empty()) text += "\n";
  text += "| scene | engine | verdict | position, m | energy | momentum |\n|---|---|---|--:|--:|--:|\n";
  for (const SceneComparison& scene : results.scenes) {
    for (const RunComparison& run : scene.runs) {
      const auto value = [&](Metric metric) { return short_number(run.metrics[metric]); };
      text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", cell(scene.scene->id), cell(run.run.label()),
                          mark(run.verdict), value(Metric::position), value(Metric::energy),
                          value(Metric::momentum));
    }
  }
  return text;
}

}  // namespace carom
