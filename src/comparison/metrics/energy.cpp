#include "comparison/metrics/energy.h"

#include <algorithm>
#include <cmath>

#include "comparison/metrics/brought.h"

namespace carom {

namespace {

std::optional<double> above_zero(std::optional<double> value) {
  // In this order -0 becomes 0.
  return value ? std::optional(std::max(0.0, *value)) : value;
}

/// It pushes the others without an account of the work it does.
bool moving_immovable(const Scenario& s) {
  return ever(s, [](const Ball& ball) { return std::isinf(ball.mass) && !ball.velocity.isZero(0.0); });
}

/// Whether something in the scene can turn energy into heat.
bool dissipates(const Scenario& s) {
  const auto loses = [](const Contact& c) { return c.restitution < 1.0 || c.friction > 0.0; };
  return s.effects.drag || (s.effects.collisions && loses(s.ball_contact)) ||
         (!s.walls.empty() && loses(s.wall_contact));
}

}  // namespace

void measure_energy(const Yardstick& yardstick, const std::vector<Conserved>& conserved,
                    RunComparison& result) {
  const Scenario& scene = yardstick.scene();
  const double start_J = yardstick.reference().start.energy_J;
  const std::vector<Conserved> brought = brought_by_events(yardstick.reference(), result.run);
  const bool work_unknown = moving_immovable(scene);
  const bool heat = dissipates(scene);
  std::vector<double> gains;
  std::vector<double> losses;
  double lowest_J = start_J;
  for (std::size_t k = 0; k < conserved.size(); ++k) {
    const double energy_J = conserved[k].energy_J - brought[k].energy_J;
    result.series.energy.push_back(yardstick.by_energy(energy_J - start_J));
    if (yardstick.truth_known_at(k)) {
      gains.push_back(yardstick.by_energy(yardstick.energy_off_truth(conserved[k], k)));
      losses.push_back(-gains.back());
    } else if (!work_unknown) {
      if (heat) {
        gains.push_back(yardstick.by_energy(energy_J - lowest_J));
      } else {
        gains.push_back(yardstick.by_energy(energy_J - start_J));
        losses.push_back(-gains.back());
      }
    }
    lowest_J = std::min(lowest_J, energy_J);
  }
  const std::optional<double> gain = above_zero(largest(gains));
  const std::optional<double> loss = above_zero(largest(losses));
  result.metrics[Metric::energy_gain] = gain;
  result.metrics[Metric::energy_loss] = loss;
  if (gain || loss) result.metrics[Metric::energy] = std::max(gain.value_or(0.0), loss.value_or(0.0));
}

}  // namespace carom
