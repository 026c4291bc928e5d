#include "reference/closed_form/axis_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/closed_form/accelerated.h"
#include "reference/closed_form/timeline.h"

namespace carom::closed_form {

namespace {

/// More bounces than this are not listed: at 72 bytes each the list then takes 72 MB.
constexpr std::size_t kMostPieces = 1'000'000;

/// A parabola's state at t after its start: x + v t + ½ a t², v + a t, and the area under it.
AxisState flown(const AxisState& from, const Twofold& t, const Twofold& a) {
  const Twofold& x = from.position_m;
  const Twofold& v = from.velocity_mps;
  return {x + t * (v + t * a * 0.5), v + a * t, from.area_ms + t * (x + t * (v * 0.5 + t * a / 6.0)),
          from.bounces};
}

}  // namespace

AxisMotion::AxisMotion(const AxisScene& scene) : scene_(scene) {
  pieces_.push_back({0.0, {scene.position_m, scene.velocity_mps, 0.0, 0}});
  range_ = {scene.position_m, scene.position_m};
  for (const Side side : {-1, +1}) {
    if (starts_at_rest(side)) {
      series_ = Series{side, pieces_.front().state, 0.0, 0.0, 0.0};
      return;
    }
  }
  follow();
}

bool AxisMotion::starts_at_rest(Side side) const {
  if (side > 0 ? !scene_.high_m : !scene_.low_m) return false;
  const Twofold gap = abs(wall_m(side) - scene_.position_m);
  return gap <= scene_.touch_m && scene_.velocity_mps == 0.0 && side * scene_.acceleration_mps2 > 0.0;
}

/// Bounce after bounce until the horizon, or until all that follows is known in one formula.
void AxisMotion::follow() {
  while (true) {
    const Piece& now = pieces_.back();
    const std::optional<Hit> hit = next_arrival(now.state);
    if (!hit || now.start_s + hit->after_s > scene_.horizon_s) {
      cover(now.state, scene_.horizon_s - now.start_s);
      return;
    }
    bounce(*hit);
    if (settles(hit->side) || repeats(hit->side)) return;
    if (pieces_.size() > kMostPieces) {
      complete_ = false;
      return;
    }
  }
}

std::optional<AxisMotion::Hit> AxisMotion::arrival(Side side, const AxisState& state) const {
  if (side > 0 ? !scene_.high_m : !scene_.low_m) return std::nullopt;
  const double sign = side;
  const Twofold distance_m = (wall_m(side) - state.position_m) * sign;
  const auto first =
      first_arrival(distance_m, state.velocity_mps * sign, Twofold(sign * scene_.acceleration_mps2));
  if (!first) return std::nullopt;
  return Hit{side, first->after_s, first->speed_mps};
}

std::optional<AxisMotion::Hit> AxisMotion::next_arrival(const AxisState& state) const {
  const std::optional<Hit> low = arrival(-1, state);
  const std::optional<Hit> high = arrival(+1, state);
  if (low && high) return low->after_s <= high->after_s ? low : high;
  return low ? low : high;
}

/// Ends the last piece at a wall and begins the next one there, exactly at the wall.
void AxisMotion::bounce(const Hit& hit) {
  const Piece last = pieces_.back();
  cover(last.state, hit.after_s);
  AxisState state = flown(last.state, hit.after_s, scene_.acceleration_mps2);
  state.position_m = wall_m(hit.side);
  state.velocity_mps = hit.speed_mps * (-hit.side * scene_.restitution);
  ++state.bounces;
  pieces_.push_back({last.start_s + hit.after_s, state});
}

/// After a bounce that left a wall at speed u, with g > 0 the acceleration towards the wall and the opposite
/// wall out of reach, flight k lasts 2 u e^k / g, and all of them together
///
///   R = Σ 2 u e^k / g = 2 u / (g (1 - e))        (1)
///
/// A drop from h arrives after √(2h/g) at √(2gh), so u = e √(2gh) and the end is at √(2h/g) (1+e)/(1-e).
bool AxisMotion::settles(Side side) {
  const double e = scene_.restitution;
  const double g = side * scene_.acceleration_mps2;
  const Piece& now = pieces_.back();
  if (g <= 0.0 || e == 1.0 || arrival(-side, now.state)) return false;
  const Twofold u = abs(now.state.velocity_mps);
  const Twofold left = u * 2.0 / ((Twofold(1.0) - e) * g);
  series_ = Series{side, now.state, left, now.start_s + left, u};
  cover(now.state, u * 2.0 / g);
  return true;
}

/// An elastic coordinate comes back to a wall just as it left it, after one flight or by way of the other
/// wall.
bool AxisMotion::repeats(Side side) {
  if (scene_.restitution < 1.0) return false;
  const std::size_t first = pieces_.size() - 1;
  std::optional<Hit> hit = next_arrival(pieces_.back().state);
  if (hit && hit->side != side) {
    bounce(*hit);
    hit = next_arrival(pieces_.back().state);
  }
  if (!hit) {
    cover(pieces_.back().state, scene_.horizon_s - pieces_.back().start_s);
    return true;
  }
  cover(pieces_.back().state, hit->after_s);
  lap_piece_ = first;
  lap_s_ = pieces_.back().start_s + hit->after_s - pieces_[first].start_s;
  lap_end_ = flown(pieces_.back().state, hit->after_s, scene_.acceleration_mps2);
  ++lap_end_.bounces;
  // The rounding of a lap's time, some 2^-100 of it, then grows to 2^-60 of a lap's way at most.
  constexpr double kMostLaps = 0x1p40;
  complete_ = lap_s_ * kMostLaps > scene_.horizon_s;
  return true;
}

/// Widens the range by a parabola: its ends, and its apex where the velocity changes sign in between.
void AxisMotion::cover(const AxisState& from, const Twofold& time_s) {
  const auto include = [this](const Twofold& x) {
    range_ = {std::min(range_.low_m, x), std::max(range_.high_m, x)};
  };
  const AxisState end = flown(from, time_s, scene_.acceleration_mps2);
  include(from.position_m);
  include(end.position_m);
  if ((from.velocity_mps < 0.0) != (end.velocity_mps < 0.0) && scene_.acceleration_mps2 != 0.0) {
    include(from.position_m - from.velocity_mps * from.velocity_mps / (2.0 * scene_.acceleration_mps2));
  }
}

AxisState AxisMotion::at(const Twofold& time_s) const {
  if (series_ && time_s >= series_->end_s - series_->left_s) return in_series(time_s);
  Twofold local = time_s;
  double laps = 0.0;
  if (lap_piece_ && time_s > pieces_[*lap_piece_].start_s) {
    const Twofold lap_start = pieces_[*lap_piece_].start_s;
    laps = floor((time_s - lap_start) / lap_s_);
    local = std::max(lap_start, time_s - lap_s_ * laps);
  }
  const Piece& piece = stretch_at(pieces_, local);
  AxisState state = flown(piece.state, local - piece.start_s, scene_.acceleration_mps2);
  if (laps > 0.0) {
    const AxisState& lap_begin = pieces_[*lap_piece_].state;
    state.area_ms += (lap_end_.area_ms - lap_begin.area_ms) * laps;
    state.bounces += (lap_end_.bounces - lap_begin.bounces) * static_cast<std::int64_t>(laps);
  }
  return state;
}

/// The flight k during which `left_s` is left of the time R of all bounces: e^k R >= left > e^(k+1) R. The
/// logarithm finds it to rounding, and the powers decide. @pre 0 < left_s
std::int64_t AxisMotion::flight_in_series(const Twofold& left_s) const {
  const double e = scene_.restitution;
  if (series_->left_s <= left_s) return 0;
  auto k = static_cast<std::int64_t>(std::log((left_s / series_->left_s).hi) / std::log(e));
  while (k > 0 && power(e, k) * series_->left_s < left_s) --k;
  while (power(e, k + 1) * series_->left_s >= left_s) ++k;
  return k;
}

/// The height over the wall, counted along its normal, with `left_s` left of the time of all bounces. In
/// flight k, at s after its start, it is y = u e^k s - ½ g s²; a whole flight covers ∫ y dt = ⅔ (u e^k)³ /
/// g², and the first k of them ⅔ u³ / g² (1 - e^3k) / (1 - e³).
///
/// Once no more time is left than the rounding of a double so large, the ball counts as at rest: the
/// infinitely many bounces after that are not counted, and rise no higher than g (ε t)².
AxisState AxisMotion::height_in_series(const Twofold& left_s) const {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const Series& all = *series_;
  const Twofold shortest = all.end_s * kEpsilon;
  const bool rests = left_s <= shortest;
  const Twofold left = rests ? shortest : left_s;
  if (all.left_s <= left) return {};
  const Twofold e = scene_.restitution;
  const Twofold one = 1.0;
  const double g = all.side * scene_.acceleration_mps2;
  const std::int64_t k = flight_in_series(left);
  const Twofold shrunk = power(e, k);
  const Twofold first_area = power(all.speed_mps, 3) * 2.0 / (Twofold(g) * g * 3.0);
  const Twofold area = first_area * (one - power(shrunk, 3)) / (one - power(e, 3));
  if (rests) return {0.0, 0.0, area, k};
  return flown({0.0, shrunk * all.speed_mps, area, k}, shrunk * all.left_s - left, -g);
}

AxisState AxisMotion::in_series(const Twofold& time_s) const {
  const Series& all = *series_;
  const AxisState height = height_in_series(all.end_s - time_s);
  const double outward = -all.side;
  const Twofold& wall = all.state.position_m;
  const Twofold elapsed = time_s - (all.end_s - all.left_s);
  return {wall + height.position_m * outward, height.velocity_mps * outward,
          all.state.area_ms + wall * elapsed + height.area_ms * outward, all.state.bounces + height.bounces};
}

}  // namespace carom::closed_form
