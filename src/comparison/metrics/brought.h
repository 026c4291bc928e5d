#pragma once

#include <vector>

#include "comparison/conserved.h"
#include "trajectory/trajectory.h"

namespace carom {

/// What the events of a run brought (above 0) and took (below) from the start up to each of its frames, from
/// the states in which its own engine met them: what is then expected of energy, momentum and angular
/// momentum jumps by it.
std::vector<Conserved> brought_by_events(const Reference& reference, const Run& run);

/// What one event changed in the conserved quantities.
Conserved brought_by(const Reference& reference, const Interference& interference);

/// What gravity has given to the movable balls at a time.
struct GivenByGravity {
  Vec3 impulse_Ns = Vec3::Zero();
  /// About Reference::origin, N m s; only of balls that nothing but gravity pushes from outside.
  Vec3 angular_impulse_Nms = Vec3::Zero();
};

/// Gravity g on movable balls of the total mass M, which events change. Between events, with τ since the
/// last, P the momentum and Q = Σ m (x - origin) right after it,
///   ΔP = M g τ,   ΔL = (Q τ + ½ P τ²) × g,                                            (1)
/// because Q' = P and L' = Q × g; M, P and Q jump with each event.
class GravityOverTime {
 public:
  /// The run outlives this.
  GravityOverTime(const Reference& reference, const Run& run);

  /// At the time of a frame. @pre frames are asked for in order
  GivenByGravity at_frame(std::size_t frame);

 private:
  GivenByGravity after(double since_s) const;
  void pass(double time_s, const Interference& interference);

  const Reference& reference_;
  const Run& run_;
  Vec3 gravity_;
  double from_s_ = 0.0;
  GivenByGravity before_;  ///< until from_s_
  double mass_kg_;
  Vec3 momentum_Ns_;
  Vec3 mass_moment_kgm_ = Vec3::Zero();  ///< Q
  std::size_t next_ = 0;
};

}  // namespace carom
