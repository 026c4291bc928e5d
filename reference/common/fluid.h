#pragma once

#include <cmath>

#include "scenario/scenario.h"

namespace carom::reference {

// Forces that an engine has none of its own for. An adapter applies them through the engine's force input,
// once per step, as the mean force that takes the ball's velocity to its exact value at the end of the step.

/// Whether the scene needs a force of this file.
inline bool needs_fluid_force(const Effects& effects) {
  return effects.magnus || (effects.drag && effects.drag->kind == Drag::Kind::quadratic);
}

/// The mean force over a step from quadratic drag and the Magnus effect, N.
///
/// v velocity (m/s), ω spin (rad/s), m mass (kg), h step (s), c drag coefficient (kg/m), s Magnus coefficient
/// (kg). Each effect alone is integrated exactly, drag first:
///   m dv/dt = -c |v| v   =>   v(h) = v / (1 + c |v| h / m)              (1)
///   m dv/dt = s ω × v    =>   v(h) = R(s ω h / m) v                     (2)
/// with R(θ) the rotation by the vector θ, and F = m (v(h) - v) / h       (3)
/// Source: integration of the two laws of motion, each by separation of variables. Applied once per step
/// beside gravity, so the three together converge with order 1 in h.
inline Vec3 fluid_force(const Effects& effects, const Ball& ball, const Vec3& velocity_mps,
                        const Vec3& spin_radps, double step_s) {
  Vec3 end_mps = velocity_mps;
  if (effects.drag && effects.drag->kind == Drag::Kind::quadratic) {
    end_mps /= 1.0 + effects.drag->coefficient * velocity_mps.norm() * step_s / ball.mass;
  }
  const double spin = spin_radps.norm();
  if (effects.magnus && spin > 0.0) {
    const double angle_rad = *effects.magnus * spin * step_s / ball.mass;
    end_mps = Eigen::AngleAxisd(angle_rad, spin_radps / spin) * end_mps;
  }
  return ball.mass * (end_mps - velocity_mps) / step_s;
}

/// c/m of a ball under linear drag, 1/s; 0 without it.
inline double linear_drag_rate(const Effects& effects, const Ball& ball) {
  const bool linear = effects.drag && effects.drag->kind == Drag::Kind::linear;
  return linear ? effects.drag->coefficient / ball.mass : 0.0;
}

/// The mean force over a step from linear drag, N, for engines whose own damping cannot express it:
///   m dv/dt = -c v   =>   v(h) = v e^{-c h/m}                            (4)
/// and (3), in the symbols of fluid_force.
inline Vec3 linear_drag_force(const Effects& effects, const Ball& ball, const Vec3& velocity_mps,
                              double step_s) {
  return ball.mass * std::expm1(-linear_drag_rate(effects, ball) * step_s) / step_s * velocity_mps;
}

}  // namespace carom::reference
