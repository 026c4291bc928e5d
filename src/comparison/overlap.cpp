#include "comparison/overlap.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace carom {

namespace {

double deepest_in_walls(const Scenario& scenario, std::span<const BallState> balls) {
  double deepest = 0.0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const double radius = scenario.balls[i].radius;
    for (const Wall& wall : scenario.walls) {
      const double overlap = radius - (wall.normal.dot(balls[i].position) - wall.offset);
      deepest = std::max(deepest, overlap / radius);
    }
  }
  return deepest;
}

double deepest_in_pairs(const Scenario& scenario, std::span<const BallState> balls) {
  const auto radius = [&](std::size_t i) { return scenario.balls[i].radius; };
  const auto left = [&](std::size_t i) { return balls[i].position.x() - radius(i); };
  std::vector<std::size_t> order(balls.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return left(a) < left(b); });

  double deepest = 0.0;
  for (std::size_t p = 0; p < order.size(); ++p) {
    const std::size_t a = order[p];
    const double right = balls[a].position.x() + radius(a);
    for (std::size_t q = p + 1; q < order.size() && left(order[q]) < right; ++q) {
      const std::size_t b = order[q];
      const double reach = radius(a) + radius(b);
      const Vec3 between = balls[b].position - balls[a].position;
      if (between.squaredNorm() >= reach * reach) continue;
      deepest = std::max(deepest, (reach - between.norm()) / std::min(radius(a), radius(b)));
    }
  }
  return deepest;
}

}  // namespace

double deepest_overlap(const Scenario& scenario, std::span<const BallState> balls) {
  const double in_walls = deepest_in_walls(scenario, balls);
  return scenario.effects.collisions ? std::max(in_walls, deepest_in_pairs(scenario, balls)) : in_walls;
}

}  // namespace carom
