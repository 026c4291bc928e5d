#pragma once

#include <btBulletDynamicsCommon.h>

#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "engine/engine.h"
#include "reference/common/scene_scale.h"
#include "reference/common/switches.h"

namespace carom::bullet {

/// Machine epsilon of the precision that Bullet was built in.
constexpr double kEpsilon = std::numeric_limits<btScalar>::epsilon();

/// Everything in which the profiles differ. CONVENTIONS.md says why each value is what it is.
struct Setup {
  double length_scale = 1.0;  ///< Bullet length units per metre of the scene, a power of two
  double velocity_threshold_mps = 0.2;
  int iterations = 10;
  double erp2 = 0.2;
  bool split_impulse = true;
  double warm_starting_factor = 0.85;
  bool fresh_points = false;  ///< forget the contact points of earlier steps before each step
  bool gyroscopic = true;
  bool sleeping = true;
  bool bounded_planes = false;  ///< walls are only tested against balls near them; else against all
  double contact_processing_threshold_m = BT_LARGE_FLOAT;
  double ccd_motion_threshold_radii = 0.0;  ///< 0: no continuous collision
  double ccd_swept_radius_radii = 0.0;
};

// Bullet holds a body's rotation to a quarter turn per step.
constexpr double kMaxTurn_rad = SIMD_HALF_PI;
// Bullet takes a step of this length or less, in seconds, for none at all.
constexpr double kShortestStep_s = kEpsilon;
// Damping is the float nearest to 1 - e^{-c/m}; the velocity left after a second, e^{-c/m}, keeps this
// relative accuracy or the scene is refused.
constexpr double kDampingAccuracy = 1e-3;
// A ball that moves more than its radius in a step is fast. Two balls below that close in by r_a + r_b at
// most, the depth through which they overlap and still approach, so that none jumps through another's centre.
constexpr double kFastRadiiPerStep = 1.0;
// A fast ball is swept as a sphere of this part of its radius, so that it stops where it overlaps and the
// next step's detection sees it; with its full radius it would stop where it only touches, and be missed.
constexpr double kSweptRadii = 0.5;
// Bullet's absolute margins suit bodies of 0.05 to 10 units, so the smallest ball gets about this radius.
constexpr double kRadiusUnits = 0.5;

inline Setup setup_for(const Scenario& scene, std::string_view profile) {
  Setup setup;
  if (profile == "default") return setup;
  // Rounding down to a power of two costs up to a factor of two, so the target is the upper end.
  setup.length_scale =
      reference::power_of_two_below(std::sqrt(2.0) * kRadiusUnits / reference::smallest_radius_m(scene));
  setup.velocity_threshold_mps = 0.0;
  setup.iterations = 50;
  setup.erp2 = 0.0;
  setup.split_impulse = false;
  setup.warm_starting_factor = 0.0;
  setup.fresh_points = true;
  setup.gyroscopic = false;
  setup.sleeping = false;
  setup.bounded_planes = true;
  setup.contact_processing_threshold_m = 0.0;
  setup.ccd_motion_threshold_radii = kFastRadiiPerStep;
  setup.ccd_swept_radius_radii = kSweptRadii;
  return setup;
}

/// Every setting in which the profiles differ, to be switched one by one.
inline constexpr std::array<reference::SetupSwitch<Setup>, 12> kSwitches = {{
    {"length_scale", "Bullet's length units per metre: its absolute margins against the balls",
     &reference::copy_members<&Setup::length_scale>},
    {"velocity_threshold_mps", "a slower impact loses its bounce",
     &reference::copy_members<&Setup::velocity_threshold_mps>},
    {"velocity_iterations", "rounds over all contacts until their impulses agree",
     &reference::copy_members<&Setup::iterations>},
    {"erp2", "the share of an overlap that is pushed out in a step", &reference::copy_members<&Setup::erp2>},
    {"split_impulse", "deep overlaps are pushed out without a velocity",
     &reference::copy_members<&Setup::split_impulse>},
    {"warm_starting_factor", "a step starts from the impulses of the one before",
     &reference::copy_members<&Setup::warm_starting_factor>},
    {"contact_points", "whether points of earlier steps go on pushing",
     &reference::copy_members<&Setup::fresh_points>},
    {"gyroscopic", "a torque that a sphere does not have", &reference::copy_members<&Setup::gyroscopic>},
    {"sleeping", "slow bodies are stopped", &reference::copy_members<&Setup::sleeping>},
    {"walls", "against which balls a wall is tested", &reference::copy_members<&Setup::bounded_planes>},
    {"contact_processing_threshold_m", "up to which distance a contact acts before the balls touch",
     &reference::copy_members<&Setup::contact_processing_threshold_m>},
    {"continuous", "what is swept between steps so that it hits and does not jump",
     &reference::copy_members<&Setup::ccd_motion_threshold_radii, &Setup::ccd_swept_radius_radii>},
}};

}  // namespace carom::bullet
