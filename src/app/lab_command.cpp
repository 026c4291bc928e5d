#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/commands.h"
#include "app/engines.h"
#include "app/layout.h"
#include "app/prepare.h"
#include "carom/law_engine.h"
#include "carom/laws/law_file.h"
#include "comparison/law_report.h"
#include "lab/server.h"
#include "report/law_words.h"

namespace carom {

namespace {

/// carom by a law of the student's own, as the page calls it: law@own.
EngineChoice law_choice(const std::string& text) {
  LawFile law = parse_law(text, "law.toml");
  law.id = "own";
  const std::shared_ptr<const Engine> engine = make_law_engine({law});
  return {{"law", [engine]() -> const Engine& { return *engine; }}, law.id};
}

/// What the command line makes of names of engines, and a law's text where there is one.
std::vector<EngineChoice> choose(const Options& options, const EngineCatalog& catalog,
                                 const std::vector<std::string>& names, const std::string& law) {
  Options asked = options;
  asked.engines = names;
  std::vector<EngineChoice> choices =
      choose_engines(participants(asked, catalog, {options.timeout_s, options.memory_mib}));
  if (!law.empty()) choices.push_back(law_choice(law));
  return choices;
}

std::string judged(const std::string& text) {
  const LawFile law = parse_law(text, "law.toml");
  return law_json(examine_law(law), examine_right_law(law.has_tangential()));
}

}  // namespace

ExitCode lab_command(const Options& options) {
  const EngineCatalog catalog(engine_folder(), options.engines_from);
  LabSetup setup;
  setup.scenarios = scenario_folder();
  setup.page = viewer_folder();
  setup.engines = catalog.sources();
  for (const char* variant : {"carom:event", "carom:toi", "carom:step", "carom:textbook"}) {
    setup.engines.push_back(catalog.find(variant));
  }
  setup.engine_names = catalog.names();
  setup.choose = [&](const std::vector<std::string>& names, const std::string& law) {
    return choose(options, catalog, names, law);
  };
  setup.judge_law = judged;
  setup.truths = truth_sources();
  setup.parallel = options.parallel;
  serve_lab(setup, options.port, [](int port) {
    fmt::print("The lab is at http://127.0.0.1:{}/ until Ctrl-C\n", port);
    std::fflush(stdout);
  });
  return ExitCode::holds;
}

}  // namespace carom
