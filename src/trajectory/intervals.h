#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenario/scenario.h"

namespace carom {

/// The number of equal steps, none longer than the scene's step, that an interval between frames is cut into.
std::int64_t steps_per_frame(const Scenario& scenario);

/// A part of the time between two frames: so many equal steps, after which so many events happen.
struct Part {
  double step_s = 0.0;
  std::int64_t steps = 0;  ///< 0: the events happen at once
  std::size_t events = 0;
};

/// The parts of the interval that ends with a frame, the same for every engine; of frame 0 what happens at
/// the start.
///
/// An interval without events is one part of steps_per_frame() steps. Events cut it. An event at the end of
/// one of those steps, but for same_moment_s(), changes no step: what comes before and after it is stepped as
/// it would be without it, bit for bit. One within a step cuts: the part before and the part after, up to the
/// next event or to the frame, are each cut into the smallest whole number of equal steps no longer than the
/// scene's. @param first_event  the events before it happen up to the frame before
std::vector<Part> parts_of_interval(const Scenario& scenario, std::int64_t frame, std::size_t first_event);

}  // namespace carom
