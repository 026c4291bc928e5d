#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "comparison/comparison.h"

namespace carom {

/// How fast errors grow in a scene, and until when double precision can follow it, from the amplification
/// that its truth found out (Solution::amplification); nothing where it found none.
///
/// - λ is the slope of ln A(t) by least squares over the frames from which on A has grown tenfold: before
/// that
///   a random direction has not turned into the growing one. An error δ becomes δ e^{λt}.
/// - The horizon is the first frame at which what rounding alone makes of positions (rounding_growth_m(),
/// with
///   double precision) passes the tolerance: ln(tolerance/δ)/λ, read off A itself and not off its fit.
Predictability predictability_of(const Scenario& scene, const Truth& truth, double tolerance_m);

/// ε of the precision that the run's engine calculates in.
double epsilon_of(const Run& run);

/// What rounding alone makes of the position error, m, for each frame while the truth is known: an error that
/// is larger has another cause.
///
/// A ball's position and velocity take roundings of ε|x| and ε|v| with each impact and each step. The
/// velocity's becomes ε|v|T within the duration T; so each is at most ε L, L = max(|x|, |v| T) over all balls
/// and frames. One made at a time t' has grown by A(t)/A(t') <= Â(t), the largest A so far. So in the end
///   e(t) <= √(2dN) Â(t) ε [(κ (1 + impacts) + √steps) L + ½ steps X],   X = max |x|,   (1)
/// with κ = 8 roundings an impact (the terms of the impulse, the time and the place), counted for the ball
/// that has had the most. Steps round velocities up as often as down, like a random walk; but of a ball that
/// moves by the same amount in every step they may round the position the same way each time. √(2dN) because
/// A was measured along one random direction of phase space, which shows that part of the largest growth.
///
/// @param epsilon  of the engine's precision
/// @param steps    that the engine took over the duration
std::vector<double> rounding_growth_m(const Scenario& scene, const Truth& truth, double epsilon,
                                      std::int64_t steps);

/// Judges a measured run that ended well against a truth that is known: see Accuracy.
Judgement judge(const Scenario& scene, const Truth& truth, double tolerance_m, const RunComparison& measured);

}  // namespace carom
