#pragma once

#include <cstdint>
#include <memory>

#include "engine/truth_source.h"
#include "reference/converged/flight.h"

namespace carom {

/// How a converged truth is computed: twice.
struct ConvergedSettings {
  /// The run that is handed out: 113 bits, that is all of a quadruple.
  converged::Accuracy fine = {.order = 30, .bits = converged::kRealBits};
  /// The run that it is compared with: other steps, and 2^13 times coarser.
  converged::Accuracy coarse = {.order = 22, .bits = 100};
  /// The truth ends where it is not sure to this part of the scene's size.
  double tolerance = 1e-12;
  /// The truth ends where a run has taken so many multiplications, about a second's.
  std::int64_t most_work = 12'000'000;
};

/// Truths by integration, for scenes whose flights have no closed form or whose balls meet on them: linear or
/// quadratic drag and the Magnus force, each with gravity, with impacts of balls and walls. It shares no code
/// with any engine that it is the truth for.
///
/// Flights are Taylor polynomials of high order in quadruple precision; impacts are found on them by steps
/// that provably pass none. The scene is solved twice, with different orders, steps and precisions, and the
/// uncertainty is what the two differ by, times kSafety, and the rounding to double. A scene without drag or
/// Magnus force is taken only where it asks for this kind by name: the exact source does better there.
std::unique_ptr<TruthSource> make_converged_truth(const ConvergedSettings& settings = {});

}  // namespace carom
