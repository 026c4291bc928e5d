#pragma once

#include <cstddef>
#include <vector>

#include "comparison/results.h"

namespace carom::page {

/// From which side a scene is drawn, and how much of it: the same for all of its engines.
struct View {
  /// Seen from the front, x to the right and y up; or one coordinate against time, where nothing moves across
  /// it.
  enum class Kind { plane, over_time };

  Kind kind = Kind::plane;
  int axis = 0;        ///< the coordinate that is drawn over time: 0 x, 1 y, 2 z
  double x_low = 0.0;  ///< m, or s over time
  double x_high = 1.0;
  double y_low = 0.0;  ///< m
  double y_high = 1.0;
};

/// How many balls have their path drawn; of the others only the end is.
inline constexpr std::size_t kDrawnPaths = 12;

/// The run whose paths decide what is in view: the truth's, else the first one under test, else any.
/// @return nothing where no run ended well and there is no truth
const Trajectory* leading_trajectory(const SceneComparison& scene);

/// @pre leading_trajectory(scene) is there
View view_of(const SceneComparison& scene);

}  // namespace carom::page
