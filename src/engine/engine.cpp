#include "engine/engine.h"

#include <fmt/format.h>

#include <stdexcept>

namespace carom {

std::unique_ptr<Simulation> Engine::create_switched(const Scenario& scenario, std::string_view profile,
                                                    std::span<const std::string> switched) const {
  if (!switched.empty()) {
    throw std::logic_error(fmt::format("{} has no setting {} to switch", info().name, switched.front()));
  }
  return create(scenario, profile);
}

std::string unsupported_reason(const Engine& engine, const Scenario& scenario, std::string_view profile) {
  const EngineInfo info = engine.info();
  for (const Feature feature : required_features(scenario)) {
    const auto lacking = info.cannot.find(feature);
    if (lacking != info.cannot.end()) return fmt::format("{}: {}", name_of(feature), lacking->second);
  }
  return engine.refuses(scenario, profile);
}

}  // namespace carom
