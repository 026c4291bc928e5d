#include "engine/tuning.h"
#include "reference/common/iterations.h"
#include "reference/ode/simulation.h"

namespace carom::ode {

namespace {

static_assert(sizeof(dReal) == sizeof(double), "Debian's ODE computes in double precision");

/// The Open Dynamics Engine 0.16: spheres in space or in a plane, in double precision, with a fixed step.
class OdeEngine final : public Engine, public Tunable {
 public:
  OdeEngine() { dInitODE2(0); }
  ~OdeEngine() override { dCloseODE(); }

  EngineInfo info() const override {
    EngineInfo info;
    info.name = "ode";
    info.about = "Russell Smith's 3D engine: a complementarity problem relaxed row by row, with a fixed step";
    info.version = CAROM_ODE_VERSION;
    info.precision = "float64";
    info.profiles = {
        {"faithful", "every threshold, softness and error reduction set for fidelity"},
        {"default", "the settings of a new world, and the bounce threshold of its demos"},
    };
    info.limits = {
        "A contact is found when a step ends, up to (speed × step) late: a ball is off by as much after it, "
        "and an oblique impact turns by the angle of that place. Only a shorter step helps.",
        "Drag and gravity are integrated with order 1 in the step.",
        "No continuous collision: a ball that moves farther than two radii in a step can jump through "
        "another.",
        "Friction between balls acts in the middle of their overlap, so the lever arm is short by half of "
        "it.",
    };
    const std::string own_law = "it resolves touching contacts by its own iteration over all of them";
    info.cannot = {
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
    // A newcomer's balls jump through each other without a word; that is one of its results.
    return profile == "faithful" ? reference::jumps_through_balls(scenario) : "";
  }

  std::unique_ptr<Simulation> create(const Scenario& scenario, std::string_view profile) const override {
    return std::make_unique<OdeSimulation>(scenario, setup_for(scenario, profile));
  }

  std::unique_ptr<Simulation> create_switched(const Scenario& scenario, std::string_view profile,
                                              std::span<const std::string> switched) const override {
    const Setup other = setup_for(scenario, reference::other_profile(profile));
    return std::make_unique<OdeSimulation>(
        scenario, reference::switched(setup_for(scenario, profile), other, switched, kSwitches));
  }

  bool takes_steps(const Scenario& /*scene*/) const override { return true; }
  ClaimedOrder claimed_order(const Scenario& /*scene*/) const override { return 1; }

  std::vector<Tuning> tunings(const Scenario& scene, std::string_view profile) const override {
    return reference::iteration_tunings("iterations", setup_for(scene, profile).iterations);
  }

  std::unique_ptr<Simulation> create_tuned(const Scenario& scene, std::string_view profile,
                                           const Tuned& tuned) const override {
    Setup setup = setup_for(scene, profile);
    setup.iterations = reference::iterations_of(tuned);
    return std::make_unique<OdeSimulation>(scene, setup);
  }
};

}  // namespace

}  // namespace carom::ode

CAROM_ENGINE_MODULE(carom::ode::OdeEngine)
