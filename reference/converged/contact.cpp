#include "reference/converged/contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom::converged {

namespace {

/// How many units of a run's last bit a gap is unsure by: the polynomials' remainders and roundings, a dozen
/// of each for two balls, with room.
constexpr int kUnits = 6;  // as a power of two

/// With γ' = u and γ'' >= -A the gap stays open for
///
///   γ + u τ - A τ²/2 >= 0,   that is up to   τ = 2 γ / (-u + √(u² + 2 A γ))                      (1)
///
/// (for u >= 0 without cancellation τ = (u + √…)/A). Without A: τ = γ/(-u), or for ever.
Real surely_open_s(const Real& gap_m, const Real& rate_mps, const Real& inward_mps2) {
  const Real root = sqrt(rate_mps * rate_mps + 2 * inward_mps2 * gap_m);
  if (rate_mps < 0) return 2 * gap_m / (root - rate_mps);
  if (inward_mps2 == 0) return std::numeric_limits<Real>::infinity();
  return (rate_mps + root) / inward_mps2;
}

/// How long a gap that is closed and at rest, but curves open by γ'' = c > 0, surely stays open:
///
///   γ >= u τ + c τ²/2 - B τ³/6 >= c τ²/4 - w τ >= 0   for   4 w/c <= τ <= 3 c/(2 B),             (2)
///
/// with |u| <= w and |γ'''| <= B. Returns the end of that, or 0 where there is no such τ.
Real curving_open_s(const Real& curvature_mps2, const GapBounds& bounds, const Real& weak_mps) {
  if (curvature_mps2 <= 0) return 0;
  if (bounds.most_jerk_mps3 == 0) return std::numeric_limits<Real>::infinity();
  const Real end_s = 3 * curvature_mps2 / (2 * bounds.most_jerk_mps3);
  return end_s > 4 * weak_mps / curvature_mps2 ? end_s : Real(0);
}

/// How far the gap surely stays open, by steps of (1) in double, for most gaps are wide: as far as it is
/// wider than kWide of the numbers that it comes from. Double's rounding, some 2^-46 of them over the many
/// terms, is put against the gap and the speed as kUnsure, and so is that of the times, as the way within
/// them.
template <class AnyGap>
double sketched_open_until_s(const AnyGap& gap, const GapBounds& bounds, double from_s, double until_s,
                             std::int64_t& work) {
  constexpr double kWide = 0x1p-20;
  constexpr double kUnsure = 0x1p-36;
  const double speed = static_cast<double>(bounds.most_speed_mps);
  const double inward = static_cast<double>(bounds.most_inward_mps2) * (1.0 + kUnsure);
  double time_s = from_s;
  while (time_s <= until_s) {
    work += gap.sketch_cost();
    const SketchedGap now = gap.sketch_at(time_s);
    const double size = now.size_m + speed * time_s;
    const double open = now.gap_m - kUnsure * size;
    if (!(open > kWide * size)) break;
    const double rate = now.rate_mps - kUnsure * speed;
    const double root = std::sqrt(rate * rate + 2.0 * inward * open);
    const double step_s =
        rate < 0.0 ? 2.0 * open / (root - rate) : (rate + root) / inward;  // may be infinite
    if (!(time_s + step_s > time_s)) break;
    time_s += step_s;
  }
  return time_s;
}

/// Steps of (1) come near a root from the left: by Newton's method, all but, where the bodies meet at some
/// speed, and by halves where they graze. They end in contact when the gap is closed within its resolution ρ.
/// Bodies that are apart by more than ρ at the closest are never taken for touching, and bodies that overlap
/// by more than ρ are never passed. What is left are those that meet at less than w = √(32 A ρ) or at less
/// than rounding leaves unsure of the speed: `unresolved`.
template <class AnyGap>
FirstContact search(const AnyGap& gap, const Real& from_s, const Real& until_s, std::int64_t& work) {
  const GapBounds bounds = gap.bounds();
  Real time_s = from_s;
  if (gap.is_sketched()) {
    const auto end_s = static_cast<double>(until_s);
    const double open_s = sketched_open_until_s(gap, bounds, static_cast<double>(from_s), end_s, work);
    if (open_s > end_s) return {};
    time_s = std::max(from_s, Real(open_s));
  }
  while (time_s <= until_s) {
    work += gap.cost();
    const Gap now = gap.at(time_s);
    const Real open_m = std::max(now.gap_m, Real(0));
    Real step_s = surely_open_s(open_m, now.rate_mps, bounds.most_inward_mps2);
    if (now.gap_m <= now.resolution_m) {
      const Real weak_mps = sqrt(32 * bounds.most_inward_mps2 * now.resolution_m) + bounds.unsure_mps;
      if (now.rate_mps < -weak_mps) return {Found::impact, time_s};
      if (now.rate_mps <= weak_mps) {
        step_s = curving_open_s(now.curvature_mps2, bounds, weak_mps);
        if (step_s == 0) return {Found::unresolved, time_s};
      }
    }
    const Real next_s = time_s + step_s;
    // A step below the time's own rounding leads nowhere: the gap closes within it.
    if (next_s <= time_s) return {now.rate_mps < 0 ? Found::impact : Found::unresolved, time_s};
    time_s = next_s;
  }
  return {};
}

}  // namespace

