#pragma once

#include <optional>
#include <vector>

#include "comparison/metrics/yardstick.h"

namespace carom {

/// How far two trajectories are apart, frame by frame; kNotKnown where it is not known.
struct Apart {
  std::vector<double> position_m;  ///< the largest distance of a ball from itself
  std::vector<double> energy;      ///< |ΔE| / E_scale
  std::vector<double> momentum;    ///< |ΔP| / P_scale
};

/// Beyond this distance of a ball from itself two trajectories count as diverged, m.
double position_tolerance_m(const Scenario& scene);

/// The first frame in which one of the series passes its tolerance, and the balls that are off the most in
/// it. Of the series that pass in the same frame the position is named first: it says which balls.
std::optional<Divergence> first_divergence(const Trajectory& a, const Trajectory& b, const Apart& apart,
                                           double tolerance_m);

/// Where a measured run first leaves the truth; nothing where there is no truth.
std::optional<Divergence> divergence_from_truth(const Yardstick& yardstick,
                                                const std::vector<Conserved>& conserved,
                                                const RunComparison& measured, double tolerance_m);

}  // namespace carom
