#include "engine/engine.h"

#include <fmt/format.h>

namespace carom {

std::string unsupported_reason(const Engine& engine, const Scenario& scenario, std::string_view profile) {
  const EngineInfo info = engine.info();
  for (const Feature feature : required_features(scenario)) {
    const auto lacking = info.cannot.find(feature);
    if (lacking != info.cannot.end()) return fmt::format("{}: {}", name_of(feature), lacking->second);
  }
  return engine.refuses(scenario, profile);
}

}  // namespace carom
