#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/tuning.h"
#include "reference/common/iterations.h"
#include "reference/common/switches.h"

namespace carom::reference {

// What engines with a fixed step have in common, as their limits and lacks are told.

inline constexpr const char* kLateContacts =
    "A contact is found when a step ends, up to (speed × step) late: a ball is off by as much after it, "
    "and an oblique impact turns by the angle of that place. Only a shorter step helps.";
inline constexpr const char* kFlightOfOrderOne = "Drag and gravity are integrated with order 1 in the step.";
inline constexpr const char* kNotContinuous =
    "No continuous collision: a ball that moves farther than two radii in a step can jump through another.";
inline constexpr const char* kFrictionAtTwoPoints =
    "Rough balls in contact do not keep their angular momentum: friction acts at two points, an overlap "
    "apart.";
inline constexpr const char* kSinglePrecision =
    "Single precision: velocities after an impact are right to about 1e-7, positions to 1e-7 of the scene.";

/// What no rigid-body engine here can do.
/// @param own_law  how it resolves several contacts at once
inline std::map<Feature, std::string> lacks_of_rigid_bodies(const std::string& own_law) {
  return {{Feature::tangential_restitution, "its friction law has no tangential rebound"},
          {Feature::simultaneous, own_law},
          {Feature::generalized_reflections, own_law},
          {Feature::slab, "the adapter makes walls only"},
          {Feature::barrier, "no rigid-body engine tunnels"}};
}

/// An engine with a fixed step, whose solver goes round over all contacts, in a profile for fidelity and one
/// for a newcomer. An adapter gives the set-up of each profile, the table in which they differ, and the
/// rounds.
template <class SimulationType, class Setup, std::size_t n>
class SteppedEngine : public Engine, public Tunable {
 public:
  std::unique_ptr<Simulation> create(const Scenario& scene, std::string_view profile) const final {
    return std::make_unique<SimulationType>(scene, setup_of(scene, profile));
  }

  std::unique_ptr<Simulation> create_switched(const Scenario& scene, std::string_view profile,
                                              std::span<const std::string> names) const final {
    const Setup other = setup_of(scene, other_profile(profile));
    return std::make_unique<SimulationType>(scene, switched(setup_of(scene, profile), other, names, table_));
  }

  bool takes_steps(const Scenario& /*scene*/) const final { return true; }
  ClaimedOrder claimed_order(const Scenario& /*scene*/) const final { return 1; }

  std::vector<Tuning> tunings(const Scenario& scene, std::string_view profile) const final {
    return iteration_tunings(rounds_name_, setup_of(scene, profile).*rounds_);
  }

  std::unique_ptr<Simulation> create_tuned(const Scenario& scene, std::string_view profile,
                                           const Tuned& tuned) const final {
    Setup tuned_setup = setup_of(scene, profile);
    tuned_setup.*rounds_ = iterations_of(tuned);
    return std::make_unique<SimulationType>(scene, tuned_setup);
  }

 protected:
  using Table = std::array<SetupSwitch<Setup>, n>;

  /// @param table        outlives this
  /// @param rounds_name  as in Simulation::settings()
  SteppedEngine(const Table& table, const char* rounds_name, int Setup::*rounds)
      : table_(table), rounds_name_(rounds_name), rounds_(rounds) {}

 private:
  virtual Setup setup_of(const Scenario& scene, std::string_view profile) const = 0;

  const Table& table_;
  const char* rounds_name_;
  int Setup::*rounds_;
};

}  // namespace carom::reference
