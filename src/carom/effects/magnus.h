#pragma once

#include <optional>

#include "carom/effects/kind.h"
#include "carom/world.h"

namespace carom {

/// The Magnus force F = s ω × v: turns the velocity at the rate Ω = s ω/m (s in kg, rate in rad/s). It does
/// no work. Source: e.g. R. G. Watts, R. Ferrer, Am. J. Phys. 55, 40 (1987), for the linear form.
template <int Dim>
struct Magnus {
  static constexpr EffectKind kKind = EffectKind::turning;
  double s;

  static std::optional<Magnus> engaged(const Scenario& scene) {
    if (!scene.effects.magnus) return std::nullopt;
    return Magnus{*scene.effects.magnus};
  }

  Spin<Dim> turning_rate(const World<Dim>& world, std::size_t ball) const {
    return (s * world.inverse_mass[ball]) * world.spin[ball];
  }
};

}  // namespace carom
