#pragma once

#include "carom/evolvers/event.h"
#include "carom/evolvers/event_evolver.h"
#include "carom/evolvers/traits.h"

namespace carom {

template <int Dim, bool kGravity>
std::unique_ptr<Simulation> make_event_with_law(const Scenario& scene) {
  if (has_friction(scene)) return std::make_unique<EventEvolver<Dim, kGravity, ThreeParameter>>(scene);
  return std::make_unique<EventEvolver<Dim, kGravity, Frictionless>>(scene);
}

template <int Dim>
std::unique_ptr<Simulation> make_event(const Scenario& scene) {
  if (scene.effects.gravity) return make_event_with_law<Dim, true>(scene);
  return make_event_with_law<Dim, false>(scene);
}

}  // namespace carom
