#include "carom/tuning.h"

#include <array>
#include <string>
#include <utility>
#include <variant>

#include "carom/broad_phase/list.h"

namespace carom {

namespace {

constexpr const char* kBroadPhase = "broad_phase";
constexpr const char* kLaw = "law";
/// Of fewer balls all pairs are looked at in no time, and one broad phase is as good as another.
constexpr std::size_t kBallsToSearch = 10;
/// Three balls are the fewest that can touch at two contacts at once.
constexpr std::size_t kBallsToTouch = 3;

struct NamedLaw {
  const char* name;
  MultiContact law;
};
constexpr std::array kLaws = {
    NamedLaw{"sequential", MultiContact::sequential},
    NamedLaw{"simultaneous", MultiContact::simultaneous},
    NamedLaw{"generalized-reflections", MultiContact::generalized_reflections},
};

bool laws_apply(const Scenario& scene) {
  return scene.effects.collisions && scene.balls.size() >= kBallsToTouch &&
         scene.ball_contact.friction == 0.0 && scene.wall_contact.friction == 0.0;
}

/// A scene of its own, with the simulation that refers to it.
class WithScene final : public Simulation {
 public:
  WithScene(Scenario scene, const Variant& variant)
      : scene_(std::move(scene)), simulation_(compose(scene_, variant)) {}

  void advance(double step_s, std::int64_t steps) override { simulation_->advance(step_s, steps); }
  void snapshot(std::span<BallState> balls) const override { simulation_->snapshot(balls); }
  Tally tally() const override { return simulation_->tally(); }
  Settings settings() const override { return simulation_->settings(); }
  double uncertainty_m() const override { return simulation_->uncertainty_m(); }

 private:
  Scenario scene_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace

std::vector<Tuning> variant_tunings(const Scenario& scene, const Variant& variant) {
  std::vector<Tuning> tunings;
  const bool takes_broad_phase = choose_evolver(scene, variant).takes_broad_phase;
  if (takes_broad_phase && variant.broad_phase.empty() && scene.effects.collisions &&
      scene.balls.size() >= kBallsToSearch) {
    Tuning pairs{kBroadPhase, "how pairs that may meet are found; the trajectory is the same", {}, false};
    for (const std::string_view name : broad_phase_names(scene.dimension)) {
      pairs.values.emplace_back(std::string(name));
    }
    tunings.push_back(std::move(pairs));
  }
  if (takes_broad_phase && laws_apply(scene)) {
    Tuning laws{kLaw, "what balls do that touch at several contacts at once", {}, false};
    for (const NamedLaw& each : kLaws) {
      if (each.law != scene.multi_contact) laws.values.emplace_back(std::string(each.name));
    }
    tunings.push_back(std::move(laws));
  }
  return tunings;
}

std::unique_ptr<Simulation> compose_tuned(const Scenario& scene, const Variant& variant, const Tuned& tuned) {
  const auto& value = std::get<std::string>(tuned.value);
  if (tuned.name == kBroadPhase) {
    Variant with_broad_phase = variant;
    with_broad_phase.broad_phase = value;
    return compose(scene, with_broad_phase);
  }
  Scenario with_law = scene;
  for (const NamedLaw& each : kLaws) {
    if (value == each.name) with_law.multi_contact = each.law;
  }
  return std::make_unique<WithScene>(std::move(with_law), variant);
}

}  // namespace carom
