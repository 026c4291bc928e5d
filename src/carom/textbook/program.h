#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "engine/engine.h"
#include "scenario/scenario.h"

namespace carom::textbook {

using Vec3f = Eigen::Vector3f;

/// A ball as the course program keeps it: single precision, metres, and a velocity in metres per update.
struct ProgramBall {
  float mass = 1.0F;        ///< kg
  float radius = 1.0F;      ///< m
  Vec3f x = Vec3f::Zero();  ///< m
  Vec3f v = Vec3f::Zero();  ///< m per update
  float angle_x = 0.0F;     ///< rad, at which the ball is drawn
  float angle_y = 0.0F;     ///< rad
};

/// The course program that Carom grew from, formula by formula and in its order. It is here to be measured:
/// nothing in it is put right.
///
/// The program has no time step. An update moves every ball by its velocity, so a velocity is a length per
/// update, and how fast a ball is on a screen depends on how often the screen is drawn:
///   v = v_mps · update_s.                                                                     (1)
/// An update, in this order:
///   every ball: v += g (m per update², where the scene has gravity), x += v,
///               angle_x += 0.1 v_x/r, angle_y += 0.1 v_y/r;                                   (2)
///   every wall and ball: past it and approaching, v −= 2 (v·n) n;                             (3)
///   every ordered pair (1, 2), so each pair of balls twice, with d = |x₁ − x₂|:
///     d < r₁ + r₂ is an overlap;                                                              (4)
///     n = (x₁ − x₂)/d, s = (v₁ − v₂)·n; if s ≤ 0: p = 2 s/(m₁ + m₂),
///     v₁ −= p m₂ n, v₂ += p m₁ n;                                                             (5)
///     o = d − (r₁ + r₂); x₁ −= o (x₁ − x₂)/d, then x₂ += o (x₁ − x₂)/d with x₁ where it is now. (6)
/// The formulas are the program's, all but three things that its text leaves open, in which it is given what
/// the plainest such program has: gravity in (2), the walls of (3), and that balls move before they meet.
class Program {
 public:
  explicit Program(const Scenario& scene);

  /// Sets how long an update lasts: velocities are metres per update. @pre update_s > 0
  void set_update(double update_s);

  void update();

  const std::vector<ProgramBall>& balls() const { return balls_; }
  double update_s() const { return update_s_; }

  /// What walls pushed, and what changed the energy. What (6) does to the angular momentum is not booked:
  /// nothing in the scene has done it.
  const Tally& tally() const { return tally_; }

 private:
  struct ProgramWall {
    Vec3f normal;
    float offset;  ///< m
  };

  void move(ProgramBall& ball) const;
  void meet_walls(ProgramBall& ball);
  void meet(ProgramBall& one, ProgramBall& two);
  void exchange(ProgramBall& one, ProgramBall& two, float d);
  void push_apart(ProgramBall& one, ProgramBall& two, float d);
  Vec3 velocity_mps(const ProgramBall& ball) const { return ball.v.cast<double>() / update_s_; }
  double kinetic_energy(const ProgramBall& ball) const;  ///< J

  std::vector<ProgramBall> balls_;
  std::vector<ProgramWall> walls_;
  bool collide_;
  Vec3 gravity_;  ///< m/s²
  Vec3f fall_;    ///< m per update², gravity as the program adds it
  double update_s_ = 1.0;
  Tally tally_;
};

}  // namespace carom::textbook