WallGap::WallGap(const Piece& piece, double radius_m, const Wall& wall, int bits)
    : piece_(piece),
      normal_(widened(wall.normal)),
      plain_normal_(wall.normal),
      reach_m_(Real(wall.offset) + radius_m),
      bits_(bits) {}

/// γ = n·x - offset - r, as the scene defines it.
Gap WallGap::at(const Real& time_s) const {
  const Kinematics now = piece_.at(time_s);
  const Real size = now.x.cwiseAbs().sum() + abs(reach_m_);
  return {normal_.dot(now.x) - reach_m_, normal_.dot(now.v), normal_.dot(now.a), ldexp(size, kUnits - bits_)};
}

SketchedGap WallGap::sketch_at(double time_s) const {
  Vec3 x;
  Vec3 v;
  piece_.sketch_at(time_s, x, v);
  const auto reach = static_cast<double>(reach_m_);
  return {plain_normal_.dot(x) - reach, plain_normal_.dot(v), x.cwiseAbs().sum() + std::abs(reach)};
}

GapBounds WallGap::bounds() const {
  const Real n = normal_.norm();
  return {n * piece_.most_acceleration_mps2(), n * piece_.most_jerk_mps3(), piece_.most_speed_mps(),
          ldexp(piece_.most_speed_mps(), kUnits - bits_)};
}

PairGap::PairGap(const Piece& a, double radius_a_m, const Piece& b, double radius_b_m, int bits)
    : a_(a), b_(b), reach_m_(Real(radius_a_m) + radius_b_m), bits_(bits) {}

/// With d = x_b - x_a and R the sum of the radii, γ = |d| - R, and by differentiating |d|² = d·d
///
///   γ' = d·d'/|d|,   γ'' = (d·d'' + |d'|² - γ'²)/|d|                                             (3)
Gap PairGap::at(const Real& time_s) const {
  const Kinematics a = a_.at(time_s);
  const Kinematics b = b_.at(time_s);
  const Vector d = b.x - a.x;
  const Vector u = b.v - a.v;
  const Real distance = d.norm();
  const Real rate = d.dot(u) / distance;
  const Real curvature = (d.dot(b.a - a.a) + u.squaredNorm() - rate * rate) / distance;
  const Real size = a.x.cwiseAbs().sum() + b.x.cwiseAbs().sum() + reach_m_;
  return {distance - reach_m_, rate, curvature, ldexp(size, kUnits - bits_)};
}

SketchedGap PairGap::sketch_at(double time_s) const {
  Vec3 x_a;
  Vec3 v_a;
  Vec3 x_b;
  Vec3 v_b;
  a_.sketch_at(time_s, x_a, v_a);
  b_.sketch_at(time_s, x_b, v_b);
  const double distance = (x_b - x_a).norm();
  const auto reach = static_cast<double>(reach_m_);
  const double size = x_a.cwiseAbs().sum() + x_b.cwiseAbs().sum() + reach;
  return {distance - reach, (x_b - x_a).dot(v_b - v_a) / distance, size};
}

/// In (3) |d'|² >= γ'², hence γ'' >= -|d''| >= -A, A the sum of the two most accelerations. Once more
/// differentiated, |d| γ''' = d·d''' + 3 (d'·d'' - γ' γ''), so that with |d| = R, |d'| <= U and |d'''| <= J
///
///   |γ'''| <= J + 3 (U A + U (A + U²/R))/R = J + 6 U A/R + 3 U³/R²                                (4)
GapBounds PairGap::bounds() const {
  const Real u = a_.most_speed_mps() + b_.most_speed_mps();
  const Real a = a_.most_acceleration_mps2() + b_.most_acceleration_mps2();
  const Real j = a_.most_jerk_mps3() + b_.most_jerk_mps3();
  const Real r = reach_m_;
  return {a, j + 6 * u * a / r + 3 * u * u * u / (r * r), u, ldexp(u, kUnits - bits_)};
}

FirstContact first_contact(const WallGap& gap, const Real& from_s, const Real& until_s, std::int64_t& work) {
  return search(gap, from_s, until_s, work);
}

FirstContact first_contact(const PairGap& gap, const Real& from_s, const Real& until_s, std::int64_t& work) {
  return search(gap, from_s, until_s, work);
}

}  // namespace carom::converged
