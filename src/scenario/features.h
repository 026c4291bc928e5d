#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "scenario/scenario.h"

namespace carom {

/// What a scene can ask of an engine. An engine answers for each of these (Engine::info), so that a scene it
/// cannot run is refused with a reason and nothing asked for is dropped.
enum class Feature {
  plane,       ///< dimension 2
  space,       ///< dimension 3
  collisions,  ///< balls hit each other
  passing,     ///< effects.collisions = false
  walls,       ///< box or wall
  gravity,
  linear_drag,
  quadratic_drag,
  spin,
  magnus,
  friction,                 ///< μ > 0 somewhere
  tangential_restitution,   ///< β0 != 0 where μ > 0
  simultaneous,             ///< contact.law = "simultaneous"
  generalized_reflections,  ///< contact.law = "generalized-reflections"
  immovable,                ///< a ball of infinite mass
  slab,
  barrier,
  events,
};

struct FeatureName {
  Feature feature;
  std::string_view name;     ///< as `carom list effects` prints it
  std::string_view meaning;  ///< one line for people
};

/// Every feature, in the order in which people read them.
const std::vector<FeatureName>& all_features();

std::string_view name_of(Feature feature);

/// What this scene asks for, in the order of all_features().
std::vector<Feature> required_features(const Scenario& scenario);

}  // namespace carom
