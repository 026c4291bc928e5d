#pragma once

#include <span>
#include <vector>

#include "engine/engine.h"
#include "scenario/cast.h"
#include "scenario/scenario.h"

namespace carom {

/// The conserved quantities of a set of balls. Balls of infinite mass are left out: they are part of the
/// surroundings, like the walls.
struct Conserved {
  double energy_J = 0.0;                     ///< kinetic (translation, rotation) and in the field of gravity
  Vec3 momentum_Ns = Vec3::Zero();           ///< P
  Vec3 angular_momentum_Nms = Vec3::Zero();  ///< L about Reference::origin
};

/// What the conserved quantities of a scene are measured from and against, computed from its first moment.
///
/// - Energy: the potential energy of a ball is zero where gravity would bring it to rest on a wall, and where
/// it
///   starts if no wall is below it. So E_0 is the energy that the scene can turn into motion.
/// - A ball that an event adds starts where it is added. One that grows keeps its zero.
/// - Angular momentum is taken about the centre of mass at t = 0, a point at rest.
struct Reference {
  explicit Reference(const Scenario& scenario);

  const Scenario* scenario;
  Vec3 origin = Vec3::Zero();           ///< m, centre of mass at t = 0
  Vec3 origin_velocity = Vec3::Zero();  ///< m/s, of the centre of mass at t = 0
  double mass_kg = 0.0;                 ///< of the movable balls
  std::vector<double> fall_m;           ///< per ball, how deep gravity can pull it from where it starts
  std::vector<Vec3> home;               ///< m, per ball, where it starts
  Conserved start;
  /// E_0, or where that is 0 the kinetic energy that gravity can give, or that events give in velocities
  double energy_scale_J = 0.0;
  /// Σ m|v|, or where that is 0 the impulse that gravity gives, or that events give in velocities
  double momentum_scale_Ns = 0.0;
  double angular_momentum_scale_Nms = 0.0;  ///< momentum scale × size of the scene

  /// Of the balls that are there.
  Conserved of(std::span<const BallState> balls, const Cast& cast) const;

  /// Of one of them, by its number.
  Conserved of(const Ball& ball, std::size_t number) const;

 private:
  void begin(const Ball& ball);
  void add(const Ball& ball, const BallState& state, std::size_t number, Conserved& sum) const;

  Vec3 gravity_;          ///< m/s²; zero where there is none
  double strength_mps2_;  ///< of gravity
};

}  // namespace carom
