#pragma once

#include <optional>

#include "trajectory/trajectory.h"
#include "trajectory/truth.h"

namespace carom {

/// By how much a run's impacts come at the wrong time: the largest |t - t_true|, s, of those that can be
/// told.
///
/// Engines do not hand out when impacts happen, and that of one which finds them when a step ends is no time
/// at which anything happened. It is told from the motion: of a ball's flight before, continued, and its
/// flight after, traced back, where they come nearest,
///   D(t) = x_b(t) - x_a(t),   t = t_0 - D(t_0)·D'/|D'|²,                                                (1)
/// with both flights under gravity alone: D is linear in t, for g is in both. x_a starts from the frame
/// before the impact, x_b from the second frame after it, for an engine may be late by up to a step.
///
/// Told are the true impacts up to the horizon that are a ball's only ones from the frame before to the
/// second one after, and that change its velocity by more than a thousandth of its speed. Nothing where there
/// is none, where the truth does not tell its impacts or flight is no parabola (drag, Magnus) or is
/// interfered with, and where the run has missed one: the ball's velocity has not changed by half of what it
/// should.
std::optional<double> impact_time_error_s(const Scenario& scene, const Truth& truth, const Run& run);

}  // namespace carom
