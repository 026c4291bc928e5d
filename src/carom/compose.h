#pragma once

#include <cstddef>
#include <memory>

#include "carom/broad_phase/brute_force.h"
#include "carom/broad_phase/nobody_meets.h"
#include "carom/broad_phase/uniform_grid.h"
#include "carom/effects/list.h"
#include "carom/evolvers/toi.h"
#include "scenario/scenario.h"

namespace carom {

/// Which broad phase a simulation gets.
enum class BroadPhaseChoice { automatic, brute_force, uniform_grid };

/// Below this many balls looking at all pairs is cheaper than sorting into cells.
inline constexpr std::size_t kGridFrom = 32;

template <int Dim, template <int> class BroadPhase, class Law>
std::unique_ptr<Simulation> compose_effects(const Scenario& scene) {
  return with_effects(scene, EffectSlots<Dim>{}, [&scene](auto... effects) -> std::unique_ptr<Simulation> {
    return std::make_unique<ToiEvolver<Dim, BroadPhase, Law, decltype(effects)...>>(scene, effects...);
  });
}

template <int Dim, class Law>
std::unique_ptr<Simulation> compose_broad_phase(const Scenario& scene, BroadPhaseChoice choice) {
  if (!scene.effects.collisions) return compose_effects<Dim, NobodyMeets, Law>(scene);
  const bool few = scene.balls.size() < kGridFrom;
  if (choice == BroadPhaseChoice::brute_force || (choice == BroadPhaseChoice::automatic && few)) {
    return compose_effects<Dim, BruteForce, Law>(scene);
  }
  return compose_effects<Dim, UniformGrid, Law>(scene);
}

/// The simulation that contains exactly what the scene calls for: its dimension, its effects, one broad phase
/// and one impact law.
template <class Law>
std::unique_ptr<Simulation> compose(const Scenario& scene,
                                    BroadPhaseChoice choice = BroadPhaseChoice::automatic) {
  if (scene.dimension == 2) return compose_broad_phase<2, Law>(scene, choice);
  return compose_broad_phase<3, Law>(scene, choice);
}

}  // namespace carom
