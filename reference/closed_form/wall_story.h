#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reference/closed_form/timeline.h"
#include "reference/closed_form/twofold_vector.h"
#include "scenario/scenario.h"

namespace carom::closed_form {

/// A ball from a moment on, under constant accelerations of its centre and of its spin.
struct Stretch {
  Twofold start_s;
  Vec3Twofold position_m;
  Vec3Twofold velocity_mps;
  Vec3Twofold spin_radps;
  Vec3Twofold area_ms;  ///< ∫ position dt since t = 0
  std::int64_t impacts = 0;
  Vec3Twofold acceleration_mps2;
  Vec3Twofold spin_rate_radps2;

  /// The same stretch, begun at a later moment.
  Stretch from(const Twofold& time_s) const;
};

/// The story of one ball and one rough wall: it flies, bounces, comes to rest on the wall, slides and rolls,
/// in stretches of constant acceleration.
///
/// n is the wall's unit normal, towards the ball; r the ball's radius, m its mass and κ m r² its moment of
/// inertia; g_n = -g·n presses the ball on, and g_t is what is left of gravity along the wall. The ball's
/// surface slips over the wall at
///
///   s = v_t + ω × (-r n)                                                            (1)
///
/// and a force f along the wall, on the contact at -r n, gives
///
///   m dv/dt = f,   κ m r² dω/dt = -r n × f,   so that   ds/dt = (1 + 1/κ) f / m     (2)
///
/// The spin about n is kept: a contact at a point exerts no moment about it.
class WallStory {
 public:
  /// @param wall  the first wall that the ball meets, if any
  WallStory(const Scenario& scenario, const Ball& ball);

  /// Follows the ball up to the horizon. Says why it cannot, or nothing.
  std::string follow();

  /// The wall that pushes before the horizon; null where none does.
  const Wall* wall() const { return lying_ || now_.impacts > 0 ? wall_ : nullptr; }
  /// Its unit normal, beyond a double's rounding.
  const Vec3Twofold& normal() const { return normal_; }
  Stretch at(const Twofold& time_s) const { return stretch_at(stretches_, time_s).from(time_s); }

  /// Whether it comes to overlap a wall that is not its own.
  bool overlaps_another() const;
  /// No coordinate of the centre gets larger.
  double farthest_m() const;
  /// No point of the surface gets faster, or falls faster.
  double fastest_mps() const;

 private:
  Vec3Twofold slip_mps() const;
  bool starts_lying_on(const Wall& wall) const;
  void find_wall();
  Vec3Twofold along_wall(const Vec3Twofold& v) const { return v - normal_ * normal_.dot(v); }
  void begin(const Vec3Twofold& acceleration_mps2, const Vec3Twofold& friction_mps2);
  void end_after(const Twofold& time_s);
  void fly();
  void bounce(const Twofold& speed_mps);
  void come_to_rest();
  std::string slide_or_roll();
  void roll();
  void slide(const Vec3Twofold& direction, const Twofold& slip_mps);
  Twofold end_s(std::size_t stretch) const;
  bool overlaps(const Wall& wall) const;

  const Scenario& scenario_;
  const Ball& ball_;
  Twofold horizon_s_;
  const Wall* wall_ = nullptr;
  Vec3Twofold normal_;
  Twofold pressing_mps2_;   ///< g_n
  Vec3Twofold along_mps2_;  ///< g_t
  Stretch now_;
  bool lying_ = false;
  bool ends_ = false;  ///< the last stretch lasts up to the horizon
  std::vector<Stretch> stretches_;
};

}  // namespace carom::closed_form
