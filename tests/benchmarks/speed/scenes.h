#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.h"

namespace carom::benchmark {

// The balls that all engines are timed with: radius 0.5 m, mass 1 kg, speed 1 m/s (root mean square),
// elastic, without gravity, in closed walls, step 1/240 s.

/// How balls are spread over a box.
struct Layout {
  std::string name;  ///< as the page calls it
  int dimension = 3;
  double packing = 0.1;      ///< the share of the box that they fill
  double size_ratio = 1.0;   ///< of the largest to the smallest radius
  bool in_a_corner = false;  ///< walled in, in one corner of a box that is ten times as wide
};

/// A gas of packing 0.1.
Layout gas(int dimension);

/// The hard-sphere gas nσ³ = 0.5, packing π/12.
Layout hard_sphere_gas();

/// What the growth of the cost is measured in.
std::vector<Layout> growth_layouts();

/// As a scene file says it; the walls of a corner are put there by scene_of().
std::string toml_of(const Layout& layout, std::size_t balls);

Scenario scene_of(const Layout& layout, std::size_t balls);

}  // namespace carom::benchmark
