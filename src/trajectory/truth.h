#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/truth_source.h"
#include "trajectory/isolate.h"
#include "trajectory/trajectory.h"

namespace carom {

/// What a run is measured against, frame by frame: the trajectory of a source that knows it, and how sure it
/// is.
struct Truth {
  std::string kind = "none";        ///< "closed-form", "exact", "converged", or "none"
  std::string reason;               ///< why there is none
  double uncertainty_m = 0.0;       ///< a bound on the error of every position
  std::optional<double> horizon_s;  ///< until when it can be held against a run; nothing: the whole duration
  Trajectory trajectory;
  /// The same at times shortly before and shortly after each frame. At an impact velocities have two values,
  /// and an engine that is right but for rounding may show either of them. Empty where there is nothing but
  /// `trajectory`.
  std::vector<Trajectory> around;
  Solution solution;         ///< what else the source told; its amplification is that of each frame
  double cpu_seconds = 0.0;  ///< that it took

  bool known() const { return kind != "none"; }
};

/// Solves the scene by the first of the sources that can, in a process of its own; scene.truth says which are
/// asked. Events start from what each engine has come to, which is its own: the truth ends with the last
/// frame before the first of them.
Truth record_truth(const Scenario& scenario, const std::vector<std::shared_ptr<const TruthSource>>& sources,
                   const ProcessLimits& limits);

}  // namespace carom
