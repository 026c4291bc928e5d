#pragma once

#include <btBulletDynamicsCommon.h>

#include "scenario/scenario.h"

namespace carom::bullet {

// Bullet multiplies the coefficients of two surfaces unless two global functions say otherwise. Ours read the
// scene from the objects they are given, so one pair of functions serves every world in the process: each
// object's user pointer is its scene, its user index counts the scene's balls and then its walls.

inline const Contact& surface_between(const btCollisionObject* a, const btCollisionObject* b) {
  const auto& scene = *static_cast<const Scenario*>(a->getUserPointer());
  const auto walls_from = static_cast<int>(scene.balls.size());
  const bool wall = a->getUserIndex() >= walls_from || b->getUserIndex() >= walls_from;
  return wall ? scene.wall_contact : scene.ball_contact;
}

inline btScalar pair_restitution(const btCollisionObject* a, const btCollisionObject* b) {
  return static_cast<btScalar>(surface_between(a, b).restitution);
}

inline btScalar pair_friction(const btCollisionObject* a, const btCollisionObject* b) {
  return static_cast<btScalar>(surface_between(a, b).friction);
}

inline void use_pair_coefficients() {
  gCalculateCombinedRestitutionCallback = &pair_restitution;
  gCalculateCombinedFrictionCallback = &pair_friction;
}

}  // namespace carom::bullet
