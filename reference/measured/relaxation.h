#pragma once

#include <vector>

#include "reference/measured/measure.h"

namespace carom::measured {

/// The fourth cumulant of the speeds at one moment,
///   a₂ = ⟨v⁴⟩/((5/3)⟨v²⟩²) - 1, (1)
/// 0 for Maxwell's distribution and -2/5 where all speeds are equal. It is the second coefficient of the
/// expansion in Sonine polynomials.
struct RelaxationPoint {
  double collisions = 0.0;  ///< that a sphere has had since the start, on average, C
  double cumulant = 0.0;
  double uncertainty = 0.0;
};

/// How spheres that all start with one speed, at random places and in random directions, come to Maxwell's
/// distribution: a₂ at C = 0, 0.1, … up to about kMostCollisions. Walls reflect and leave speeds as they are.
///
/// The uncertainty of each:
/// - twice the standard error of (1), by how its value changes with each sphere's speed,
///   δa₂ = v⁴/((5/3)⟨v²⟩²) - 2 (1 + a₂) v²/⟨v²⟩, over √N. ⟨v²⟩ does not change; what it would do is taken
///   out.
/// - the walls: spheres within σ of where centres are stopped, a share w = 6σ/L, collide at a rate that is
/// off by
///   half at most, because half of their partners are missing. Uneven C changes the mean of a₂(C) by
///   ½ a₂'' C²/4 w, and with a₂ ∝ e^{-λC} there is no C at which a₂'' C² is more than 0.4 · 4/e²: 0.027 w.
///   That takes them to stay there, and they leave within a collision or two.
/// - reading between two C that are 0.1 apart, h²/8 a₂'' with λ < 0.5: 1.3e-4.
std::vector<RelaxationPoint> relaxation(const Fluid& fluid, const Runner& run);

/// a₂ after so many collisions of each sphere, read between two points. @pre they reach as far
Measurement cumulant_after(const std::vector<RelaxationPoint>& points, double collisions);

constexpr double kMostCollisions = 6.0;

/// The scene: N spheres of equal speed √3, so that T = 1.
Scenario relaxation_scene(const Fluid& fluid);

}  // namespace carom::measured
