#include "comparison/metrics/momentum.h"

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

/// Σ Δx of the movable balls, m: linear drag takes c times this from the momentum, whatever happens on the
/// way.
Vec3 displacement(const Scenario& scene, const Run& run, std::size_t frame) {
  Vec3 sum = Vec3::Zero();
  const auto balls = run.trajectory.frame(frame);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    if (std::isfinite(scene.balls[i].mass)) sum += balls[i].position - scene.balls[i].position;
  }
  return sum;
}

/// N s; unknown where nothing tells what to expect.
double momentum_error(const Yardstick& yardstick, const Conserved& now, const Run& run, std::size_t frame) {
  const Scenario& scene = yardstick.scene();
  const Reference& reference = yardstick.reference();
  const Tally& tally = run.trajectory.tally(frame);
  // What these take from the momentum depends on the whole path.
  const bool quadratic = scene.effects.drag && scene.effects.drag->kind == Drag::Kind::quadratic;
  if (quadratic || scene.effects.magnus || !tally.external_known || !scene.events.empty()) {
    return yardstick.truth_known_at(frame) ? yardstick.momentum_off_truth(now, frame).norm() : kNotKnown;
  }
  Vec3 expected = reference.start.momentum_Ns + tally.external_impulse;
  if (scene.effects.gravity) {
    expected += reference.mass_kg * run.trajectory.time(frame) * *scene.effects.gravity;
  }
  if (scene.effects.drag) expected -= scene.effects.drag->coefficient * displacement(scene, run, frame);
  return (now.momentum_Ns - expected).norm();
}

/// Whether something outside the movable balls can push one.
bool bounded(const Scenario& scene) {
  return !scene.walls.empty() || std::any_of(scene.balls.begin(), scene.balls.end(),
                                             [](const Ball& ball) { return std::isinf(ball.mass); });
}

/// N m s; unknown where nothing tells what to expect.
double angular_momentum_error(const Yardstick& yardstick, const Conserved& now, const Run& run,
                              std::size_t frame) {
  if (yardstick.truth_known_at(frame)) return yardstick.angular_momentum_off_truth(now, frame).norm();
  const Scenario& scene = yardstick.scene();
  const Reference& reference = yardstick.reference();
  const Tally& tally = run.trajectory.tally(frame);
  if (scene.effects.drag || !scene.events.empty() || !tally.external_known) return kNotKnown;
  Vec3 error = now.angular_momentum_Nms - reference.start.angular_momentum_Nms -
               (tally.external_angular_impulse - reference.origin.cross(tally.external_impulse));
  if (!scene.effects.gravity) return error.norm();
  const Vec3& gravity = *scene.effects.gravity;
  if (bounded(scene)) {
    if (scene.dimension == 2) return kNotKnown;  // gravity lies in the plane, angular momentum across it
    return std::abs(error.dot(gravity.normalized()));
  }
  const double t = run.trajectory.time(frame);
  error -= reference.mass_kg * (0.5 * t * t) * reference.origin_velocity.cross(gravity);
  return error.norm();
}

}  // namespace

void measure_momentum(const Yardstick& yardstick, const std::vector<Conserved>& conserved,
                      RunComparison& result) {
  for (std::size_t k = 0; k < conserved.size(); ++k) {
    result.series.momentum.push_back(
        yardstick.by_momentum(momentum_error(yardstick, conserved[k], result.run, k)));
  }
  result.metrics[Metric::momentum] = largest(result.series.momentum);
}

void measure_angular_momentum(const Yardstick& yardstick, const std::vector<Conserved>& conserved,
                              RunComparison& result) {
  std::vector<double> errors;
  for (std::size_t k = 0; k < conserved.size(); ++k) {
    errors.push_back(
        yardstick.by_angular_momentum(angular_momentum_error(yardstick, conserved[k], result.run, k)));
  }
  result.metrics[Metric::angular_momentum] = largest(errors);
}

}  // namespace carom
