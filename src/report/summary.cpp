#include "report/summary.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <map>
#include <string_view>
#include <vector>

#include "report/words.h"

namespace carom {

namespace {

constexpr std::array kVerdicts = {Verdict::pass, Verdict::fail, Verdict::error, Verdict::shown,
                                  Verdict::unsupported};

std::string mark(Verdict verdict) {
  const bool bad = verdict == Verdict::fail || verdict == Verdict::error;
  return fmt::format("{}{}", verdict == Verdict::pass ? "✅ " : bad ? "❌ " : "", name_of(verdict));
}

bool inside_word(std::string_view text, std::size_t i) {
  const auto is_word = [&text](std::size_t k) {
    return std::isalnum(static_cast<unsigned char>(text[k])) != 0;
  };
  return i > 0 && i + 1 < text.size() && is_word(i - 1) && is_word(i + 1);
}

/// Text that comes from outside must not become markup or break out of its cell. An underscore inside a word
/// means nothing to the Markdown of code hosts, and metrics have them.
std::string plain(std::string_view text) {
  std::string escaped;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char letter = text[i];
    if (letter == '<') {
      escaped += "&lt;";
    } else if (letter == '&') {
      escaped += "&amp;";
    } else if (letter == '\n' || letter == '\r') {
      escaped += ' ';
    } else {
      if (std::string_view("\\`*[]|~>").find(letter) != std::string_view::npos) escaped += '\\';
      if (letter == '_' && !inside_word(text, i)) escaped += '\\';
      escaped += letter;
    }
  }
  return escaped;
}

/// How many runs of each engine ended how.
std::string counts_table(const Results& results) {
  std::vector<std::string> engines;  // in the order in which they take part
  std::map<std::string, std::map<Verdict, std::size_t>> counts;
  for (const SceneComparison& scene : results.scenes) {
    for (const RunComparison& run : scene.runs) {
      const std::string label = run.run.label();
      if (!counts.contains(label)) engines.push_back(label);
      ++counts[label][run.verdict];
    }
  }
  std::string text = "| engine |";
  for (const Verdict verdict : kVerdicts) text += fmt::format(" {} |", mark(verdict));
  text += "\n|---|--:|--:|--:|--:|--:|\n";
  for (const std::string& engine : engines) {
    text += fmt::format("| {} |", plain(engine));
    for (const Verdict verdict : kVerdicts) {
      const std::size_t count = counts[engine][verdict];
      text += count == 0 ? " |" : fmt::format(" {} |", count);
    }
    text += "\n";
  }
  return text;
}

std::string violated_run(const SceneComparison& scene, const RunComparison& run) {
  const std::string who = fmt::format("| {} | {} |", plain(scene.scene->id), plain(run.run.label()));
  if (run.run.status != RunStatus::ok) {
    return fmt::format("{} {} | {} | | |\n", who, name_of(run.run.status), plain(run.run.reason));
  }
  std::string text;
  for (const GateResult& gate : run.gates) {
    if (gate.holds) continue;
    const std::string value = gate.value ? fmt::format("{}", *gate.value) : "cannot be told";
    const std::string from =
        gate.baseline ? fmt::format("the baseline's {}", *gate.baseline) : std::string("the scene");
    text += fmt::format("{} {} | {} | {} | {} |\n", who, name_of(gate.metric), value, gate.limit, from);
  }
  return text;
}

std::string violations_table(const Results& results) {
  std::string text = "| scene | engine | violated | value | limit | set by |\n|---|---|---|--:|--:|---|\n";
  for (const SceneComparison& scene : results.scenes) {
    for (const RunComparison& run : scene.runs) {
      if (run.violates()) text += violated_run(scene, run);
    }
  }
  return text;
}

/// Every run, in a box that is closed until someone wants it.
std::string details(const Results& results) {
  std::string text = fmt::format(
      "<details>\n<summary>Every scene and engine</summary>\n\n"
      "| scene | engine | verdict | position, m | energy | momentum |\n|---|---|---|--:|--:|--:|\n");
  for (const SceneComparison& scene : results.scenes) {
    for (const RunComparison& run : scene.runs) {
      const auto value = [&](Metric metric) { return short_number(run.metrics[metric]); };
      text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", plain(scene.scene->id), plain(run.run.label()),
                          mark(run.verdict), value(Metric::position), value(Metric::energy),
                          value(Metric::momentum));
    }
  }
  return text + "\n</details>\n";
}

}  // namespace

std::string results_summary(const Results& results) {
  const std::size_t broken = violations(results).size();
  std::string text = fmt::format("## {} carom check\n\n", broken == 0 ? "✅" : "❌");
  if (broken == 0) {
    text += plain(all_is_well(results)) + "\n\n";
  } else {
    text += fmt::format("**{} violated:**\n\n{}\n", broken, violations_table(results));
  }
  for (const std::string& line : baseline_lines(results))
    text += fmt::format("- baseline: {}\n", plain(line));
  if (!baseline_lines(results).empty()) text += "\n";
  return text + counts_table(results) + "\n" + details(results);
}

}  // namespace carom
