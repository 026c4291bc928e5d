#pragma once

#include <string>
#include <vector>

#include "scenario/cast.h"

namespace carom {

/// What one event did to the balls of one run, whose states at that moment are its engine's own.
struct Interference {
  double time_s = 0.0;
  std::vector<BallChange> changes;
  /// The deepest overlap of a changed ball with another ball or a wall right after it, by the smaller radius:
  /// a ball that grows or is put somewhere may then overlap what is there. 0 where nothing overlaps.
  double overlap_radii = 0.0;
};

/// How deep this ball overlaps a wall or a ball that it cannot pass through, by the smaller radius.
double overlap_radii(const Scenario& scene, const Cast& cast, std::size_t ball);

/// A text that holds them, for the way from one process to another, and back; the same bits.
std::string packed(const std::vector<Interference>& interferences);
std::vector<Interference> unpacked_interferences(const std::string& text);

}  // namespace carom
