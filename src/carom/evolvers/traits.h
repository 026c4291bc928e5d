#pragma once

#include <memory>

#include "carom/evolvers/parts.h"
#include "carom/laws/frictionless.h"
#include "carom/laws/three_parameter.h"
#include "engine/engine.h"

namespace carom {

/// What an evolver is compiled with. Everything else that a scene asks for is a part that is called once a
/// step; these reach into the innermost loops, so that what is not called for leaves no instruction there.
template <int Dim, bool Accelerates, class ImpactLaw, bool Sheets>
struct Traits {
  static constexpr int kDim = Dim;
  static constexpr bool kAccelerates = Accelerates;  ///< gravity, drag or Magnus force
  using Law = ImpactLaw;
  static constexpr bool kSheets = Sheets;  ///< slabs or barriers
};

inline bool has_friction(const Scenario& scene) {
  return scene.ball_contact.friction > 0.0 || scene.wall_contact.friction > 0.0;
}

namespace detail {

template <int Dim, bool Accelerates, class Law, template <class> class Evolver>
std::unique_ptr<Simulation> with_law(const Scenario& scene, Parts<Dim> parts) {
  if (!scene.slabs.empty() || !scene.barriers.empty()) {
    return std::make_unique<Evolver<Traits<Dim, Accelerates, Law, true>>>(scene, std::move(parts));
  }
  return std::make_unique<Evolver<Traits<Dim, Accelerates, Law, false>>>(scene, std::move(parts));
}

template <int Dim, bool Accelerates, template <class> class Evolver>
std::unique_ptr<Simulation> with_acceleration(const Scenario& scene, Parts<Dim> parts) {
  if (has_friction(scene))
    return with_law<Dim, Accelerates, ThreeParameter, Evolver>(scene, std::move(parts));
  return with_law<Dim, Accelerates, Frictionless, Evolver>(scene, std::move(parts));
}

}  // namespace detail

/// The evolver, compiled with the traits of the scene.
template <int Dim, template <class> class Evolver>
std::unique_ptr<Simulation> make_with_traits(const Scenario& scene, Parts<Dim> parts) {
  if (parts.flight) return detail::with_acceleration<Dim, true, Evolver>(scene, std::move(parts));
  return detail::with_acceleration<Dim, false, Evolver>(scene, std::move(parts));
}

}  // namespace carom
