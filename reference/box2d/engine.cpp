#include <fmt/format.h>

#include "reference/box2d/simulation.h"
#include "reference/common/stepped_engine.h"

namespace carom::box2d {

namespace {

using Adapter = reference::SteppedEngine<Box2dSimulation, Setup, kSwitches.size()>;

/// Box2D 2.4: circles in the plane, in single precision, with a fixed step.
class Box2dEngine final : public Adapter {
 public:
  Box2dEngine() : Adapter(kSwitches, "velocity_iterations", &Setup::velocity_iterations) {}

  EngineInfo info() const override {
    EngineInfo info;
    info.name = "box2d";
    info.about = "Erin Catto's 2D engine: sequential impulses with a fixed step";
    info.version = CAROM_BOX2D_VERSION;
    info.precision = "float32";
    info.profiles = {
        {"faithful", "every threshold, damping, sleep and margin set for fidelity"},
        {"default", "the settings of its manual's first example"},
    };
    info.limits = {
        reference::kSinglePrecision,
        reference::kLateContacts,
        "Gravity is added before a contact reflects the velocity, so each bounce under gravity gains energy: "
        "a ball dropped from 10 m at 1 ms rises to 11.45 m after 100 bounces.",
        reference::kFlightOfOrderOne,
        "No body moves farther than 2 length units in a step; the scene is scaled so that this is not met.",
    };
    info.cannot = reference::lacks_of_rigid_bodies(
        "it resolves touching contacts by its own iteration of pairwise impulses");
    info.cannot.emplace(Feature::space, "Box2D is two-dimensional");
    info.switches = reference::switches_of(kSwitches);
    return info;
  }

  std::string refuses(const Scenario& scenario, std::string_view profile) const override {
    const Setup setup = setup_for(scenario, profile);
    const double step_s = reference::first_step_s(scenario);
    const double travel_m = reference::initial_speed_mps(scenario) * step_s;
    // A newcomer's world is clamped without a word; that is one of its results.
    if (profile == "faithful" && travel_m * setup.length_scale > b2_maxTranslation) {
      return fmt::format("a ball moves {:.3g} m in a step; Box2D holds balls of this size to {:.3g} m",
                         travel_m, b2_maxTranslation / setup.length_scale);
    }
    const double turn_rad = reference::initial_spin_radps(scenario) * step_s;
    if (profile == "faithful" && turn_rad > b2_maxRotation) {
      return fmt::format("a ball turns {:.3g} rad in a step; Box2D holds it to {:.3g}", turn_rad,
                         b2_maxRotation);
    }
    return {};
  }

 private:
  Setup setup_of(const Scenario& scene, std::string_view profile) const override {
    return setup_for(scene, profile);
  }
};

}  // namespace

}  // namespace carom::box2d

CAROM_ENGINE_MODULE(carom::box2d::Box2dEngine)
