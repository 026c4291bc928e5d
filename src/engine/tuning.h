#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/engine.h"

namespace carom {

/// A setting by which an engine trades accuracy for time, beside its step, and the values worth trying.
struct Tuning {
  std::string name;                  ///< as in Simulation::settings()
  std::string meaning;               ///< what it does, a few words
  std::vector<SettingValue> values;  ///< those that the engine does not have by itself
  /// Whether what it does depends on the step, so that it is tried at each; else one step tells.
  bool at_every_step = true;
};

/// One setting at one value.
struct Tuned {
  std::string name;
  SettingValue value;
};

/// The order that an engine claims: its error falls like stepᵖ; nothing: it is exact but for rounding.
using ClaimedOrder = std::optional<int>;

/// What an engine may be beside an Engine (it derives from both): one that says which of its settings can be
/// tuned, and how its error depends on the step. An engine that is not one of these has its step alone.
class Tunable {
 public:
  Tunable() = default;
  Tunable(const Tunable&) = delete;
  Tunable& operator=(const Tunable&) = delete;
  virtual ~Tunable() = default;

  /// Whether the step changes anything in this scene.
  virtual bool takes_steps(const Scenario& scene) const = 0;

  virtual ClaimedOrder claimed_order(const Scenario& scene) const = 0;

  virtual std::vector<Tuning> tunings(const Scenario& scene, std::string_view profile) const = 0;

  /// As Engine::create(), with one setting at this value. @pre it is one of tunings()
  virtual std::unique_ptr<Simulation> create_tuned(const Scenario& scene, std::string_view profile,
                                                   const Tuned& tuned) const = 0;
};

}  // namespace carom
