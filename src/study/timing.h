#pragma once

#include <cstdint>

#include "trajectory/record.h"

namespace carom {

/// A timed run is repeated until it has taken this long: a thousand times what it takes to read the clock.
inline constexpr double kLeast_s = 2e-3;
/// Warming up ends after a run, or after this time.
inline constexpr double kWarm_s = 5e-3;
/// What a process of its own takes to begin and to end, about.
inline constexpr double kStart_s = 2e-3;

/// What one timed run came to.
struct Timing {
  double cpu_s = 0.0;        ///< of the stepping alone, of one run over the duration
  std::int64_t impacts = 0;  ///< at its end
};

/// Runs a scene with nothing recorded and says how long the stepping took: first to warm up (caches, pages,
/// the clock of the processor), then as often as it takes to be well above the resolution of the clock, of
/// which the mean is taken. To be called in a process of its own.
/// @pre the engine can run the scene
Timing time_run(const Scenario& scene, const EngineChoice& choice);

/// The same in a process of its own, with nothing else of this program running. @return its outcome; the
/// payload is read by timing_from()
ProcessOutcome time_isolated(const Scenario& scene, const EngineChoice& choice, const ProcessLimits& limits);

/// A timing as text, and back.
std::string timing_text(const Timing& timing);
Timing timing_from(const std::string& payload);

}  // namespace carom
