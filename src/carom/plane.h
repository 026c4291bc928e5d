#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "carom/world.h"

namespace carom {

inline constexpr std::int32_t kSolid = -1;

/// What does not move and balls bounce off: a wall, or one face of a sheet. A ball touches it where
/// normal·x - offset = r.
template <int Dim>
struct Plane {
  Vec<Dim> normal;                ///< unit, towards the balls
  double offset;                  ///< m
  double depth;                   ///< m, from the face to the middle of its sheet; endless for a wall
  std::int32_t barrier = kSolid;  ///< which of the scene's barriers this is a face of

  double gap(const Vec<Dim>& x, double radius) const { return normal.dot(x) - offset - radius; }

  /// Whether a ball at x is on this side: a wall has only one.
  bool faces(const Vec<Dim>& x) const { return normal.dot(x) - offset >= -depth; }
};

template <int Dim>
std::vector<Plane<Dim>> planes_of(const std::vector<Wall>& walls) {
  std::vector<Plane<Dim>> planes;
  planes.reserve(walls.size());
  for (const Wall& wall : walls) {
    planes.push_back({flattened<Dim>(wall.normal), wall.offset, std::numeric_limits<double>::infinity()});
  }
  return planes;
}

/// The two faces of a slab or a barrier.
template <int Dim, class Sheet>
void add_faces(const Sheet& sheet, std::int32_t barrier, std::vector<Plane<Dim>>& planes) {
  const Vec<Dim> normal = flattened<Dim>(sheet.normal);
  const double half = 0.5 * sheet.thickness;
  planes.push_back({normal, sheet.offset + half, half, barrier});
  // A ball right in the middle is on one side only.
  planes.push_back({-normal, half - sheet.offset, std::nextafter(half, 0.0), barrier});
}

}  // namespace carom
