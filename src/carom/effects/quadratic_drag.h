#pragma once

#include <optional>

#include "carom/effects/kind.h"
#include "carom/world.h"

namespace carom {

/// Quadratic (Newton) drag F = -c |v| v: damps the velocity at the rate c |v| / m (c in kg/m, rate in 1/s).
template <int Dim>
struct QuadraticDrag {
  static constexpr EffectKind kKind = EffectKind::damping;
  double c;

  static std::optional<QuadraticDrag> engaged(const Scenario& scene) {
    if (!scene.effects.drag || scene.effects.drag->kind != Drag::Kind::quadratic) return std::nullopt;
    return QuadraticDrag{scene.effects.drag->coefficient};
  }

  double damping_rate(const World<Dim>& world, std::size_t ball, const Vec<Dim>& velocity) const {
    return c * velocity.norm() * world.inverse_mass[ball];
  }
};

}  // namespace carom
