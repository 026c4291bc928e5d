#include "comparison/metrics/positions.h"

#include <algorithm>
#include <cmath>

namespace carom {

double Distances::add(const Trajectory& a, const Trajectory& b, std::size_t frame) {
  double farthest_square = 0.0;
  const auto balls_a = a.frame(frame);
  const auto balls_b = b.frame(frame);
  for (std::size_t i = 0; i < balls_a.size(); ++i) {
    if (!a.present(frame, i)) continue;
    ++count_;
    const double square = (balls_a[i].position - balls_b[i].position).squaredNorm();
    farthest_square = std::max(farthest_square, square);
    squares_ += square;
  }
  return std::sqrt(farthest_square);
}

double Distances::root_mean_square() const {
  return std::sqrt(squares_ / static_cast<double>(std::max<std::size_t>(count_, 1)));
}

void measure_positions(const Yardstick& yardstick, RunComparison& result) {
  Distances distances;
  const Trajectory& trajectory = result.run.trajectory;
  for (std::size_t k = 0; k < trajectory.frames(); ++k) {
    result.series.position.push_back(
        yardstick.truth_known_at(k) ? distances.add(trajectory, yardstick.truth().trajectory, k) : kNotKnown);
  }
  result.metrics[Metric::position] = largest(result.series.position);
  if (yardstick.truth().known()) result.metrics[Metric::position_rms] = distances.root_mean_square();
}

}  // namespace carom
