#pragma once

#include <vector>

#include "carom/plane.h"

namespace carom {

/// A thin slab: a solid with two faces. A ball is on the side of its centre, and bounces off that face as off
/// a wall.
template <int Dim>
void add_slabs(const Scenario& scene, std::vector<Plane<Dim>>& planes) {
  for (const Slab& slab : scene.slabs) add_faces<Dim>(slab, kSolid, planes);
}

}  // namespace carom
