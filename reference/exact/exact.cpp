#include "reference/exact/exact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/exact/certify.h"

namespace carom {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// All pairs of so many are looked at once in a second; more are beyond the budget anyway.
constexpr std::size_t kMostBalls = 5000;

bool is_immovable(const Ball& ball) {
  return std::isinf(ball.mass);
}

/// Two surfaces that touch in the decimals of a scene file are apart, or overlap, by the rounding of two
/// places and two radii to doubles: ε/2 of the scale each.
double touch_m(const Scenario& scene) {
  double scale = 0.0;
  for (const Ball& ball : scene.balls) {
    scale = std::max(scale, ball.position.cwiseAbs().maxCoeff() + ball.radius);
  }
  for (const Wall& wall : scene.walls) scale = std::max(scale, std::abs(wall.offset));
  return 4.0 * kEpsilon * scale;
}

std::string unsolved_effect(const Scenario& scene) {
  if (scene.effects.drag && scene.effects.drag->coefficient > 0.0) return "drag has no exact flight";
  if (scene.effects.magnus && *scene.effects.magnus != 0.0) return "the Magnus force has no exact flight";
  if (!scene.slabs.empty()) return "slabs are not solved here";
  if (!scene.barriers.empty()) return "barriers are not solved here";
  if (!scene.events.empty()) return "what a person does to the balls is not solved here";
  if (scene.multi_contact != MultiContact::sequential) return "impacts are of one pair at a time";
  if (scene.balls.size() > kMostBalls) return fmt::format("more than {} balls", kMostBalls);
  return {};
}

/// How a ball starts at a surface: `away` is its velocity off the surface, m/s, and `pressing` the
/// acceleration onto it, m/s². Nothing that presses it may find it at rest there.
bool rests(double gap_m, double touch_m, double away_mps, double speed_mps, double pressing_mps2) {
  return gap_m <= touch_m && std::abs(away_mps) <= 4.0 * kEpsilon * speed_mps && pressing_mps2 > 0.0;
}

std::string unsolved_start_at_walls(const Scenario& scene, double touch, const Vec3& gravity) {
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    const Ball& ball = scene.balls[i];
    if (is_immovable(ball)) continue;
    for (std::size_t k = 0; k < scene.walls.size(); ++k) {
      const Wall& wall = scene.walls[k];
      const double gap = wall.normal.dot(ball.position) - wall.offset - ball.radius;
      if (gap < -touch) return fmt::format("ball {} starts outside wall {}", i, k);
      const double pressing = -wall.normal.dot(gravity);
      if (rests(gap, touch, wall.normal.dot(ball.velocity), ball.velocity.norm(), pressing)) {
        return fmt::format("ball {} starts at rest on wall {}, and a contact that lasts is no impact", i, k);
      }
    }
  }
  return {};
}

std::string unsolved_start_of_pair(const Scenario& scene, std::size_t i, std::size_t k, double touch,
                                   const Vec3& gravity) {
  const Ball& a = scene.balls[i];
  const Ball& b = scene.balls[k];
  const Vec3 d = b.position - a.position;
  const double gap = d.norm() - a.radius - b.radius;
  if (gap < -touch) return fmt::format("balls {} and {} start overlapping", i, k);
  if (gap > touch || is_immovable(a) == is_immovable(b)) return {};
  const Vec3 normal = d.normalized() * (is_immovable(a) ? 1.0 : -1.0);  // to the movable one
  const Vec3 v = (b.velocity - a.velocity) * (is_immovable(a) ? 1.0 : -1.0);
  const double pressing =
      -normal.dot(gravity) - (v - normal * normal.dot(v)).squaredNorm() / (a.radius + b.radius);
  if (rests(gap, touch, normal.dot(v), v.norm(), pressing)) {
    return fmt::format("balls {} and {} start at rest on each other, and a contact that lasts is no impact",
                       i, k);
  }
  return {};
}

std::string unsolved_start(const Scenario& scene) {
  const double touch = touch_m(scene);
  const Vec3 gravity = scene.effects.gravity.value_or(Vec3::Zero());
  std::string reason = unsolved_start_at_walls(scene, touch, gravity);
  for (std::size_t i = 0; scene.effects.collisions && i < scene.balls.size(); ++i) {
    for (std::size_t k = i + 1; k < scene.balls.size() && reason.empty(); ++k) {
      if (is_immovable(scene.balls[i]) && is_immovable(scene.balls[k])) continue;
      reason = unsolved_start_of_pair(scene, i, k, touch, gravity);
    }
  }
  return reason;
}

class ExactTruth final : public TruthSource {
 public:
  std::string_view kind() const override { return "exact"; }

  std::string refuses(const Scenario& scene) const override {
    std::string reason = unsolved_effect(scene);
    if (reason.empty()) reason = unsolved_start(scene);
    return reason.empty() ? reason : "no exact solution: " + reason;
  }

  Solution solve(const Scenario& scene, std::span<const Moment> moments, const Taker& take) const override {
    return exact::certify(scene, moments, take, {});
  }
};

}  // namespace

std::unique_ptr<TruthSource> make_exact_truth() {
  return std::make_unique<ExactTruth>();
}

}  // namespace carom
