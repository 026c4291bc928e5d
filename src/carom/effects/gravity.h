#pragma once

#include <optional>

#include "carom/effects/kind.h"
#include "carom/world.h"

namespace carom {

/// Uniform gravity: a = g for every movable ball (m/s², the scene's frame).
template <int Dim>
struct Gravity {
  static constexpr EffectKind kKind = EffectKind::field;
  Vec<Dim> g;

  static std::optional<Gravity> engaged(const Scenario& scene) {
    if (!scene.effects.gravity) return std::nullopt;
    return Gravity{flattened<Dim>(*scene.effects.gravity)};
  }

  Vec<Dim> acceleration(const World<Dim>& world, std::size_t ball) const {
    // An immovable ball is held by whatever makes it immovable.
    return world.inverse_mass[ball] > 0.0 ? g : Vec<Dim>(Vec<Dim>::Zero());
  }
};

}  // namespace carom
