#include "scenario/room.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

namespace carom {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// The surfaces that a ball with its centre at `place` must stay above.
std::vector<Wall> surfaces_around(const Scenario& scene, const Vec3& place) {
  std::vector<Wall> surfaces = scene.walls;
  for (const Slab& slab : scene.slabs) {
    const double side = slab.normal.dot(place) >= slab.offset ? 1.0 : -1.0;
    surfaces.push_back({side * slab.normal, side * slab.offset + 0.5 * slab.thickness});
  }
  return surfaces;
}

/// The way from one surface to the other, m, where they face each other; endless elsewhere. Rounding of
/// offsets and normals is counted for the ball.
double room_between(const Wall& a, const Wall& b) {
  if (!(a.normal + b.normal).isZero(4.0 * kEpsilon)) return std::numeric_limits<double>::infinity();
  return -(a.offset + b.offset) + 8.0 * kEpsilon * (std::abs(a.offset) + std::abs(b.offset));
}

}  // namespace

std::optional<std::string> lack_of_room(const Scenario& scene) {
  std::vector<Wall> surfaces = scene.walls;
  double roomy = 0.0;  // m, a radius for which there is room wherever the ball is
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    const Ball& ball = scene.balls[i];
    if (std::isinf(ball.mass)) continue;  // it passes through walls
    if (ball.radius <= roomy) continue;
    if (!scene.slabs.empty()) surfaces = surfaces_around(scene, ball.position);
    const double diameter = 2.0 * ball.radius;
    for (std::size_t a = 0; a < surfaces.size(); ++a) {
      for (std::size_t b = a + 1; b < surfaces.size(); ++b) {
        const double room = room_between(surfaces[a], surfaces[b]);
        if (diameter * (1.0 - 8.0 * kEpsilon) <= room) continue;
        return fmt::format("ball {} has a diameter of {} m and stands between surfaces {} m apart", i,
                           diameter, room);
      }
    }
    if (scene.slabs.empty()) roomy = ball.radius;
  }
  return std::nullopt;
}

}  // namespace carom
