#pragma once

#include <box2d/box2d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "engine/engine.h"
#include "reference/common/scene_scale.h"
#include "reference/common/switches.h"

namespace carom::box2d {

/// Everything in which the profiles differ. CONVENTIONS.md says why each value is what it is.
struct Setup {
  double length_scale = 1.0;  ///< Box2D length units per metre of the scene, a power of two
  double velocity_threshold_mps = 1.0;
  int velocity_iterations = 8;
  int position_iterations = 3;
  bool sleeping = true;
  bool warm_starting = true;
  bool solid_walls = false;           ///< thick polygons whose surface is on the plane; else two-sided edges
  bool scene_inertia = false;         ///< the scene's inertia; else that of a disk, from the shape's density
  bool continuous_when_fast = false;  ///< continuous collision only for fast balls; else Box2D's default
};

// Box2D's absolute lengths suit bodies of 0.1 to 10 units, so the smallest ball gets a radius of about this.
constexpr double kRadiusUnits = 0.5;
// Below this radius (ten linear slops) the continuous solver's tolerance is no longer small against the ball.
constexpr double kSmallestRadiusUnits = 10.0 * b2_linearSlop;
// A ball that moves more than this part of its radius in a step is fast. Two such balls close in by one
// radius, half the distance 2 r at which a head-on pair can start to jump through each other.
constexpr double kFastRadiiPerStep = 0.5;

/// Length units per metre for fidelity: the smallest ball near kRadiusUnits, but no ball near the clamp of
/// b2_maxTranslation units per step, and none smaller than kSmallestRadiusUnits.
inline double faithful_length_scale(const Scenario& scene) {
  const double radius_m = reference::smallest_radius_m(scene);
  const double travel_m = reference::expected_top_speed_mps(scene) * reference::first_step_s(scene);
  const double unclamped = travel_m > 0.0 ? b2_maxTranslation / travel_m : std::numeric_limits<double>::max();
  // Rounding down to a power of two costs up to a factor of two, so each target is its upper end.
  const double scale = std::min(std::sqrt(2.0) * kRadiusUnits / radius_m, unclamped);
  return reference::power_of_two_below(std::max(scale, 2.0 * kSmallestRadiusUnits / radius_m));
}

inline Setup setup_for(const Scenario& scene, std::string_view profile) {
  Setup setup;
  if (profile == "default") return setup;
  setup.length_scale = faithful_length_scale(scene);
  setup.velocity_threshold_mps = 0.0;
  setup.velocity_iterations = 50;
  setup.position_iterations = 0;
  setup.sleeping = false;
  setup.warm_starting = false;
  setup.solid_walls = true;
  setup.scene_inertia = true;
  setup.continuous_when_fast = true;
  return setup;
}

/// Every setting in which the profiles differ, to be switched one by one.
inline constexpr std::array<reference::SetupSwitch<Setup>, 9> kSwitches = {{
    {"length_scale", "Box2D's length units per metre: its absolute margins against the balls",
     &reference::copy_members<&Setup::length_scale>},
    {"velocity_threshold_mps", "a slower impact loses its bounce",
     &reference::copy_members<&Setup::velocity_threshold_mps>},
    {"velocity_iterations", "rounds over all contacts until their impulses agree",
     &reference::copy_members<&Setup::velocity_iterations>},
    {"position_iterations", "rounds that move overlapping bodies apart without a velocity",
     &reference::copy_members<&Setup::position_iterations>},
    {"sleeping", "slow bodies are stopped", &reference::copy_members<&Setup::sleeping>},
    {"warm_starting", "a step starts from the impulses of the one before",
     &reference::copy_members<&Setup::warm_starting>},
    {"continuous", "what is swept between steps so that it hits and does not jump",
     &reference::copy_members<&Setup::continuous_when_fast>},
    {"walls", "how a wall is made, and where its skin lies", &reference::copy_members<&Setup::solid_walls>},
    {"inertia", "the moment of inertia of a ball", &reference::copy_members<&Setup::scene_inertia>},
}};

}  // namespace carom::box2d
