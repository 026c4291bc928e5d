#include "study/impact_times.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace carom {

namespace {

/// Frames from the one before an impact to the one by which every engine has met it.
constexpr std::size_t kFramesAround = 2;
/// A velocity that changes by less than this part of the speed does not tell a time.
constexpr double kTells = 1e-3;
/// Of the true change of a velocity; a run that has less of it has missed the impact.
constexpr double kMet = 0.5;

/// The times of each ball's true impacts, ascending.
std::vector<std::vector<double>> impacts_of_balls(const Scenario& scene, const Truth& truth) {
  std::vector<std::vector<double>> times(scene.balls.size());
  for (const TrueImpact& impact : truth.solution.impacts) {
    times[impact.ball].push_back(impact.time_s);
    if (!impact.wall) times[impact.partner].push_back(impact.time_s);
  }
  return times;
}

/// Whether this is the only one of the ascending times in [from, to].
bool is_alone(const std::vector<double>& times, double from, double to) {
  const auto first = std::lower_bound(times.begin(), times.end(), from);
  return std::upper_bound(first, times.end(), to) - first == 1;
}

/// (1), of the ball's states in two frames.
double turning_time_s(const BallState& before, double before_s, const BallState& after, double after_s,
                      const Vec3& gravity) {
  // At t_0 = before_s.
  const double back_s = before_s - after_s;
  const Vec3 place = after.position + after.velocity * back_s + 0.5 * back_s * back_s * gravity;
  const Vec3 apart = place - before.position;
  const Vec3 parting = after.velocity + back_s * gravity - before.velocity;
  return before_s - apart.dot(parting) / parting.squaredNorm();
}

}  // namespace

std::optional<double> impact_time_error_s(const Scenario& scene, const Truth& truth, const Run& run) {
  if (scene.effects.drag || scene.effects.magnus || !scene.events.empty()) return std::nullopt;
  const std::vector<std::vector<double>> times = impacts_of_balls(scene, truth);
  const Vec3 gravity = scene.effects.gravity.value_or(Vec3::Zero());
  const double interval_s = scene.duration_s / static_cast<double>(scene.frames);
  const double until_s = truth.horizon_s.value_or(scene.duration_s);
  std::optional<double> worst_s;
  for (std::size_t ball = 0; ball < times.size(); ++ball) {
    for (const double time_s : times[ball]) {
      const auto frame = static_cast<std::size_t>(time_s / interval_s);
      const std::size_t last = frame + kFramesAround;
      if (last >= run.trajectory.frames() || run.trajectory.time(last) > until_s) continue;
      const double before_s = run.trajectory.time(frame);
      const double after_s = run.trajectory.time(last);
      if (!is_alone(times[ball], before_s, after_s)) continue;
      const Vec3 flown = (after_s - before_s) * gravity;
      const BallState& true_before = truth.trajectory.frame(frame)[ball];
      const double true_change =
          (truth.trajectory.frame(last)[ball].velocity - true_before.velocity - flown).norm();
      if (true_change <= kTells * true_before.velocity.norm()) continue;
      const BallState& before = run.trajectory.frame(frame)[ball];
      const BallState& after = run.trajectory.frame(last)[ball];
      if ((after.velocity - before.velocity - flown).norm() < kMet * true_change) return std::nullopt;
      const double off_s = std::abs(turning_time_s(before, before_s, after, after_s, gravity) - time_s);
      worst_s = std::max(worst_s.value_or(0.0), off_s);
    }
  }
  return worst_s;
}

}  // namespace carom
