#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "comparison/comparison.h"
#include "comparison/conserved.h"
#include "scenario/scenario.h"

namespace carom {

/// A value of a series where nothing is known.
inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// The largest of the values that are known; nothing where none is.
std::optional<double> largest(const std::vector<double>& values);

/// What every run of one scene is measured with: the scene, its truth, and the scales that deviations are
/// divided by. The scene and the truth must outlive it.
class Yardstick {
 public:
  Yardstick(const Scenario& scene, const Truth& truth);

  const Scenario& scene() const { return scene_; }
  const Truth& truth() const { return truth_; }
  const Reference& reference() const { return reference_; }

  /// A deviation by its scale. Where the scale is zero no deviation is none, and any other cannot be told.
  double by_energy(double deviation_J) const { return relative(deviation_J, reference_.energy_scale_J); }
  double by_momentum(double deviation_Ns) const {
    return relative(deviation_Ns, reference_.momentum_scale_Ns);
  }
  double by_angular_momentum(double deviation_Nms) const {
    return relative(deviation_Nms, reference_.angular_momentum_scale_Nms);
  }

  /// In every frame.
  std::vector<Conserved> conserved_of(const Trajectory& trajectory) const;

  bool truth_known_at(std::size_t frame) const;

  /// How far a quantity is off the truth's, the nearest of the truth's values around this frame being taken
  /// (Truth::around). The truth must be known.
  double energy_off_truth(const Conserved& now, std::size_t frame) const;          ///< J
  Vec3 momentum_off_truth(const Conserved& now, std::size_t frame) const;          ///< N s
  Vec3 angular_momentum_off_truth(const Conserved& now, std::size_t frame) const;  ///< N m s

 private:
  static double relative(double deviation, double scale);

  const Scenario& scene_;
  const Truth& truth_;
  Reference reference_;
  std::vector<std::vector<Conserved>> truth_conserved_;  ///< at the frames, then at times around them
};

}  // namespace carom
