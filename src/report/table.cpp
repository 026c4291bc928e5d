#include "report/table.h"

#include <fmt/color.h>
#include <fmt/format.h>

#include <array>

#include "report/words.h"

namespace carom {

namespace {

fmt::text_style style_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return fg(fmt::terminal_color::green);
    case Verdict::fail:
    case Verdict::error:
      return fg(fmt::terminal_color::red) | fmt::emphasis::bold;
    case Verdict::unsupported:
      return fg(fmt::terminal_color::bright_black);
    case Verdict::shown:
      break;
  }
  return {};
}

std::string verdict_word(Verdict verdict, bool color) {
  const std::string word = fmt::format("{:<11}", name_of(verdict));
  return color && verdict != Verdict::shown ? fmt::format(style_of(verdict), "{}", word) : word;
}

std::string truth_words(const SceneComparison& scene) {
  if (!scene.truth.known()) return fmt::format("truth: none, {}", scene.truth.reason);
  std::string text = fmt::format("truth: {}, known to {:.1g} m", scene.truth.kind, scene.truth.uncertainty_m);
  if (scene.truth.horizon_s) text += fmt::format(" until t = {} s", short_number(scene.truth.horizon_s));
  return text;
}

/// Of runs that parted from the truth: when, and by which impact.
std::string departure_row(const Scenario& scene, const RunComparison& run) {
  if (!run.judgement || run.judgement->accuracy == Accuracy::exact ||
      run.judgement->accuracy == Accuracy::within_tolerance) {
    return {};
  }
  return wrapped(fmt::format("  {}: ", run.run.label()),
                 fmt::format("{}, {}", name_of(run.judgement->accuracy), departure(scene, run)));
}

std::string run_row(const RunComparison& result, bool color) {
  const std::string name =
      fmt::format("  {:<18} {} ", result.run.label(), verdict_word(result.verdict, color));
  if (result.run.status != RunStatus::ok) return name + result.run.reason + "\n";
  const auto cell = [&](Metric metric) { return short_number(result.metrics[metric]); };
  return name + fmt::format("{:>9} {:>9} {:>9} {:>9} {:>7}\n", cell(Metric::position), cell(Metric::energy),
                            cell(Metric::momentum), cell(Metric::penetration),
                            short_number(result.run.cpu_seconds * 1e3));
}

/// What an engine that adapts to the scene has chosen: its evolver, and how it finds pairs.
std::string choice_row(const Run& run) {
  const auto word = [&run](const char* name) -> std::string {
    const auto found = run.settings.find(name);
    if (found == run.settings.end() || !std::holds_alternative<std::string>(found->second)) return {};
    return std::get<std::string>(found->second);
  };
  if (word("evolver").empty()) return {};
  const std::string pairs = word("broad_phase");
  return fmt::format("  {} ran its evolver {}{}\n", run.label(), word("evolver"),
                     pairs.empty() ? "" : fmt::format(", pairs by {}", pairs));
}

/// A column of the table of symmetries, for a terminal of 80 columns.
struct SymmetryColumn {
  Symmetry symmetry;
  std::string_view heading;
  int width;
};
constexpr std::array kSymmetryColumns = {
    SymmetryColumn{Symmetry::mirror, "mirror", 7},      SymmetryColumn{Symmetry::rotate_90, "90°", 6},
    SymmetryColumn{Symmetry::rotate_1_rad, "1 rad", 6}, SymmetryColumn{Symmetry::boost, "boost", 6},
    SymmetryColumn{Symmetry::relabel, "relabel", 8},    SymmetryColumn{Symmetry::rescale_2, "×8", 6},
    SymmetryColumn{Symmetry::rescale_1_7, "×1.7", 6},   SymmetryColumn{Symmetry::reverse, "reverse", 8}};

/// One digit in five letters: 0.3, 19, 2e-5.
std::string one_digit(double value) {
  if (value >= 1.0 && value < 9999.5) return fmt::format("{:.0f}", value);
  std::string text = fmt::format("{:.1g}", value);
  const std::size_t padding = text.find_last_of("+-");
  if (padding != std::string::npos && text[padding + 1] == '0') text.erase(padding + 1, 1);
  return text;
}

/// "bit", "round", or by how many radii it is broken.
std::string symmetry_word(const RunSymmetries& symmetries, Symmetry symmetry) {
  for (const SymmetryResult& check : symmetries.checks) {
    if (check.symmetry != symmetry) continue;
    switch (check.verdict) {
      case SymmetryVerdict::to_the_bit:
        return "bit";
      case SymmetryVerdict::to_rounding:
        return "round";
      case SymmetryVerdict::broken:
        return one_digit(check.position_radii.value_or(0.0)) + "!";
      case SymmetryVerdict::does_not_apply:
        return "–";
      case SymmetryVerdict::twin_did_not_run:
        return "lost!";
    }
  }
  return "";
}

std::string symmetry_table(const SceneComparison& scene) {
  if (scene.scene->symmetries.empty()) return {};
  std::string text = fmt::format("  {:<18} {:>6}", "symmetry", "floor");
  for (const SymmetryColumn& column : kSymmetryColumns) {
    text += fmt::format("{:>{}}", column.heading, column.width);
  }
  text += "\n";
  for (const RunComparison& run : scene.runs) {
    if (run.run.status != RunStatus::ok) continue;
    const std::optional<double>& floor = run.symmetries.floor_radii;
    text += fmt::format("  {:<18} {:>6}", run.run.label(), floor ? one_digit(*floor) : "n/a");
    for (const SymmetryColumn& column : kSymmetryColumns) {
      text += fmt::format("{:>{}}", symmetry_word(run.symmetries, column.symmetry), column.width);
    }
    text += "\n";
  }
  return text + "  bit: to the bit, round: to rounding, n!: broken by n radii, –: does not apply\n";
}

}  // namespace

std::string results_table(const Results& results, bool color) {
  std::string text;
  for (const SceneComparison& scene : results.scenes) {
    text += fmt::format("{}: {}\n", scene.scene->id, scene.scene->title);
    text += fmt::format("  {}\n", truth_words(scene));
    for (const std::string& note : scene.scene->notes) text += fmt::format("  note: {}\n", note);
    text += fmt::format("  {:<18} {:<11} {:>9} {:>9} {:>9} {:>9} {:>7}\n", "engine", "verdict", "position",
                        "energy", "momentum", "overlap", "CPU");
    text += fmt::format("  {:<18} {:<11} {:>9} {:>9} {:>9} {:>9} {:>7}\n", "", "", "m", "relative",
                        "relative", "/ radius", "ms");
    for (const RunComparison& run : scene.runs) text += run_row(run, color);
    for (const RunComparison& run : scene.runs) text += departure_row(*scene.scene, run);
    for (const RunComparison& run : scene.runs) text += choice_row(run.run);
    text += symmetry_table(scene);
    text += "\n";
  }
  for (const MissingEngine& engine : results.missing) {
    text += fmt::format("{} is not built: {} is not installed\n", engine.name, engine.package);
  }
  for (const std::string& line : baseline_lines(results)) text += fmt::format("baseline: {}\n", line);
  const std::vector<std::string> broken = violations(results);
  for (const std::string& line : broken) text += fmt::format("violated: {}\n", line);
  if (broken.empty()) text += all_is_well(results) + "\n";
  return text;
}

}  // namespace carom
