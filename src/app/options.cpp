#include "app/options.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <thread>

#include "scenario/metric.h"

namespace carom {

namespace {

constexpr int kExitUsage = 2;

// CLI11's own checks let NaN through, wrap negative seeds around and print the ends of ranges with 300
// digits.

CLI::Validator number_from(double low, const std::string& allowed) {
  const auto check = [low, allowed](const std::string& text) {
    double value = 0.0;
    const bool reads = CLI::detail::lexical_cast(text, value);
    return reads && value >= low && std::isfinite(value)
               ? std::string()
               : fmt::format("found {}, allowed: {}", text, allowed);
  };
  return CLI::Validator(check, "");
}

CLI::Validator seed() {
  const auto check = [](const std::string& text) {
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end ? std::string()
                                               : fmt::format("found {}, allowed: an integer from 0 to {}",
                                                             text, std::numeric_limits<std::uint64_t>::max());
  };
  return CLI::Validator(check, "");
}

CLI::Validator not_empty() {
  return CLI::Validator(
      [](const std::string& text) { return text.empty() ? "found nothing, allowed: a path" : ""; }, "");
}

/// What every command takes that runs scenes.
void add_run_options(CLI::App& command, Options& options) {
  command.add_option("--engines-from", options.engines_from, "a folder with further engine modules (*.so)")
      ->expected(1)
      ->take_all();
  command.add_option("--step", options.step_s, "the fixed step in s, instead of the scene's")
      ->check(number_from(std::numeric_limits<double>::min(), "a number > 0"));
  command.add_option("--seed", options.seed, "the seed of every generator, instead of the scene's")
      ->check(seed());
  command
      .add_option(
          "--threads", options.threads,
          "threads that a run of carom in fixed steps shares its balls among, where there are many; the "
          "results are the same")
      ->capture_default_str()
      ->check(CLI::Range(1, 256));
  command.add_option("--json", options.json_file, "write the results as JSON to this file")
      ->check(not_empty());
}

void add_laws(CLI::App& command, Options& options) {
  command
      .add_option(
          "--law", options.laws,
          "also run carom with a law of impact from this file (carom law); may be given several times")
      ->expected(1)
      ->take_all();
}

void add_scene_options(CLI::App& command, Options& options) {
  command.add_option("SCENE", options.scenes, "an id, a path, a group (impact/), or all")->required();
  command.add_option("--engine", options.engines, "an engine, or engine@profile; may be given several times")
      ->expected(1)
      ->take_all();
  add_laws(command, options);
  add_run_options(command, options);
  command.add_flag("--all-balls", options.all_balls, "list the final state of every ball in the JSON");
}

void add_common_options(CLI::App& command, Options& options, double& timeout_s, const char* what_times_out) {
  command.add_option("-j", options.parallel, "runs at a time (default: one for each core)")
      ->check(CLI::Range(1, 1024));
  command.add_option("--timeout", timeout_s, what_times_out)
      ->capture_default_str()
      ->check(number_from(1e-3, "a number of seconds >= 0.001"));
  command.add_option("--memory", options.memory_mib, "the memory limit of one run in MiB")
      ->capture_default_str()
      ->check(number_from(1.0, "a number of MiB >= 1"));
  command.add_flag("--quiet", options.quiet, "no progress, and no table where every gate holds");
  command.add_flag_callback(
      "--no-color", [&options] { options.color = false; }, "no colours (also: the NO_COLOR variable)");
}

void add_common_options(CLI::App& command, Options& options) {
  add_common_options(command, options, options.timeout_s, "the limit of one run in s");
}

void add_study(CLI::App& app, Options& options) {
  CLI::App* study = app.add_subcommand("study", "what accuracy costs in time: every step, every setting");
  study->add_option("SCENE", options.scenes, "an id, a path, a group (impact/), or all")->required();
  study
      ->add_option("--engine", options.engines,
                   "an engine, or engine@profile; may be given several times (default: carom's evolvers and "
                   "every engine that was built)")
      ->expected(1)
      ->take_all();
  add_laws(*study, options);
  study->add_option("--engines-from", options.engines_from, "a folder with further engine modules (*.so)")
      ->expected(1)
      ->take_all();
  study->add_option("--seed", options.seed, "the seed of every generator, instead of the scene's")
      ->check(seed());
  study->add_option("--json", options.json_file, "write the study as JSON to this file")->check(not_empty());
  study->add_option("--csv", options.csv_file, "write every point as CSV to this file")->check(not_empty());
  study->add_option("--report", options.report_folder, "write the page DIR/index.html")->check(not_empty());
  study
      ->add_option("--resume", options.resume_file,
                   "keep the study in this file while it goes, and take up what is in it")
      ->check(not_empty());
  study->add_option("--repeats", options.repeats, "timed runs of each setting")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  study
      ->add_option("--budget", options.budget_s,
                   "the CPU time in s for each scene, beside its truth; fine steps that would go beyond it "
                   "are left out")
      ->capture_default_str()
      ->check(number_from(1e-3, "a number of seconds >= 0.001"));
  add_common_options(*study, options, options.study_timeout_s,
                     "the CPU time in s beyond which a run that is foreseen to take longer is left out");
}

void add_lab(CLI::App& app, Options& options) {
  CLI::App* lab = app.add_subcommand("lab", "the interactive page on localhost, until Ctrl-C");
  lab->add_option("--port", options.port, "0: any that is free")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  lab->add_option("--engines-from", options.engines_from, "a folder with further engine modules (*.so)")
      ->expected(1)
      ->take_all();
  lab->add_option("-j", options.parallel, "runs at a time (default: one for each core)")
      ->check(CLI::Range(1, 1024));
}

/// CLI11 prints help through exceptions as well; the code tells them apart.
int report(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
  fmt::print(stderr, "carom: {}\nTry: carom help\n", error.what());
  return kExitUsage;
}

}  // namespace

Parsed parse_options(int argc, char** argv) {
  Parsed parsed;
  Options& options = parsed.options;
  options.parallel = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U));
  const char* no_color = std::getenv("NO_COLOR");
  options.color = isatty(STDOUT_FILENO) == 1 && (no_color == nullptr || *no_color == '\0');

  CLI::App app(
      "Carom runs a hand-written ball-collision engine, others and exact solutions on the same scenes "
      "and "
      "says where they part.");
  app.name("carom");
  app.set_version_flag("--version", std::string("carom ") + CAROM_VERSION);
  app.require_subcommand(0, 1);  // none is an error too, but an unknown one is to be named
  app.footer(
      "Exit codes: 0 every gate holds; 1 a gate is violated, or an engine under test\n"
      "crashed, hung, gave NaN or cannot run a scene that gates it; 2 bad usage or bad\n"
      "input; 3 the machine failed.");

  CLI::App* list = app.add_subcommand("list", "what there is, with what each engine can and cannot do");
  list->add_option("TOPIC", options.topic, "scenarios, engines or effects; nothing: all three")
      ->check(CLI::IsMember({"scenarios", "engines", "effects"}));
  list->add_option("--engines-from", options.engines_from, "a folder with further engine modules (*.so)")
      ->expected(1)
      ->take_all();
  add_common_options(*list, options);

  CLI::App* run = app.add_subcommand("run", "run side by side, compare, print a table");
  add_scene_options(*run, options);
  run->add_option("--csv", options.csv_folder, "write every trajectory as CSV below this folder")
      ->check(not_empty());
  CLI::Option* page =
      run->add_option("--report", options.report_folder, "write the page DIR/index.html")->check(not_empty());
  run->add_option("--study", options.study_file, "show this study (carom study --json) on the page, too")
      ->check(not_empty())
      ->needs(page);
  add_common_options(*run, options);

  CLI::App* check = app.add_subcommand("check", "the CI gate: as run, and says which gate is violated");
  add_scene_options(*check, options);
  check->add_option("--junit", options.junit_file, "write JUnit XML to this file")->check(not_empty());
  check->add_option("--summary", options.summary_file, "write a Markdown summary to this file")
      ->check(not_empty());
  CLI::Option* baseline =
      check->add_option("--baseline", options.baseline_file, "hold every value against those of this file")
          ->check(not_empty());
  check
      ->add_option("--baseline-factor", options.baseline_factor,
                   "by how much a value may be above the baseline's (default: 2)")
      ->check(number_from(1.0, "a number >= 1"))
      ->needs(baseline);
  check
      ->add_option("--write-baseline", options.write_baseline_file,
                   "write every value to this file; with --baseline, keep what did not take part")
      ->check(not_empty());
  add_common_options(*check, options);

  add_study(app, options);
  add_lab(app, options);

  CLI::App* explain = app.add_subcommand("explain", "which of an engine's settings explains its divergence");
  explain->add_option("SCENE", options.scenes, "an id or a path")->required()->expected(1);
  CLI::Option* explained =
      explain->add_option("--engine", options.engines, "an engine, or engine@profile")->expected(1);
  explain
      ->add_option("--law", options.laws,
                   "carom with a law of impact from this file, against the right law; in place of an engine")
      ->expected(1)
      ->excludes(explained);
  explain
      ->add_option("--metric", options.metric,
                   "what is explained (default: position where there is a truth, else energy)")
      ->check(CLI::IsMember(std::vector<std::string>(kMetricNames.begin(), kMetricNames.end())));
  add_run_options(*explain, options);
  add_common_options(*explain, options);

  CLI::App* law = app.add_subcommand("law", "what a law of impact from a file keeps and breaks");
  law->add_option("LAW", options.laws,
                  "a .toml file, or a name; nothing: those that there are, and what a law may say");
  law->add_option("--seed", options.seed, "of the random pairs")->check(seed());
  law->add_option("--json", options.json_file, "write the findings as JSON to this file")->check(not_empty());

  CLI::App* help = app.add_subcommand("help", "help on a command");
  help->add_option("COMMAND", options.topic, "list, run, check, study, explain, law, lab or help")
      ->check(CLI::IsMember({"list", "run", "check", "study", "explain", "law", "lab", "help"}));

  // Once a command line is parsed, help() is that of the command it names.
  const std::string overview = app.help();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    parsed.exit_code = report(app, error);
    return parsed;
  }
  if (app.get_subcommands().empty()) {
    fmt::print(stderr, "carom: a command is missing\nTry: carom help\n");
    parsed.exit_code = kExitUsage;
    return parsed;
  }
  options.command = app.get_subcommands().front()->get_name();
  if (options.command == "help") {
    fmt::print("{}", options.topic.empty() ? overview : app.get_subcommand(options.topic)->help("carom"));
    parsed.exit_code = 0;
  }
  return parsed;
}

}  // namespace carom
