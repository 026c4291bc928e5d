#pragma once

#include <optional>

#include "carom/effects/kind.h"
#include "carom/world.h"

namespace carom {

/// Linear (Stokes) drag F = -c v: damps the velocity at the rate c/m (c in kg/s, rate in 1/s).
template <int Dim>
struct LinearDrag {
  static constexpr EffectKind kKind = EffectKind::damping;
  double c;

  static std::optional<LinearDrag> engaged(const Scenario& scene) {
    if (!scene.effects.drag || scene.effects.drag->kind != Drag::Kind::linear) return std::nullopt;
    return LinearDrag{scene.effects.drag->coefficient};
  }

  double damping_rate(const World<Dim>& world, std::size_t ball, const Vec<Dim>& /*velocity*/) const {
    return c * world.inverse_mass[ball];
  }
};

}  // namespace carom
