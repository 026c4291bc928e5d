#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "reference/closed_form/twofold_vector.h"
#include "scenario/scenario.h"

namespace carom::closed_form {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Whether a drag force acts at all.
bool has_drag(const Scenario& scenario);

/// Whether a Magnus force acts on balls that spin.
bool has_magnus(const Scenario& scenario);

bool is_immovable(const Ball& ball);

/// The constant part of a ball's acceleration, m/s². Gravity does not move an immovable ball: it keeps the
/// velocity that it starts with.
Vec3 acceleration_of(const Ball& ball, const Effects& effects);

/// To this moment a scene is followed. The sum of a run's steps can pass the duration by their rounding, one
/// ulp per step length.
Twofold horizon_s(const Scenario& scenario);

/// The largest coordinate that a scene starts with: of surfaces, centres and walls, m.
double scale_m(const Scenario& scenario);

/// A gap no wider than this is a touch, m. Two surfaces that touch in the author's decimals are written with
/// four numbers (two places, two radii), each off by ε/2 of the scale once it is a double: 2 ε; and their
/// first motion is written with two more, as many again when it is as long as the scale: 4 ε in all.
double touch_m(const Scenario& scenario);

/// What positions that were computed as pairs of doubles are off by, m: one rounding per coordinate, ε/2 each
/// and so √3/2 ε < ε together, plus the gap that counted as a touch at the start.
double rounding_bound_m(const Scenario& scenario, double farthest_m);

/// The gap between a ball and a wall, negative where they overlap, m.
double gap_m(const Wall& wall, double radius_m, const Vec3& centre);

/// Names the first ball that starts outside a wall; empty where none does.
std::string starts_outside(const Scenario& scenario);

}  // namespace carom::closed_form
