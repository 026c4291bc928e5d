#include "carom/compose.h"

#include <fmt/format.h>

#include <algorithm>

#include "carom/broad_phase/list.h"

namespace carom {

const Evolver& choose_evolver(const Scenario& scene, const Variant& variant) {
  const auto chosen = [&](const Evolver& evolver) {
    if (!variant.evolver.empty()) return evolver.name == variant.evolver;
    return evolver.suits(scene) && (variant.broad_phase.empty() || evolver.takes_broad_phase);
  };
  return *std::find_if(all_evolvers().begin(), all_evolvers().end(), chosen);
}

template <int Dim>
Parts<Dim> make_parts(const Scenario& scene, const Variant& variant) {
  // Where nobody collides all pairs are none.
  const Listed listed = scene.effects.collisions ? variant.listed : Listed::kNear;
  return {make_broad_phase<Dim>(scene, variant.broad_phase), make_flight<Dim>(scene),
          make_cluster_law<Dim>(scene), listed, variant.threads};
}

template Parts<2> make_parts<2>(const Scenario&, const Variant&);
template Parts<3> make_parts<3>(const Scenario&, const Variant&);

std::string refusal(const Scenario& scene, const Variant& variant) {
  if (std::string reason = choose_evolver(scene, variant).refuses(scene); !reason.empty()) return reason;
  const std::vector<std::string_view> names = broad_phase_names(scene.dimension);
  if (variant.broad_phase.empty() ||
      std::find(names.begin(), names.end(), variant.broad_phase) != names.end()) {
    return {};
  }
  return fmt::format("the broad phase {} is not for scenes of dimension {}", variant.broad_phase,
                     scene.dimension);
}

std::unique_ptr<Simulation> compose(const Scenario& scene, const Variant& variant) {
  const Evolver& evolver = choose_evolver(scene, variant);
  if (scene.dimension == 2) return evolver.make_2d(scene, make_parts<2>(scene, variant));
  return evolver.make_3d(scene, make_parts<3>(scene, variant));
}

}  // namespace carom
