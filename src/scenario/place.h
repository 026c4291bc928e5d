#pragma once

#include <vector>

#include "core/random.h"
#include "scenario/scenario.h"

namespace carom {

/// Random positions for balls of the given radii inside scene.box, free of overlap with each other, with the
/// scene's walls, slabs and barriers, and with the balls it has already.
///
/// Every ball starts as a point anywhere in the box and grows to its radius, while those that still grow and
/// those around them are shuffled by Monte Carlo moves (what would overlap is not done). Random
/// insertion jams at 0.547 of the plane and 0.384 of space; this goes beyond, into dense fluids. How far
/// depends on the balls, for it gives up after a number of sweeps without a further one: at 0.45 of space it
/// has placed 2000 equal balls, but 99 998 of 100 000 with radii 1 : 1.2, and at 0.471 (nσ³ = 0.9) it gives
/// up.
///
/// @pre scene.box is set, and its sides are among scene.walls. @throws DoesNotFit (generate.h) where balls
/// are left that cannot grow.
std::vector<Vec3> place_at_random(const std::vector<double>& radii, const Scenario& scene, Random& random);

}  // namespace carom
