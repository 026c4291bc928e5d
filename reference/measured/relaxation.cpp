#include "reference/measured/relaxation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include "core/random.h"
#include "reference/measured/fluid.h"
#include "scenario/generate.h"

namespace carom::measured {

namespace {

constexpr double kCollisionsPerFrame = 0.1;
/// A tenth more than it takes without walls, beside which spheres collide less often.
constexpr std::int64_t kFrames = 68;

/// See relaxation(): by w, and by reading between points.
constexpr double kWallShare = 0.5 * 0.4 * 4.0 / (std::numbers::e * std::numbers::e) / 4.0;
constexpr double kBetweenPoints = 0.1 * 0.1 / 8.0 * 0.4 * 0.5 * 0.5;

RelaxationPoint point_of(std::span<const BallState> states, const Tally& tally) {
  const auto count = static_cast<double>(states.size());
  double second = 0.0;
  double fourth = 0.0;
  for (const BallState& state : states) {
    const double square = state.velocity.squaredNorm();
    second += square / count;
    fourth += square * square / count;
  }
  RelaxationPoint point;
  point.collisions = 2.0 * static_cast<double>(impacts_of_pairs(tally)) / count;
  point.cumulant = fourth / (5.0 / 3.0 * second * second) - 1.0;
  // The mean of δa₂ is 1 + a₂ - 2 (1 + a₂).
  double variance = 0.0;
  for (const BallState& state : states) {
    const double share = state.velocity.squaredNorm() / second;
    const double change = 0.6 * share * share - 2.0 * (1.0 + point.cumulant) * share + (1.0 + point.cumulant);
    variance += change * change / (count - 1.0);
  }
  point.uncertainty = 2.0 * std::sqrt(variance / count);
  return point;
}

}  // namespace

Scenario relaxation_scene(const Fluid& fluid) {
  Scenario scene = fluid_box(fluid);
  Generator generator;
  generator.count = fluid.count;
  generator.seed = 1;
  generator.radius = std::pair(0.5, 0.5);
  generator.mass = 1.0;
  scene.balls = generate(generator, scene);
  Random random(2);
  for (Ball& ball : scene.balls) {
    for (int axis = 0; axis < 3; ++axis) ball.velocity[axis] = random.normal();
    ball.velocity *= std::sqrt(3.0) / ball.velocity.norm();
  }
  const double frame_s = kCollisionsPerFrame * collision_time(fluid.density);
  scene.frames = kFrames;
  scene.duration_s = static_cast<double>(kFrames) * frame_s;
  scene.step_s = frame_s;
  return scene;
}

std::vector<RelaxationPoint> relaxation(const Fluid& fluid, const Runner& run) {
  const Scenario scene = relaxation_scene(fluid);
  const double side = scene.box->max.x() - 1.0;
  std::vector<RelaxationPoint> points;
  run(scene, [&](std::span<const BallState> states, const Tally& tally) {
    points.push_back(point_of(states, tally));
    points.back().uncertainty += kWallShare * 6.0 / side + kBetweenPoints;
  });
  return points;
}

Measurement cumulant_after(const std::vector<RelaxationPoint>& points, double collisions) {
  const auto after = std::find_if(points.begin(), points.end(), [&](const RelaxationPoint& point) {
    return point.collisions >= collisions;
  });
  if (after == points.end()) throw std::logic_error("measured: the relaxation ends before");
  if (after == points.begin()) return {after->cumulant, after->uncertainty};
  const RelaxationPoint& before = *(after - 1);
  const double share = (collisions - before.collisions) / (after->collisions - before.collisions);
  return {std::lerp(before.cumulant, after->cumulant, share),
          std::max(before.uncertainty, after->uncertainty)};
}

}  // namespace carom::measured
