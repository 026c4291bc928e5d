#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "reference/exact/number.h"
#include "scenario/scenario.h"

namespace carom::exact {

/// What of a body an impact asks for. A wall is one that nothing moves, of radius 0.
struct Matter {
  Real radius_m;
  Real inverse_mass;     ///< 1/m, 1/kg; 0 where nothing moves it
  Real inverse_inertia;  ///< 1/(κ m r²), 1/(kg m²)

  bool movable() const { return inverse_mass > 0; }
};

/// The plane normal·x = offset. The scene's normal is a unit vector but for the rounding of its doubles; the
/// plane is what they say, and this normal has length 1 to all digits.
struct Plane {
  Vector normal;
  Real offset_m;
};

/// Where a ball is and how it moves, at a moment of its own.
struct Body {
  Real time_s;
  Vector position_m;
  Vector velocity_mps;
  Vector spin_radps;
};

/// What does not change in a scene, in the arithmetic of one run.
struct Setting {
  explicit Setting(const Scenario& scene);

  /// A ball at another moment, if it meets nothing: x + v t + ½ g t², v + g t. Gravity does not move an
  /// immovable ball.
  Vector position(std::size_t ball, const Body& body, const Real& time_s) const;
  Vector velocity(std::size_t ball, const Body& body, const Real& time_s) const;
  Body moved(std::size_t ball, const Body& body, const Real& time_s) const;

  bool falls(std::size_t ball) const { return gravity && matter[ball].movable(); }

  /// Whether two balls push each other when they meet: not both are immovable.
  bool collide(std::size_t a, std::size_t b) const { return matter[a].movable() || matter[b].movable(); }

  std::vector<Matter> matter;  ///< of the balls
  std::vector<Plane> walls;
  Matter wall_matter;
  Vector gravity_mps2;
  bool gravity = false;    ///< and it is not zero
  double scale_m = 0.0;    ///< the largest coordinate of surfaces, centres and walls at the start
  double speed_mps = 0.0;  ///< the largest speed at the start, of surfaces too, and that of a fall that lasts
};

/// A contact of a ball: with another ball or with a wall.
struct Touch {
  std::uint32_t ball = 0;
  std::uint32_t partner = 0;
  bool wall = false;

  bool operator==(const Touch&) const = default;
};

}  // namespace carom::exact
