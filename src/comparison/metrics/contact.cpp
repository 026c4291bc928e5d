#include "comparison/metrics/contact.h"

#include <algorithm>

#include "comparison/overlap.h"

namespace carom {

namespace {

/// Whether a ball that started at `start` is where no ball can get, its centre being at `now`.
bool behind_something(const Scenario& scene, const Vec3& start, const Vec3& now) {
  for (const Wall& wall : scene.walls) {
    if (wall.normal.dot(now) < wall.offset) return true;
  }
  for (const Slab& slab : scene.slabs) {
    const auto side = [&slab](const Vec3& x) { return slab.normal.dot(x) > slab.offset; };
    if (side(now) != side(start)) return true;
  }
  return false;
}

}  // namespace

void measure_contact(const Yardstick& yardstick, RunComparison& result) {
  const Scenario& scene = yardstick.scene();
  const Trajectory& trajectory = result.run.trajectory;
  double deepest = 0.0;
  OverlapSearch search(scene);
  std::vector<bool> outside(trajectory.balls(), false);
  for (std::size_t k = 0; k < trajectory.frames(); ++k) {
    const auto balls = trajectory.frame(k);
    deepest = std::max(deepest, search.deepest(balls));
    for (std::size_t i = 0; i < balls.size(); ++i) {
      if (behind_something(scene, scene.balls[i].position, balls[i].position)) outside[i] = true;
    }
  }
  result.metrics[Metric::penetration] = deepest;
  if (!scene.walls.empty() || !scene.slabs.empty()) {
    result.metrics[Metric::escaped] = static_cast<double>(std::count(outside.begin(), outside.end(), true));
  }
}

}  // namespace carom
