#include "comparison/metrics/yardstick.h"

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

double size_of(double difference) {
  return std::abs(difference);
}

double size_of(const Vec3& difference) {
  return difference.norm();
}

/// What is left of a difference from the truth, the nearest of the truth's values at this frame being taken.
template <class Difference>
auto nearest(const std::vector<std::vector<Conserved>>& truth, std::size_t frame,
             const Difference& difference) {
  auto least = difference(truth.front()[frame]);
  for (const std::vector<Conserved>& values : truth) {
    const auto other = difference(values[frame]);
    if (size_of(other) < size_of(least)) least = other;
  }
  return least;
}

}  // namespace

std::optional<double> largest(const std::vector<double>& values) {
  std::optional<double> result;
  for (const double value : values) {
    if (!std::isnan(value)) result = std::max(result.value_or(value), value);
  }
  return result;
}

Yardstick::Yardstick(const Scenario& scene, const Truth& truth)
    : scene_(scene), truth_(truth), reference_(scene) {
  if (!truth.known()) return;
  truth_conserved_.push_back(conserved_of(truth.trajectory));
  for (const Trajectory& around : truth.around) truth_conserved_.push_back(conserved_of(around));
}

double Yardstick::relative(double deviation, double scale) {
  if (scale > 0.0) return deviation / scale;
  return deviation == 0.0 ? 0.0 : kNotKnown;
}

std::vector<Conserved> Yardstick::conserved_of(const Trajectory& trajectory) const {
  std::vector<Conserved> conserved;
  Cast cast(scene_);
  for (std::size_t k = 0; k < trajectory.frames(); ++k) {
    cast.to_frame(static_cast<std::int64_t>(k));
    conserved.push_back(reference_.of(trajectory.frame(k), cast));
  }
  return conserved;
}

bool Yardstick::truth_known_at(std::size_t frame) const {
  return truth_.known() && truth_.trajectory.time(frame) <= truth_.horizon_s.value_or(scene_.duration_s);
}

double Yardstick::energy_off_truth(const Conserved& now, std::size_t frame) const {
  return nearest(truth_conserved_, frame,
                 [&](const Conserved& truth) { return now.energy_J - truth.energy_J; });
}

Vec3 Yardstick::momentum_off_truth(const Conserved& now, std::size_t frame) const {
  return nearest(truth_conserved_, frame,
                 [&](const Conserved& truth) -> Vec3 { return now.momentum_Ns - truth.momentum_Ns; });
}

Vec3 Yardstick::angular_momentum_off_truth(const Conserved& now, std::size_t frame) const {
  return nearest(truth_conserved_, frame, [&](const Conserved& truth) -> Vec3 {
    return now.angular_momentum_Nms - truth.angular_momentum_Nms;
  });
}

}  // namespace carom
