#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "carom/time_of_impact.h"
#include "carom/world.h"

namespace carom {

/// Which contacts are slow enough to be rest, and how much of it rounding is: by the step, by what the fields
/// give in one, and by the balls of the cluster at hand. `Balls` are Flights (flights.h).
template <int Dim, class Balls>
class RestRule {
 public:
  /// Of the step: a rebound that is over sooner is left out. A drop under g loses at most g (kRestShare h)²/8
  /// of height by it, 2e-11 m at h = 1/240 s.
  static constexpr double kRestShare = 1e-3;
  /// The same for e = 1, where every loss counts: at h = 1/240 s a rebound of 2e-17 m, below the rounding of
  /// heights.
  static constexpr double kElasticRestShare = 1e-6;

  explicit RestRule(const Balls& flights) : flights_(flights) {}

  /// Whether a contact with this normal velocity and acceleration (both negative when closing) stays closed.
  /// @param place_m  the size of the balls' coordinates
  /// @param rough    whether an impact at the contact does something along the surface
  bool comes_to_rest(double v_n, double a_n, double restitution, double speeds, double place_m,
                     bool rough) const {
    const double rounding = velocity_rounding(speeds + flights_.field_speed());
    const double step_s = flights_.step_s();
    if (restitution < 1.0 && -v_n <= unseen(place_m)) return true;
    if (a_n * step_s >= -rounding) return false;
    // A rough impact without rebound still has a law for what it does along the surface.
    if (rough && -v_n > flights_.field_speed() + rounding) return false;
    const double rebound = std::max(-v_n - rounding, 0.0) * restitution;
    const double share = restitution < 1.0 ? kRestShare : kElasticRestShare;
    return rebound == 0.0 || 2.0 * rebound < share * step_s * -a_n;
  }

  /// Begins a cluster without balls.
  void begin_cluster() {
    rounding_ = velocity_rounding(flights_.field_speed());
    place_m_ = 0.0;
  }

  /// A ball of the cluster, as it is now.
  void take_in(std::uint32_t ball) {
    const double speed = flights_.world().velocity[ball].norm();
    place_m_ = std::max(place_m_, flights_.world().position[ball].cwiseAbs().maxCoeff());
    rounding_ = std::max(rounding_, velocity_rounding(2.0 * speed + flights_.field_speed()));
  }

  /// m/s, of the velocities in the cluster.
  double rounding() const { return rounding_; }

  /// How slowly balls close whose rebound is left out, m/s.
  double slow() const { return kRestShare * flights_.field_speed() + unseen(place_m_); }

  /// How slowly a contact that is held may open, m/s: what the sweeps leave of a large pile is not worth
  /// another impact.
  double still() const { return std::max(rounding_, kRestShare * slow()); }

  /// As good as closed: the gap is one that a rebound left out could have, and the balls close as slowly, if
  /// at all.
  bool closed(double gap, double v_n, const Vec<Dim>& place) const {
    const double rounding = 16.0 * kEpsilon * place.cwiseAbs().maxCoeff();
    if (gap > kRestShare * slow() * flights_.step_s() + rounding || v_n > still()) return false;
    return v_n >= -slow() - rounding_;
  }

  /// How much of a closing velocity may be left, m/s: rounding, or as little of what the fields give in a
  /// step as leaves a step's overlap, tolerance × h, below the rounding of places.
  double tolerance() const {
    return std::max({rounding_, kStaticsShare * flights_.field_speed(), kRestShare * unseen(place_m_)});
  }

  /// The same for a crowd, which is of first order anyway.
  double crowd_tolerance() const { return std::max(tolerance(), kCrowdLeaves * flights_.field_speed()); }

 private:
  /// Of what the fields give: what statics may leave.
  static constexpr double kStaticsShare = 1e-14;
  /// The same of a crowd: at h = 1/240 s a closing speed of 4e-12 m/s, an overlap of 2e-14 m.
  static constexpr double kCrowdLeaves = 1e-10;

  /// What moves a ball in a step by less than its place is rounded, m/s. Balls that have lost all but this in
  /// a collapse would go on losing it forever.
  double unseen(double place_m) const { return kEpsilon * place_m / flights_.step_s(); }

  const Balls& flights_;
  double rounding_ = 0.0;
  double place_m_ = 0.0;  ///< the largest coordinate of a ball
};

}  // namespace carom
