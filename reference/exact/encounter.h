#pragma once

#include "reference/exact/impact.h"

namespace carom::exact {

/// Two bodies that touch, a and b; a is the wall where one is.
class Encounter {
 public:
  /// @param partner  unused where the touch is with a wall
  Encounter(const Setting& setting, const Scenario& scene, const Touch& touch, Body& ball, Body& partner);
  Encounter(const Encounter&) = delete;
  Encounter& operator=(const Encounter&) = delete;
  ~Encounter() = default;

  /// How fast they approach, m/s; negative where they part.
  Real approach_mps() const { return exact::approach_mps(*a_, *b_, normal_); }

  /// How they would be pressed together by what accelerates them, m/s²: gravity, less what it takes to follow
  /// the other's curve; negative or zero where nothing presses them.
  Real pressing_mps2() const;

  /// Carries out the impact; returns the impulse on b, N s.
  Vector collide() { return exact::collide(*a_, *matter_a_, *b_, *matter_b_, normal_, *contact_); }

  const Vector& normal() const { return normal_; }  ///< from a to b

 private:
  Body still_;  ///< the wall
  Body* a_;
  Body* b_;
  const Matter* matter_a_;
  const Matter* matter_b_;
  Vector normal_;
  const Contact* contact_;
  const Setting* setting_;
};

}  // namespace carom::exact
