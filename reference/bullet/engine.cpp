#include <fmt/format.h>

#include <cmath>

#include "engine/tuning.h"
#include "reference/bullet/simulation.h"
#include "reference/common/iterations.h"

namespace carom::bullet {

namespace {

#ifdef BT_USE_DOUBLE_PRECISION
constexpr const char* kName = "bullet-f64";
constexpr const char* kPrecision = "float64";
#else
constexpr const char* kName = "bullet";
constexpr const char* kPrecision = "float32";
#endif

/// Bullet 3: spheres in space or confined to a plane, with a fixed step. Compiled once per precision.
class BulletEngine final : public Engine, public Tunable {
 public:
  EngineInfo info() const override {
    EngineInfo info;
    info.name = kName;
    info.about = "Erwin Coumans' 3D engine: sequential impulses with a fixed step";
    info.version = fmt::format("{}.{}", btGetVersion() / 100, btGetVersion() % 100);
    info.precision = kPrecision;
    info.profiles = {
        {"faithful", "every threshold, damping, sleep and margin set for fidelity"},
        {"default", "the settings of its own HelloWorld example"},
    };
    info.limits = {
        "A contact is found when a step ends, up to (speed × step) late: a ball is off by as much after it, "
        "and an "
        "oblique impact turns by the angle of that place. Only a shorter step helps.",
        "Drag and gravity are integrated with order 1 in the step.",
        "Rough balls in contact do not keep their angular momentum: friction acts at two points, an overlap "
        "apart.",
    };
#if !defined(BT_USE_DOUBLE_PRECISION)
    info.limits.emplace_back(
        "Single precision: velocities after an impact are right to about 1e-7, positions to 1e-7 of the "
        "scene.");
#endif
    const std::string own_law = "it resolves touching contacts by its own iteration of pairwise impulses";
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
    const double step_s = reference::first_step_s(scenario);
    if (step_s <= kShortestStep_s) {
      return fmt::format("a step of {:.3g} s; Bullet takes {:.3g} s or less for none", step_s,
                         kShortestStep_s);
    }
    for (const Ball& ball : scenario.balls) {
      const double rate_Hz = reference::linear_drag_rate(scenario.effects, ball);
      if (kEpsilon * std::exp(rate_Hz) > kDampingAccuracy) {
        return fmt::format("linear drag of c/m = {:.3g} 1/s is beyond its damping setting", rate_Hz);
      }
    }
    // A newcomer's spin is clamped without a word; that is one of its results.
    const double turn_rad = reference::initial_spin_radps(scenario) * step_s;
    if (profile == "faithful" && turn_rad > kMaxTurn_rad) {
      return fmt::format("a ball turns {:.3g} rad in a step; Bullet holds it to {:.3g}", turn_rad,
                         kMaxTurn_rad);
    }
    return {};
  }

  std::unique_ptr<Simulation> create(const Scenario& scenario, std::string_view profile) const override {
    return std::make_unique<BulletSimulation>(scenario, setup_for(scenario, profile));
  }

  std::unique_ptr<Simulation> create_switched(const Scenario& scenario, std::string_view profile,
                                              std::span<const std::string> switched) const override {
    const Setup other = setup_for(scenario, reference::other_profile(profile));
    return std::make_unique<BulletSimulation>(
        scenario, reference::switched(setup_for(scenario, profile), other, switched, kSwitches));
  }

  bool takes_steps(const Scenario& /*scene*/) const override {
    return true;
  }
  ClaimedOrder claimed_order(const Scenario& /*scene*/) const override {
    return 1;
  }

  std::vector<Tuning> tunings(const Scenario& scene, std::string_view profile) const override {
    return reference::iteration_tunings("velocity_iterations", setup_for(scene, profile).iterations);
  }

  std::unique_ptr<Simulation> create_tuned(const Scenario& scene, std::string_view profile,
                                           const Tuned& tuned) const override {
    Setup setup = setup_for(scene, profile);
    setup.iterations = reference::iterations_of(tuned);
    return std::make_unique<BulletSimulation>(scene, setup);
  }
};

}  // namespace

}  // namespace carom::bullet

CAROM_ENGINE_MODULE(carom::bullet::BulletEngine)
