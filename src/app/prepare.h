#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/engines.h"
#include "app/options.h"
#include "comparison/comparison.h"
#include "trajectory/record.h"

namespace carom {

// What every command that runs scenes does before it does what is its own.

/// The scenes that the command line names, each once. @throws InputError
std::vector<ScenarioPtr> load_scenes(const Options& options, const EngineCatalog& engines);

/// An engine that was asked for, and what it says of itself.
struct Participant {
  EngineSource source;
  std::optional<std::string> profile;  ///< none: every profile it has
  EngineInfo info;
};

/// Every engine that was built, or those that were named. @throws InputError for a name that there is not
std::vector<Participant> participants(const Options& options, const EngineCatalog& catalog,
                                      const ProcessLimits& limits);

/// Each engine in the profiles asked for, every pair once. @throws InputError for a profile that there is not
std::vector<EngineChoice> choose_engines(const std::vector<Participant>& participants);

}  // namespace carom
