#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace carom {

/// Ways to look at a scene that nature does not notice: a twin of the scene, made so, must do what the scene
/// does. What each does to a scene stands at make_twin() (comparison/metamorphic.h).
enum class Symmetry {
  mirror,        ///< seen in a mirror
  rotate_90,     ///< turned by 90°: a permutation of the axes
  rotate_1_rad,  ///< turned by one radian: no axis is left where it was
  boost,         ///< seen from a frame that moves
  relabel,       ///< the balls in another order
  rescale_2,     ///< in units of length, time and mass that are powers of two of the old: no digit changes
  rescale_1_7,   ///< in units that are not
  reverse,       ///< run, turned back, and run again
};

inline constexpr std::array<std::string_view, 8> kSymmetryNames = {
    "mirror", "rotate-90", "rotate-1-rad", "boost", "relabel", "rescale-2", "rescale-1.7", "reverse"};

constexpr std::string_view name_of(Symmetry symmetry) {
  return kSymmetryNames[static_cast<std::size_t>(symmetry)];
}

}  // namespace carom
