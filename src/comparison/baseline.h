#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "comparison/results.h"

namespace carom {

/// The values of one scene as they were when the baseline was written.
struct BaselineScene {
  std::string sha256;  ///< of the scene's file: values of another file say nothing
  double step_s = 0.0;
  std::optional<std::uint64_t> seed;       ///< of --seed, where one was given
  std::map<std::string, Metrics> engines;  ///< by label (engine_label())

  bool same_scene(const BaselineScene& other) const {
    return sha256 == other.sha256 && step_s == other.step_s && seed == other.seed;
  }
};

/// What every engine measured once, scene by scene: what later results are held against.
struct Baseline {
  std::string file;  ///< where it was read; empty where it was not
  std::map<std::string, BaselineScene> scenes;
};

/// The values of these results: every metric that applies, of every run that ended well.
Baseline baseline_of(const Results& results);

/// What `newer` says, and of `older` what `newer` says nothing about: scenes that were not run, and engines
/// that did not take part in a scene that is still the same.
Baseline merged(Baseline older, const Baseline& newer);

/// Below this a value is rounding, and twice of it is no worse than once.
///
/// A state is rounded whenever it is updated: at most S + C times, for S steps and C impacts, with about k =
/// 10 operations each; adding up N balls for a metric rounds N times more. A rounding errs by a number spread
/// evenly over ±ε/2 of what it rounds, standard deviation ε/√12, and they do not know of each other: n of
/// them together stay within six of their standard deviations, 6 ε √(n/12) = ε √(3n), n = k (S + C + N),
/// times the largest number that was rounded, by the metric's scale:
/// - energy: the largest kinetic energy, by E_scale; momentum: the largest Σ m|v|, by P_scale;
/// - position: the farthest coordinate, and the speed times the duration, for a velocity's error grows into
/// one;
///   and what the truth itself does not know;
/// - angular momentum: as the momentum at that reach, by L_scale; penetration: as the position, by the
/// smallest
///   radius;
/// - escaped is a count, and has no rounding; a symmetry has a floor of its own (RunSymmetries), and a
/// statistic
///   is told in allowances, within one of which it is chance.
/// ε is that of the engine's precision. Where the truth knows by how much the scene makes errors grow
/// (Solution::amplification), position and angular momentum are given that much more. Where nothing knows it,
/// more can be rounding than this: a larger factor serves there.
double rounding_floor(const SceneComparison& scene, const RunComparison& run, Metric metric);

/// Holds every run against the baseline's values. Each becomes a gate of the run, `factor` times the larger
/// of the baseline's value and the rounding floor; a metric that had a value and has none cannot hold. What
/// could not be compared, and what became better by more than the factor, stands in Results::baseline.
/// @pre factor >= 1
void hold_against(const Baseline& baseline, double factor, Results& results);

}  // namespace carom
