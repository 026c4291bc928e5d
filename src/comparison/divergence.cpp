#include "comparison/divergence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace carom {

namespace {

/// Two trajectories have parted once a ball is off by this share of the smallest radius: less than the width
/// of a line in a drawing of the scene.
constexpr double kDivergedShareOfRadius = 1e-3;
/// The same for energy and momentum, relative to their scales: no drawing of them would show it.
constexpr double kDivergedConserved = 1e-3;

/// The ball that is off the most, and the second where it is off by at least a tenth as much.
std::vector<std::size_t> most_different(const Trajectory& a, const Trajectory& b, std::size_t frame) {
  constexpr double kAsFarOff = 0.1;
  std::vector<std::pair<double, std::size_t>> distances;
  for (std::size_t i = 0; i < a.balls(); ++i) {
    if (!a.present(frame, i)) continue;
    distances.emplace_back((a.frame(frame)[i].position - b.frame(frame)[i].position).norm(), i);
  }
  const std::size_t named = std::min<std::size_t>(2, distances.size());
  std::partial_sort(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(named),
                    distances.end(), [](const auto& x, const auto& y) {
                      return x.first > y.first || (x.first == y.first && x.second < y.second);
                    });
  std::vector<std::size_t> balls;
  for (std::size_t rank = 0; rank < named; ++rank) {
    if (rank == 0 || distances[rank].first >= kAsFarOff * distances[0].first) {
      balls.push_back(distances[rank].second);
    }
  }
  std::sort(balls.begin(), balls.end());
  return balls;
}

/// Of the balls named, the one that is off the most in this frame.
std::size_t farthest_off(const Divergence& divergence, const Trajectory& run, const Trajectory& truth,
                         std::size_t frame) {
  const auto off = [&](std::size_t ball) {
    return (run.frame(frame)[ball].position - truth.frame(frame)[ball].position).norm();
  };
  return *std::max_element(divergence.balls.begin(), divergence.balls.end(),
                           [&](std::size_t a, std::size_t b) { return off(a) < off(b); });
}

/// From the frame of the divergence back to where the ball was last off by less than a hundredth of what it
/// is off there: in the interval after that frame it went wrong, by its last true impact up to then.
std::optional<TrueImpact> cause_of(const Divergence& divergence, const Trajectory& run, const Truth& truth) {
  constexpr double kNotYet = 0.01;
  std::size_t frame = 0;
  while (frame + 1 < run.frames() && run.time(frame) < divergence.time_s) ++frame;
  const std::size_t ball = farthest_off(divergence, run, truth.trajectory, frame);
  const auto off = [&](std::size_t k) {
    return (run.frame(k)[ball].position - truth.trajectory.frame(k)[ball].position).norm();
  };
  const double at_divergence = off(frame);
  while (frame > 0 && off(frame - 1) >= kNotYet * at_divergence) --frame;
  std::optional<TrueImpact> last;
  for (const TrueImpact& impact : truth.solution.impacts) {
    if (impact.time_s > run.time(frame)) break;
    if (impact.ball == ball || (!impact.wall && impact.partner == ball)) last = impact;
  }
  return last;
}

}  // namespace

double position_tolerance_m(const Scenario& scene) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Ball& ball : scene.balls) smallest = std::min(smallest, ball.radius);
  return kDivergedShareOfRadius * smallest;
}

std::optional<Divergence> first_divergence(const Trajectory& a, const Trajectory& b, const Apart& apart,
                                           double tolerance_m) {
  for (std::size_t k = 0; k < apart.position_m.size(); ++k) {
    Divergence divergence{a.time(k), most_different(a, b, k), Metric::position};
    if (apart.position_m[k] > tolerance_m) return divergence;
    if (apart.energy[k] > kDivergedConserved) divergence.metric = Metric::energy;
    if (apart.momentum[k] > kDivergedConserved) divergence.metric = Metric::momentum;
    if (divergence.metric != Metric::position) return divergence;
  }
  return std::nullopt;
}

std::optional<Divergence> divergence_from_truth(const Yardstick& yardstick,
                                                const std::vector<Conserved>& conserved,
                                                const RunComparison& measured, double tolerance_m) {
  const Truth& truth = yardstick.truth();
  if (!truth.known()) return std::nullopt;
  Apart apart{measured.series.position, {}, measured.series.momentum};
  for (std::size_t k = 0; k < conserved.size(); ++k) {
    apart.energy.push_back(yardstick.truth_known_at(k)
                               ? yardstick.by_energy(std::abs(yardstick.energy_off_truth(conserved[k], k)))
                               : kNotKnown);
  }
  std::optional<Divergence> divergence =
      first_divergence(measured.run.trajectory, truth.trajectory, apart, tolerance_m);
  if (divergence) divergence->cause = cause_of(*divergence, measured.run.trajectory, truth);
  return divergence;
}

}  // namespace carom
