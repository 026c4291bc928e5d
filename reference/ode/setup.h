#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "engine/engine.h"
#include "reference/common/scene_scale.h"
#include "reference/common/switches.h"

namespace carom::ode {

/// How friction is bounded.
enum class Friction {
  constant_force,  ///< by μ newtons, whatever the normal force, along two fixed directions: the library's
                   ///< default
  coulomb,         ///< by μ times the normal force, along the direction of slip
};

/// Cells of the broad phase have edges of 2^smallest … 2^largest m.
struct CellSizes {
  int smallest = -3;
  int largest = 10;
};

/// Everything in which the profiles differ. CONVENTIONS.md says why each value is what it is.
struct Setup {
  double velocity_threshold_mps = 0.1;
  int iterations = 20;
  double over_relaxation = 1.3;
  double erp = 0.2;
  double cfm = 1e-10;
  Friction friction = Friction::constant_force;
  bool gyroscopic = true;
  CellSizes cells;
};

/// Cells for fidelity, which here means: so that a scene of any size takes no longer than it must. ODE gives
/// a box that is d wide the smallest power of two above d, and what is larger than the largest cell is held
/// against everything.
inline CellSizes cells_for(const Scenario& scene) {
  double largest_m = reference::smallest_radius_m(scene);
  for (const Ball& ball : scene.balls) largest_m = std::max(largest_m, ball.radius);
  // A box is as wide as its ball, give or take what adding places rounds.
  constexpr double kSpare = 1.0 + 1e-6;
  const auto level = [](double radius_m) { return std::ilogb(2.0 * kSpare * radius_m) + 1; };
  return {level(reference::smallest_radius_m(scene)), level(largest_m)};
}

inline Setup setup_for(const Scenario& scene, std::string_view profile) {
  Setup setup;
  if (profile == "default") return setup;
  setup.velocity_threshold_mps = 0.0;
  setup.iterations = 50;
  setup.over_relaxation = 1.0;
  setup.erp = 0.0;
  setup.cfm = 0.0;
  setup.friction = Friction::coulomb;
  setup.gyroscopic = false;
  setup.cells = cells_for(scene);
  return setup;
}

/// Every setting in which the profiles differ, to be switched one by one.
inline constexpr std::array<reference::SetupSwitch<Setup>, 8> kSwitches = {{
    {"velocity_threshold_mps", "a slower impact loses its bounce",
     &reference::copy_members<&Setup::velocity_threshold_mps>},
    {"iterations", "rounds over all contacts until their impulses agree",
     &reference::copy_members<&Setup::iterations>},
    {"over_relaxation", "by how much each round overshoots",
     &reference::copy_members<&Setup::over_relaxation>},
    {"erp", "the share of an overlap that is pushed out in a step", &reference::copy_members<&Setup::erp>},
    {"cfm", "how far a contact gives way to force, s/kg", &reference::copy_members<&Setup::cfm>},
    {"friction_law", "what bounds friction", &reference::copy_members<&Setup::friction>},
    {"gyroscopic", "a torque that a sphere does not have", &reference::copy_members<&Setup::gyroscopic>},
    {"cell_levels", "powers of two of the broad phase's cells, m", &reference::copy_members<&Setup::cells>},
}};

}  // namespace carom::ode
