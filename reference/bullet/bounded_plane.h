#pragma once

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>

namespace carom::bullet {

/// A plane that tells the broad phase where it is needed.
///
/// btStaticPlaneShape covers all space with its bounding box, so that every ball is tested against every wall
/// in every step; a box is tested near its faces only, but through an iteration (GJK) whose normals are wrong
/// by up to 1e-3 in single precision. This is the exact plane of the one with the bounding box of the other:
/// that of the disk around `centre`'s foot on the plane, swept backwards by its radius.
class BoundedPlane final : public btStaticPlaneShape {
 public:
  BoundedPlane(const btVector3& normal, btScalar offset, const btVector3& centre, btScalar radius)
      : btStaticPlaneShape(normal, offset),
        foot_(centre - (normal.dot(centre) - offset) * normal),
        radius_(radius) {}

  void getAabb(const btTransform& place, btVector3& min, btVector3& max) const override {
    for (int axis = 0; axis < 3; ++axis) {
      const btScalar n = m_planeNormal[axis];
      const btScalar half = radius_ * std::sqrt(std::max(btScalar(0), 1 - n * n));
      min[axis] = foot_[axis] - half - std::max(n, btScalar(0)) * radius_;
      max[axis] = foot_[axis] + half + std::max(-n, btScalar(0)) * radius_;
    }
    min += place.getOrigin();
    max += place.getOrigin();
  }

 private:
  btVector3 foot_;
  btScalar radius_;
};

}  // namespace carom::bullet
