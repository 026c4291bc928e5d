#pragma once

#include <chipmunk/chipmunk.h>

#include <array>
#include <cmath>
#include <string_view>

#include "engine/engine.h"
#include "reference/common/switches.h"

namespace carom::chipmunk {

/// Everything in which the profiles differ. CONVENTIONS.md says why each value is what it is.
struct Setup {
  int iterations = 10;
  double collision_bias = std::pow(0.9, 60.0);  ///< the share of an overlap that is left after a second
  double collision_slop_m = 0.1;
  int collision_persistence_steps = 3;
  bool thick_walls = false;    ///< thick segments whose surface is on the plane; else lines on it
  bool scene_inertia = false;  ///< the scene's inertia; else that of a disk
};

inline Setup setup_for(std::string_view profile) {
  Setup setup;
  if (profile == "default") return setup;
  setup.iterations = 100;
  setup.collision_bias = 1.0;
  setup.collision_slop_m = 0.0;
  // A step after the last touch the pair is forgotten. 0 would forget it before it is solved.
  setup.collision_persistence_steps = 1;
  setup.thick_walls = true;
  setup.scene_inertia = true;
  return setup;
}

/// Every setting in which the profiles differ, to be switched one by one.
inline constexpr std::array<reference::SetupSwitch<Setup>, 6> kSwitches = {{
    {"iterations", "rounds over all contacts until their impulses agree",
     &reference::copy_members<&Setup::iterations>},
    {"collision_bias", "the share of an overlap that is left after a second of pushing it out",
     &reference::copy_members<&Setup::collision_bias>},
    {"collision_slop_m", "the overlap that is not pushed out",
     &reference::copy_members<&Setup::collision_slop_m>},
    {"collision_persistence_steps", "how long the impulses of a pair that parted are remembered",
     &reference::copy_members<&Setup::collision_persistence_steps>},
    {"walls", "how a wall is made", &reference::copy_members<&Setup::thick_walls>},
    {"inertia", "the moment of inertia of a ball", &reference::copy_members<&Setup::scene_inertia>},
}};

}  // namespace carom::chipmunk
