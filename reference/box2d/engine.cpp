#include <fmt/format.h>

#include "engine/tuning.h"
#include "reference/box2d/simulation.h"
#include "reference/common/iterations.h"

namespace carom::box2d {

namespace {

/// Box2D 2.4: circles in the plane, in single precision, with a fixed step.
class Box2dEngine final : public Engine, public Tunable {
 public:
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
        "Single precision: velocities after an impact are right to about 1e-7, positions to 1e-7 of the "
        "scene.",
        "A contact is found when a step ends, up to (speed × step) late: a ball is off by as much after it, "
        "and an oblique impact turns by the angle of that place. Only a shorter step helps.",
        "Gravity is added before a contact reflects the velocity, so each bounce under gravity gains energy: "
        "a ball dropped from 10 m at 1 ms rises to 11.45 m after 100 bounces.",
        "Drag and gravity are integrated with order 1 in the step.",
        "No body moves farther than 2 length units in a step; the scene is scaled so that this is not met.",
    };
    const std::string own_law = "it resolves touching contacts by its own iteration of pairwise impulses";
    info.cannot = {
        {Feature::space, "Box2D is two-dimensional"},
        {Feature::tangential_restitution, "its friction law has no tangential rebound"},
        {Feature::simultaneous, own_law},
        {Feature::generalized_reflections, own_law},
        {Feature::slab, "the adapter makes walls only"},
        {Feature::barrier, "no rigid-body engine tunnels"},
    };
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

  std::unique_ptr<Simulation> create(const Scenario& scenario, std::string_view profile) const override {
    return std::make_unique<Box2dSimulation>(scenario, setup_for(scenario, profile));
  }

  std::unique_ptr<Simulation> create_switched(const Scenario& scenario, std::string_view profile,
                                              std::span<const std::string> switched) const override {
    const Setup other = setup_for(scenario, reference::other_profile(profile));
    return std::make_unique<Box2dSimulation>(
        scenario, reference::switched(setup_for(scenario, profile), other, switched, kSwitches));
  }

  bool takes_steps(const Scenario& /*scene*/) const override { return true; }
  ClaimedOrder claimed_order(const Scenario& /*scene*/) const override { return 1; }

  std::vector<Tuning> tunings(const Scenario& scene, std::string_view profile) const override {
    return reference::iteration_tunings("velocity_iterations", setup_for(scene, profile).velocity_iterations);
  }

  std::unique_ptr<Simulation> create_tuned(const Scenario& scene, std::string_view profile,
                                           const Tuned& tuned) const override {
    Setup setup = setup_for(scene, profile);
    setup.velocity_iterations = reference::iterations_of(tuned);
    return std::make_unique<Box2dSimulation>(scene, setup);
  }
};

}  // namespace

}  // namespace carom::box2d

CAROM_ENGINE_MODULE(carom::box2d::Box2dEngine)
