#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "reference/closed_form/twofold.h"

namespace carom::closed_form {

/// One coordinate of a ball's centre and what bounds it.
struct AxisScene {
  Twofold position_m;
  Twofold velocity_mps;
  double acceleration_mps2 = 0.0;
  std::optional<Twofold> low_m, high_m;  ///< where the centre is when the ball touches the wall
  double restitution = 1.0;
  double touch_m = 0.0;  ///< a start this near to a wall touches it
  Twofold horizon_s;     ///< the motion is wanted up to here
};

struct AxisState {
  Twofold position_m;
  Twofold velocity_mps;
  Twofold area_ms;  ///< ∫ position dt since t = 0
  std::int64_t bounces = 0;
};

/// The places that a coordinate visits.
struct AxisRange {
  Twofold low_m;
  Twofold high_m;
};

/// One coordinate under a constant acceleration a between up to two walls of restitution e: a finite list of
/// exact parabolas and what it ends in.
///
///   e = 1: from the first bounce on the motion repeats itself, and time is folded into one lap.
///   e < 1, a towards a wall that is no longer left for the opposite one: the bounces form a geometric
///   series,
///          which ends at a finite time; then rest.
///   otherwise: the parabola after the last bounce before the horizon.
class AxisMotion {
 public:
  explicit AxisMotion(const AxisScene& scene);

  /// False where there are more bounces than are listed; nothing else may be asked then.
  bool complete() const { return complete_; }
  /// Whether a wall pushes before the horizon, at a bounce or at rest.
  bool touches_wall() const { return pieces_.size() > 1 || series_.has_value(); }
  AxisRange range() const { return range_; }
  AxisState at(const Twofold& time_s) const;

 private:
  /// A wall across the axis, +1 the high one and -1 the low one.
  using Side = int;
  struct Piece {
    Twofold start_s;
    AxisState state;  ///< at the start
  };
  struct Hit {
    Side side;
    Twofold after_s;
    Twofold speed_mps;  ///< towards the wall
  };
  /// All bounces left at a wall: flight k leaves it at e^k times the first speed, e^k times the first time
  /// left before the end.
  struct Series {
    Side side;
    AxisState state;  ///< at the start
    Twofold left_s;   ///< from the start to the end of all bounces
    Twofold end_s;
    Twofold speed_mps;  ///< of the first flight, away from the wall
  };

  void follow();
  bool starts_at_rest(Side side) const;
  std::optional<Hit> arrival(Side side, const AxisState& state) const;
  std::optional<Hit> next_arrival(const AxisState& state) const;
  void bounce(const Hit& hit);
  bool settles(Side side);
  bool repeats(Side side);
  void cover(const AxisState& from, const Twofold& time_s);
  AxisState in_series(const Twofold& time_s) const;
  AxisState height_in_series(const Twofold& left_s) const;
  std::int64_t flight_in_series(const Twofold& left_s) const;
  const Twofold& wall_m(Side side) const { return side > 0 ? *scene_.high_m : *scene_.low_m; }

  AxisScene scene_;
  std::vector<Piece> pieces_;
  AxisRange range_;
  bool complete_ = true;
  std::optional<Series> series_;
  std::optional<std::size_t> lap_piece_;  ///< the piece with which the lap begins that repeats itself
  Twofold lap_s_;
  AxisState lap_end_;  ///< only its totals, which every lap adds to
};

}  // namespace carom::closed_form
