#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "scenario/scenario.h"
#include "scenario/symmetry.h"

namespace carom {

/// The frame and the units in which a scene is seen anew. With primes for what is seen, x m and t s:
///   x' = L R x + u t,   t' = T t,   m' = M m,                                                            (1)
/// so that, by dx'/dt' and because a spin is an axial vector, ω = x × v / |x|² for a point that it carries,
///   v' = (L R v + u)/T,   ω' = det(R) R ω / T.                                                           (2)
/// A quantity of dimension kg^a m^b s^c becomes M^a L^b T^c of itself, and a polar vector R of itself too.
///
/// @pre R is orthogonal. A frame that moves (u ≠ 0) leaves no wall at rest, and what depends on the velocity
/// in the air changes: it is for scenes without either.
struct Frame {
  Eigen::Matrix3d map = Eigen::Matrix3d::Identity();  ///< R
  Vec3 boost = Vec3::Zero();                          ///< u, m/s
  double length = 1.0;                                ///< L
  double time = 1.0;                                  ///< T
  double mass = 1.0;                                  ///< M

  /// The scene as seen: everything it has, with its dimension. A box stays a box where R permutes the axes,
  /// and becomes its walls where not.
  Scenario operator()(const Scenario& scene) const;

  /// A state of the moment t, seconds of the original, seen from here; and back.
  BallState seen(const BallState& state, double time_s) const;
  BallState unseen(const BallState& state, double time_s) const;
};

/// A scene seen anew, and how its states are seen from the original.
struct Twin {
  Scenario scenario;
  Frame frame;
  std::vector<std::size_t> place;  ///< ball i of the scene is ball place[i] of the twin
  bool backwards = false;          ///< its frames are the scene's, from the last to the first

  /// Ball `ball` of the scene in frame `frame`, of `frames` from 0 at t = 0 on, from the twin's states of the
  /// frame that belongs to it. @param twin_states  the states of frame `frame`, or of the one as far from the
  /// end where the twin runs backwards. @param time_s  of the scene
  BallState back(std::span<const BallState> twin_states, std::size_t ball, double time_s) const;
};

/// Why a scene does not have this symmetry, as a reader of the report is told; empty where it has.
///
/// - mirror, rotations, rescaling: every scene has them.
/// - boost: walls, slabs and barriers stand still, and drag and the Magnus force know what the air does.
/// - relabel: needs two balls; who passes a barrier is drawn by the ball's number.
/// - reverse: friction, e < 1 and drag turn motion into heat, a barrier draws, and a person acts at his time.
std::string not_symmetric(const Scenario& scene, Symmetry symmetry);

/// The twin of a scene under a symmetry, as Frame says:
/// - mirror: R = diag(-1, 1, 1).
/// - rotate_90: R about z. rotate_1_rad: about z in the plane, about (2, -3, 6)/7 in space.
/// - boost: u is the speed of the fastest ball at t = 0 in a direction that lies along no axis.
/// - relabel: a cyclic permutation by a fixed seed, so that no ball keeps its number.
/// - rescale_2: L = 8, T = ¼, M = 16. rescale_1_7: L = 1.7, T = 1.3, M = 2.3.
/// - reverse: the states at the end with velocities and spins turned round, for as long again. All forces of
/// a
///   scene that is not refused are even in that: gravity, and the Magnus force s ω × v, with two factors that
///   turn round.
/// @param final_states  how a run of the scene ended; used by reverse alone
/// @pre not_symmetric() is empty
Twin make_twin(const Scenario& scene, Symmetry symmetry, std::span<const BallState> final_states);

/// The twin in which every coordinate of the balls' positions is moved by up to ±position_m, and of their
/// velocities by up to ±velocity_mps, evenly and by a fixed seed. Immovable balls stay as they are.
Twin disturbed_twin(const Scenario& scene, double position_m, double velocity_mps);

/// The speed of the fastest ball at t = 0, m/s.
double fastest_mps(const Scenario& scene);

}  // namespace carom
