#include "reference/chipmunk/simulation.h"
#include "reference/common/stepped_engine.h"

namespace carom::chipmunk {

namespace {

static_assert(sizeof(cpFloat) == sizeof(double), "Debian's Chipmunk computes in double precision");

using Adapter = reference::SteppedEngine<ChipmunkSimulation, Setup, kSwitches.size()>;

/// Chipmunk 7: circles in the plane, in double precision, with a fixed step.
class ChipmunkEngine final : public Adapter {
 public:
  ChipmunkEngine() : Adapter(kSwitches, "iterations", &Setup::iterations) {}

  EngineInfo info() const override {
    EngineInfo info;
    info.name = "chipmunk";
    info.about = "Scott Lembcke's 2D engine: sequential impulses with a fixed step";
    info.version = cpVersionString;
    info.precision = "float64";
    info.profiles = {
        {"faithful", "every bias, slop and memory of old impulses set for fidelity"},
        {"default", "the settings of a new cpSpace, as in its manual's first example"},
    };
    info.limits = {
        reference::kLateContacts,
        "Balls move before their velocities change, so drag and gravity are integrated with order 1 in the "
        "step.",
        reference::kNotContinuous,
        reference::kFrictionAtTwoPoints,
    };
    info.cannot = reference::lacks_of_rigid_bodies(
        "it resolves touching contacts by its own iteration of pairwise impulses");
    info.cannot.emplace(Feature::space, "Chipmunk is two-dimensional");
    info.switches = reference::switches_of(kSwitches);
    return info;
  }

  std::string refuses(const Scenario& scenario, std::string_view profile) const override {
    // A newcomer's balls jump through each other without a word; that is one of its results.
    return profile == "faithful" ? reference::jumps_through_balls(scenario) : "";
  }

 private:
  Setup setup_of(const Scenario& /*scene*/, std::string_view profile) const override {
    return setup_for(profile);
  }
};

}  // namespace

}  // namespace carom::chipmunk

CAROM_ENGINE_MODULE(carom::chipmunk::ChipmunkEngine)
