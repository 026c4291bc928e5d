#include <fmt/format.h>

#include <cmath>

#include "reference/bullet/simulation.h"
#include "reference/common/stepped_engine.h"

namespace carom::bullet {

namespace {

#ifdef BT_USE_DOUBLE_PRECISION
constexpr const char* kName = "bullet-f64";
constexpr const char* kPrecision = "float64";
#else
constexpr const char* kName = "bullet";
constexpr const char* kPrecision = "float32";
#endif

using Adapter = reference::SteppedEngine<BulletSimulation, Setup, kSwitches.size()>;

/// Bullet 3: spheres in space or confined to a plane, with a fixed step. Compiled once per precision.
class BulletEngine final : public Adapter {
 public:
  BulletEngine() : Adapter(kSwitches, "velocity_iterations", &Setup::iterations) {}

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
        reference::kLateContacts,
        reference::kFlightOfOrderOne,
        reference::kFrictionAtTwoPoints,
    };
#if !defined(BT_USE_DOUBLE_PRECISION)
    info.limits.emplace_back(reference::kSinglePrecision);
#endif
    info.cannot = reference::lacks_of_rigid_bodies(
        "it resolves touching contacts by its own iteration of pairwise impulses");
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

 private:
  Setup setup_of(const Scenario& scene, std::string_view profile) const override {
    return setup_for(scene, profile);
  }
};

}  // namespace

}  // namespace carom::bullet

CAROM_ENGINE_MODULE(carom::bullet::BulletEngine)
