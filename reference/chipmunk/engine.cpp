#include "engine/tuning.h"
#include "reference/chipmunk/simulation.h"
#include "reference/common/iterations.h"

namespace carom::chipmunk {

namespace {

static_assert(sizeof(cpFloat) == sizeof(double), "Debian's Chipmunk computes in double precision");

/// Chipmunk 7: circles in the plane, in double precision, with a fixed step.
class ChipmunkEngine final : public Engine, public Tunable {
 public:
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
        "A contact is found when a step ends, up to (speed × step) late: a ball is off by as much after it, "
        "and an oblique impact turns by the angle of that place. Only a shorter step helps.",
        "Balls move before their velocities change, so drag and gravity are integrated with order 1 in the "
        "step.",
        "No continuous collision: a ball that moves farther than two radii in a step can jump through "
        "another.",
        "Rough balls in contact do not keep their angular momentum: friction acts at two points, an overlap "
        "apart.",
    };
    const std::string own_law = "it resolves touching contacts by its own iteration of pairwise impulses";
    info.cannot = {
        {Feature::space, "Chipmunk is two-dimensional"},
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
    return std::make_unique<ChipmunkSimulation>(scenario, setup_for(profile));
  }

  std::unique_ptr<Simulation> create_switched(const Scenario& scenario, std::string_view profile,
                                              std::span<const std::string> switched) const override {
    const Setup other = setup_for(reference::other_profile(profile));
    return std::make_unique<ChipmunkSimulation>(
        scenario, reference::switched(setup_for(profile), other, switched, kSwitches));
  }

  bool takes_steps(const Scenario& /*scene*/) const override { return true; }
  ClaimedOrder claimed_order(const Scenario& /*scene*/) const override { return 1; }

  std::vector<Tuning> tunings(const Scenario& /*scene*/, std::string_view profile) const override {
    return reference::iteration_tunings("iterations", setup_for(profile).iterations);
  }

  std::unique_ptr<Simulation> create_tuned(const Scenario& scene, std::string_view profile,
                                           const Tuned& tuned) const override {
    Setup setup = setup_for(profile);
    setup.iterations = reference::iterations_of(tuned);
    return std::make_unique<ChipmunkSimulation>(scene, setup);
  }
};

}  // namespace

}  // namespace carom::chipmunk

CAROM_ENGINE_MODULE(carom::chipmunk::ChipmunkEngine)
