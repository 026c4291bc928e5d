#pragma once

#include <cstdint>

#include "engine/truth_source.h"

namespace carom::exact {

/// How far a solution goes, and for what it counts as certified.
struct Demands {
  int digits = 40;         ///< of the first run, P; its twin has 2 P
  int most_digits = 2560;  ///< of any run
  /// By how much two runs may differ, of the scene's scale in positions and of its speed in velocities. Four
  /// orders below the rounding of a double: of what is handed out less than one number in ten thousand is not
  /// the double next to the truth.
  double tolerance = 1e-20;
  std::int64_t budget = 500'000'000;  ///< in steps of about 10 ns, for all runs together
};

/// Follows a scene in arithmetic of P and of 2 P digits at once and hands out its states as long as the two
/// agree: the same impacts of every ball in the same order, and all positions, velocities and spins to the
/// tolerance. Where they do not, P is doubled; the run with 2 P takes the place of that with P.
///
/// Two runs that differ by δ are both off by about that, the one with more digits by far less: rounding, at
/// 10^-P and 10^-2P, grows in both by the same factor. The states handed out are those of the one with more.
/// @pre refuses() (exact.h) says nothing
Solution certify(const Scenario& scene, std::span<const Moment> moments, const TruthSource::Taker& take,
                 const Demands& demands);

}  // namespace carom::exact
