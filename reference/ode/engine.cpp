#include "reference/common/stepped_engine.h"
#include "reference/ode/simulation.h"

namespace carom::ode {

namespace {

static_assert(sizeof(dReal) == sizeof(double), "Debian's ODE computes in double precision");

using Adapter = reference::SteppedEngine<OdeSimulation, Setup, kSwitches.size()>;

/// The Open Dynamics Engine 0.16: spheres in space or in a plane, in double precision, with a fixed step.
class OdeEngine final : public Adapter {
 public:
  OdeEngine() : Adapter(kSwitches, "iterations", &Setup::iterations) { dInitODE2(0); }
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
        reference::kLateContacts,
        reference::kFlightOfOrderOne,
        reference::kNotContinuous,
        "Friction between balls acts in the middle of their overlap, so the lever arm is short by half of "
        "it.",
    };
    info.cannot = reference::lacks_of_rigid_bodies(
        "it resolves touching contacts by its own iteration over all of them");
    info.switches = reference::switches_of(kSwitches);
    return info;
  }

  std::string refuses(const Scenario& scenario, std::string_view profile) const override {
    // A newcomer's balls jump through each other without a word; that is one of its results.
    return profile == "faithful" ? reference::jumps_through_balls(scenario) : "";
  }

 private:
  Setup setup_of(const Scenario& scene, std::string_view profile) const override {
    return setup_for(scene, profile);
  }
};

}  // namespace

}  // namespace carom::ode

CAROM_ENGINE_MODULE(carom::ode::OdeEngine)
