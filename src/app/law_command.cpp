#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/laws.h"
#include "core/files.h"
#include "report/law_words.h"
#include "report/words.h"

namespace carom {

namespace {

void list_laws() {
  fmt::print("Laws that come with Carom (carom law NAME, carom run SCENE --law NAME):\n");
  for (const LawFile& law : all_laws()) fmt::print("  {:<22} {}\n", law.id, law.name);
  fmt::print("\n{}", law_vocabulary());
}

}  // namespace

ExitCode law_command(const Options& options) {
  if (options.laws.empty()) {
    list_laws();
    return ExitCode::holds;
  }
  const std::uint64_t seed = options.seed.value_or(kLawSeed);
  auto json = nlohmann::ordered_json::array();
  for (const LawFile& law : load_laws(options.laws)) {
    const LawReport report = examine_law(law, kLawPairs, seed);
    const LawReport right = examine_right_law(law.has_tangential(), kLawPairs, seed);
    fmt::print("{}", law_table(report, right));
    json.push_back(nlohmann::ordered_json::parse(law_json(report, right)));
  }
  if (!options.json_file.empty()) write_file(options.json_file, json.dump(2) + "\n");
  return ExitCode::holds;
}

}  // namespace carom
