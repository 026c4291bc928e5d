#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "study/study.h"

namespace carom {

/// How many timed runs a setting gets whose run takes this long: fewer of a long one, which is hardly
/// disturbed.
int repeats_for(double cpu_s, int asked);

/// CPU time, s, that so many timed runs take of a setting whose run takes `cpu_s`, with all around them.
double timing_cost_s(double cpu_s, int runs);

/// What is known of a run before it is made, from those of the same engine that were.
struct Foresight {
  /// CPU time, s; nothing where no run tells.
  std::optional<double> cpu_s;
  /// A coarser step was stopped or left out, and a finer one takes longer.
  bool hopeless = false;
};

/// Time goes with the number of steps; it is told by the last coarser step of the same setting, or, for the
/// coarsest, by the same step of the engine as it comes.
/// @param points  of a scene, coarse steps first
Foresight foresee(const std::vector<StudyPoint>& points, std::size_t index);

/// Why a run with this outlook is not started; empty: it is.
std::string too_long(const Foresight& foresight, double timeout_s);

}  // namespace carom
