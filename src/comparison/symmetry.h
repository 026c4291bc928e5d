#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/symmetry.h"

namespace carom {

/// How well an engine keeps a symmetry of a scene.
enum class SymmetryVerdict {
  to_the_bit,       ///< the twin's states, mapped back, are the scene's, digit for digit
  to_rounding,      ///< they differ by no more than rounding does in this scene and this precision
  broken,           ///< they differ by more
  does_not_apply,   ///< the scene itself does not have the symmetry
  twin_did_not_run  ///< the engine refused the twin, or failed in it
};

/// What one symmetry came to in one run of a scene: data only, made by check_symmetries()
/// (check_symmetries.h).
struct SymmetryResult {
  Symmetry symmetry = Symmetry::mirror;
  SymmetryVerdict verdict = SymmetryVerdict::does_not_apply;
  std::string reason;  ///< why there is no value
  std::optional<double>
      position_radii;            ///< max over balls and frames of the distance, by the smallest radius
  std::optional<double> energy;  ///< max over frames of the difference, by the scene's energy scale
};

/// All symmetries that a scene asks for, in one run of it.
struct RunSymmetries {
  /// How far apart the scene and a twin of it come that is disturbed by what rounding can add up to, by the
  /// smallest radius: beyond it a symmetry is broken. Nothing where that twin did not run.
  std::optional<double> floor_radii;
  std::vector<SymmetryResult> checks;

  /// The largest position_radii: what a gate can limit. Nothing where no check applies, or a twin did not
  /// run.
  std::optional<double> worst_radii() const;
};

/// In plain words, as in results: "to the bit", …
std::string_view name_of(SymmetryVerdict verdict);

}  // namespace carom
