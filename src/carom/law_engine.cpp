#include "carom/law_engine.h"

#include <fmt/format.h>

#include <algorithm>

#include "carom/compose.h"
#include "carom/evolvers/toi_written.h"
#include "carom/laws/law_formula.h"

namespace carom {

namespace {

/// The setting in which two laws differ.
constexpr const char* kLawSwitch = "law";

/// A run under a written law, which says what it is.
class LawSimulation final : public Simulation {
 public:
  LawSimulation(std::unique_ptr<Simulation> simulation, const LawFile& law)
      : simulation_(std::move(simulation)), law_(law) {}

  void advance(double step_s, std::int64_t steps) override { simulation_->advance(step_s, steps); }
  void snapshot(std::span<BallState> balls) const override { simulation_->snapshot(balls); }

  Tally tally() const override {
    Tally tally = simulation_->tally();
    // The account takes what one ball gets for the opposite of what the other does.
    tally.energy.known = tally.energy.known && law_.is_reciprocal();
    return tally;
  }

  Settings settings() const override {
    Settings settings = simulation_->settings();
    settings[kLawSwitch] = law_.name;
    for (const LawExpression& each : law_.definitions) settings["law_" + each.key] = each.text;
    for (const LawPush& push : law_.pushes) settings["law_" + push.value.key] = push.value.text;
    return settings;
  }

 private:
  std::unique_ptr<Simulation> simulation_;
  const LawFile& law_;
};

class LawEngine final : public Engine {
 public:
  explicit LawEngine(std::vector<LawFile> laws) : laws_(std::move(laws)) {}

  EngineInfo info() const override {
    EngineInfo info;
    info.name = kLawEngineName;
    info.about = "The hand-written engine, evolver toi, with a law of impact between balls from a file";
    info.version = CAROM_VERSION;
    info.precision = "float64";
    for (const LawFile& law : laws_) info.profiles.push_back({law.id, law.name + " (" + law.file + ")"});
    info.limits = {
        "The law is for two balls that meet. Walls have the right law, and balls that come to rest on "
        "something "
        "are held by it.",
        "A law after which balls approach as fast as before ends the run: they would meet again at once, for "
        "ever.",
    };
    if (laws_.size() == 2) info.switches = {{kLawSwitch, "what two balls do when they meet"}};
    const char* one_contact = "a law file says what happens at one contact at a time";
    info.cannot = {{Feature::simultaneous, one_contact}, {Feature::generalized_reflections, one_contact}};
    return info;
  }

  std::string refuses(const Scenario& scenario, std::string_view profile) const override {
    if (law_of(profile).has_tangential() && !scenario.effects.spin) {
      return "the law pushes along the surface, and without effects.spin balls cannot turn";
    }
    return {};
  }

  std::unique_ptr<Simulation> create_switched(const Scenario& scenario, std::string_view profile,
                                              std::span<const std::string> switched) const override {
    if (switched.empty()) return create(scenario, profile);
    return create(scenario, laws_[laws_[0].id == profile ? 1 : 0].id);
  }

  std::unique_ptr<Simulation> create(const Scenario& scenario, std::string_view profile) const override {
    const LawFile& law = law_of(profile);
    const auto formula = std::make_shared<LawFormula>(law);
    std::unique_ptr<Simulation> simulation =
        scenario.dimension == 2 ? make_toi_written<2>(scenario, make_parts<2>(scenario), formula)
                                : make_toi_written<3>(scenario, make_parts<3>(scenario), formula);
    return std::make_unique<LawSimulation>(std::move(simulation), law);
  }

 private:
  const LawFile& law_of(std::string_view profile) const {
    return *std::find_if(laws_.begin(), laws_.end(), [&](const LawFile& law) { return law.id == profile; });
  }

  std::vector<LawFile> laws_;
};

}  // namespace

std::unique_ptr<Engine> make_law_engine(std::vector<LawFile> laws) {
  return std::make_unique<LawEngine>(std::move(laws));
}

}  // namespace carom
