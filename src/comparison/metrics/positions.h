#pragma once

#include "comparison/metrics/yardstick.h"

namespace carom {

/// The distances of the balls in one trajectory from themselves in another, over the frames put in so far.
class Distances {
 public:
  /// Adds a frame. @return the largest distance in it, m
  double add(const Trajectory& a, const Trajectory& b, std::size_t frame);

  /// √(Σ d² / count) over all balls and frames, m; 0 where there are none.
  double root_mean_square() const;

 private:
  double squares_ = 0.0;
  std::size_t count_ = 0;
};

/// Measures `position` and `position_rms` of a run against the truth, and the series of the former over the
/// frames.
void measure_positions(const Yardstick& yardstick, RunComparison& result);

}  // namespace carom
