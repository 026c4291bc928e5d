#include "scenario/features.h"

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

bool any_contact(const Scenario& s, bool (*holds)(const Contact&)) {
  return (s.effects.collisions && holds(s.ball_contact)) || (!s.walls.empty() && holds(s.wall_contact));
}

bool requires_feature(const Scenario& s, Feature feature) {
  switch (feature) {
    case Feature::plane:
      return s.dimension == 2;
    case Feature::space:
      return s.dimension == 3;
    case Feature::collisions:
      return s.effects.collisions && s.balls.size() > 1;
    case Feature::passing:
      return !s.effects.collisions;
    case Feature::walls:
      return !s.walls.empty();
    case Feature::gravity:
      return s.effects.gravity.has_value();
    case Feature::linear_drag:
      return s.effects.drag && s.effects.drag->kind == Drag::Kind::linear;
    case Feature::quadratic_drag:
      return s.effects.drag && s.effects.drag->kind == Drag::Kind::quadratic;
    case Feature::spin:
      return s.effects.spin;
    case Feature::magnus:
      return s.effects.magnus.has_value();
    case Feature::friction:
      return any_contact(s, [](const Contact& c) { return c.friction > 0.0; });
    case Feature::tangential_restitution:
      return any_contact(
          s, [](const Contact& c) { return c.friction > 0.0 && c.tangential_restitution != 0.0; });
    case Feature::simultaneous:
      return s.multi_contact == MultiContact::simultaneous;
    case Feature::generalized_reflections:
      return s.multi_contact == MultiContact::generalized_reflections;
    case Feature::immovable:
      return std::any_of(s.balls.begin(), s.balls.end(),
                         [](const Ball& ball) { return std::isinf(ball.mass); });
    case Feature::slab:
      return !s.slabs.empty();
    case Feature::barrier:
      return !s.barriers.empty();
    case Feature::events:
      return !s.events.empty();
  }
  return false;
}

}  // namespace

const std::vector<FeatureName>& all_features() {
  static const std::vector<FeatureName> features = {
      {Feature::plane, "2D", "centres stay in the plane z = 0"},
      {Feature::space, "3D", "balls move in space"},
      {Feature::collisions, "collisions", "balls hit each other"},
      {Feature::passing, "walls-only", "collisions = false: balls pass through each other"},
      {Feature::walls, "walls", "a box or single planes"},
      {Feature::gravity, "gravity", "uniform, m/s²"},
      {Feature::linear_drag, "drag.linear", "F = -c v"},
      {Feature::quadratic_drag, "drag.quadratic", "F = -c |v| v"},
      {Feature::spin, "spin", "balls can rotate"},
      {Feature::magnus, "magnus", "F = s ω × v"},
      {Feature::friction, "friction", "Coulomb friction at impacts"},
      {Feature::tangential_restitution, "tangential_restitution", "β0 of the three-parameter impact law"},
      {Feature::simultaneous, "law.simultaneous", "touching balls push each other all at once"},
      {Feature::generalized_reflections, "law.generalized-reflections",
       "an impact travels through touching balls, contact by contact"},
      {Feature::immovable, "immovable", "balls of infinite mass"},
      {Feature::slab, "slab", "a solid sheet of finite thickness"},
      {Feature::barrier, "barrier", "a quantum barrier"},
      {Feature::events, "events", "what a person did at a moment"},
  };
  return features;
}

std::string_view name_of(Feature feature) {
  for (const FeatureName& row : all_features()) {
    if (row.feature == feature) return row.name;
  }
  return "?";
}

std::vector<Feature> required_features(const Scenario& scenario) {
  std::vector<Feature> required;
  for (const FeatureName& row : all_features()) {
    if (requires_feature(scenario, row.feature)) required.push_back(row.feature);
  }
  return required;
}

}  // namespace carom
