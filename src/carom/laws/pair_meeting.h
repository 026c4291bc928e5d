#pragma once

#include <limits>

#include "core/vec.h"
#include "scenario/scenario.h"

namespace carom {

// An impact of two balls by itself, apart from any simulation: what a law of impact is given, and what it
// answers.

struct PairBall {
  double mass = 1.0;    ///< kg; infinite for an immovable ball
  double radius = 1.0;  ///< m
  double inertia =
      std::numeric_limits<double>::infinity();  ///< I, kg m²; infinite where the ball cannot turn
  Vec3 velocity = Vec3::Zero();                 ///< m/s
  Vec3 spin = Vec3::Zero();                     ///< rad/s
};

/// Two balls that touch. @pre the normal is a unit vector, and they approach: (v₂ − v₁)·n < 0
struct PairMeeting {
  PairBall one;
  PairBall two;
  Vec3 normal = Vec3::UnitX();  ///< from ball 1 to ball 2
  Contact surface;
};

/// What acts on each ball at the point where they touch, N s.
struct PairImpulses {
  Vec3 on_one = Vec3::Zero();
  Vec3 on_two = Vec3::Zero();
};

/// How fast the surfaces slip at the contact, that of ball 2 less that of ball 1, along them:
/// g = v₂ − v₁ − (r₁ ω₁ + r₂ ω₂) × n, without its part along n. m/s
inline Vec3 slip_of(const PairMeeting& pair) {
  const Vec3& n = pair.normal;
  const Vec3 g = pair.two.velocity - pair.one.velocity -
                 (pair.one.radius * pair.one.spin + pair.two.radius * pair.two.spin).cross(n);
  return g - n.dot(g) * n;
}

/// The pair once the impulses have acted.
inline PairMeeting after(PairMeeting pair, const PairImpulses& impulses) {
  const auto push = [](PairBall& ball, const Vec3& arm, const Vec3& impulse_Ns) {
    ball.velocity += impulse_Ns / ball.mass;
    ball.spin += arm.cross(impulse_Ns) / ball.inertia;
  };
  push(pair.one, pair.one.radius * pair.normal, impulses.on_one);
  push(pair.two, -pair.two.radius * pair.normal, impulses.on_two);
  return pair;
}

}  // namespace carom
