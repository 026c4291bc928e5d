#pragma once

#include <vector>

#include "reference/converged/number.h"
#include "scenario/scenario.h"

namespace carom::converged {

/// How finely a run computes.
struct Accuracy {
  int order = 0;  ///< of the Taylor polynomials, 6 or more
  /// What a polynomial leaves out at the end of its step is 2^-bits of the scene's size and speed; what a
  /// ball hands on from one step to the next is rounded to so many bits.
  int bits = 0;
};

/// What is large in a scene.
struct Scale {
  Real length_m;
  Real speed_mps;
};

/// What acts on a ball in flight: dv/dt = g - k v - q |v| v + Ω × v.
struct Flow {
  Vector gravity = Vector::Zero();  ///< g, m/s²
  Real linear = 0;                  ///< k = c/m, 1/s
  Real quadratic = 0;               ///< q = c/m, 1/m
  Vector turning = Vector::Zero();  ///< Ω = s ω/m, rad/s; constant, for only impacts change the spin

  /// @param spin_radps  of the ball now. An immovable ball keeps its velocity: nothing acts on it.
  static Flow of(const Ball& ball, const Effects& effects, const Vector& spin_radps);

  /// Whether the flight is a parabola, or straight.
  bool is_polynomial() const { return linear == 0 && quadratic == 0 && turning.isZero(Real(0)); }
};

/// Place, velocity and acceleration at one moment; m, m/s, m/s².
struct Kinematics {
  Vector x;
  Vector v;
  Vector a;
};

/// A piece of a flight as a Taylor polynomial of the place about the piece's start.
class Piece {
 public:
  Piece() = default;
  /// @param latest_s  the piece ends there at the latest
  Piece(const Flow& flow, const Vector& x, const Vector& v, const Real& start_s, const Real& latest_s,
        const Accuracy& accuracy, const Scale& scale);

  const Real& start_s() const { return start_s_; }
  const Real& end_s() const { return end_s_; }

  Kinematics at(const Real& time_s) const;
  Vector place_at(const Real& time_s) const;
  /// Those to begin the next piece with, at the end of this one.
  Kinematics at_end() const;

  // Bounds over the whole piece.
  const Real& most_speed_mps() const { return most_speed_mps_; }
  const Real& most_acceleration_mps2() const { return most_acceleration_mps2_; }
  const Real& most_jerk_mps3() const { return most_jerk_mps3_; }

  /// Place and velocity to double's rounding, if no coefficient is beyond what a double holds.
  bool is_sketched() const { return !sketch_.empty(); }
  void sketch_at(double time_s, Vec3& x, Vec3& v) const;
  std::int64_t sketch_cost() const { return 1 + static_cast<std::int64_t>(coefficients_.size()) / 6; }

  /// The centre of a sphere that the ball's centre stays in, and its radius.
  Vec3 around_m() const { return around_m_; }
  double reach_m() const { return reach_m_; }

  /// What an evaluation costs, in multiplications.
  std::int64_t cost() const { return 9 * static_cast<std::int64_t>(coefficients_.size()); }

 private:
  void end_at_standstill(const Vector& up);
  void find_bounds();
  void sketch();

  std::vector<Vector> coefficients_;
  std::vector<Vec3> sketch_;  ///< the same in double
  Real start_s_ = 0;
  Real end_s_ = 0;
  bool stands_at_end_ = false;
  Real most_speed_mps_ = 0;
  Real most_acceleration_mps2_ = 0;
  Real most_jerk_mps3_ = 0;
  Vec3 around_m_ = Vec3::Zero();
  double reach_m_ = 0.0;
};

}  // namespace carom::converged
