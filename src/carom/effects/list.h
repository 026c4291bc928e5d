#pragma once

#include "carom/effects/gravity.h"
#include "carom/effects/linear_drag.h"
#include "carom/effects/magnus.h"
#include "carom/effects/quadratic_drag.h"

namespace carom {

// Effects are composed at compile time: for every combination of these that a scene can ask for there is one
// flight model that contains exactly them. A new effect is a header beside this one and its name in the list.
// An effect says when a scene engages it (`engaged`), of which kind it is (kind.h), and what it does.

/// Effects of which a scene has at most one.
template <class... Alternatives>
struct Slot {};

template <class... EachSlot>
struct Slots {};

template <int Dim>
using EffectSlots = Slots<Slot<Gravity<Dim>>, Slot<LinearDrag<Dim>, QuadraticDrag<Dim>>, Slot<Magnus<Dim>>>;

/// Calls build(effects...) with the effects that the scene engages, each by value and by its own type.
template <class Build, class... Chosen>
auto with_effects(const Scenario& /*scene*/, Slots<> /*none left*/, Build build, Chosen... chosen) {
  return build(chosen...);
}

template <class... Rest, class Build, class... Chosen>
auto with_effects(const Scenario& scene, Slots<Slot<>, Rest...> /*slots*/, Build build, Chosen... chosen) {
  return with_effects(scene, Slots<Rest...>{}, build, chosen...);
}

template <class First, class... Others, class... Rest, class Build, class... Chosen>
auto with_effects(const Scenario& scene, Slots<Slot<First, Others...>, Rest...> /*slots*/, Build build,
                  Chosen... chosen) {
  if (const std::optional<First> effect = First::engaged(scene)) {
    return with_effects(scene, Slots<Rest...>{}, build, chosen..., *effect);
  }
  return with_effects(scene, Slots<Slot<Others...>, Rest...>{}, build, chosen...);
}

}  // namespace carom
