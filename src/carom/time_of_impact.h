#pragma once

#include <cmath>

#include "carom/flight.h"
#include "carom/roots.h"

namespace carom {

// When two bodies on their parabolas touch. Times in seconds from now; kNever where they do not.
//
// What survives round-off (M. N. Bannerman, S. Strobl, A. Formella, T. Pöschel, "Stable algorithm for event
// detection in event-driven particle dynamics", Comput. Part. Mech. 1, 191 (2014)): bodies that overlap, by
// rounding or by the scene's wish, meet now if they approach and not at all if they part; and roots are taken
// in the form 2 c / (-b + √…), which does not cancel.

inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// A normal velocity smaller than this, m/s, is rounding: the velocities after an impact carry an error of a
/// few units in the last place of the speeds that went in.
inline double velocity_rounding(double speed_sum_mps) {
  return 8.0 * kEpsilon * speed_sum_mps;
}

/// Whether bodies that touch, or overlap, close: they approach, or do neither and are pushed together by an
/// acceleration that within the horizon gives more than rounding.
inline bool closes(double v, double a, double rounding, double horizon_s) {
  return v < -rounding || (v <= rounding && a * horizon_s < -rounding);
}

/// Solves gap + v t + ½ a t² = 0 for the time at which the gap closes, whatever the sign of a. Bodies that
/// overlap and part are given until they fall back to where they are.
/// @param rounding   a speed below which v is zero (velocity_rounding())
/// @param horizon_s  how far ahead the caller looks
inline double time_to_close(double gap, double v, double a, double rounding, double horizon_s) {
  if (gap <= 0.0) {
    if (closes(v, a, rounding, horizon_s)) return 0.0;
    return v > rounding && a < 0.0 ? 2.0 * v / -a : kNever;
  }
  const double discriminant = v * v - 2.0 * a * gap;
  if (discriminant < 0.0) return kNever;
  if (v < 0.0) return 2.0 * gap / (-v + std::sqrt(discriminant));
  return a < 0.0 ? (v + std::sqrt(discriminant)) / -a : kNever;
}

/// |x × y|², the squared area spanned by two vectors.
template <int Dim>
double cross_squared(const Vec<Dim>& x, const Vec<Dim>& y) {
  if constexpr (Dim == 2) {
    const double z = x[0] * y[1] - x[1] * y[0];
    return z * z;
  } else {
    return x.cross(y).squaredNorm();
  }
}

/// When two balls touch whose relative motion is uniform: |d + w t| = σ, with d from a to b, w = v_b - v_a
/// and σ the sum of the radii.
///
/// With b = d·w the roots are t = (-b ± √D)/w², D = b² - w² (d² - σ²). D is computed as
/// (|w| σ - |d × w|)(|w| σ + |d × w|), equal by Lagrange's identity: it does not lose the miss distance
/// |d × w|/|w| when the balls come from far away.
template <int Dim>
double time_to_touch(const Vec<Dim>& d, const Vec<Dim>& w, double sigma, double rounding) {
  const double b = d.dot(w);
  const double distance = d.norm();
  if (b >= -rounding * distance) return kNever;
  if (distance <= sigma) return 0.0;
  const double reach = w.norm() * sigma;
  const double miss = std::sqrt(cross_squared<Dim>(d, w));
  if (miss > reach) return kNever;
  return (distance - sigma) * (distance + sigma) / (-b + std::sqrt((reach - miss) * (reach + miss)));
}

/// Two balls that fly straight on, seen from one of them: how soon may they touch? No later than they do.
///
/// With d and w their relative place and velocity, m and m/s, and σ the sum of their radii, m, they touch
/// where
///   |d + w t|² = d² + 2 t d·w + t² w² = σ².
/// What is off by rounding of d², of d·w and of the discriminant, is a few u = ε/2 of d², of σ² or of d² w²:
/// d² is taken a little smaller and σ² a little larger by more than that.
template <int Dim>
class Approach {
 public:
  Approach(const Vec<Dim>& d, const Vec<Dim>& w, double sigma)
      : beyond_((1.0 - kRounding) * d.squaredNorm() - (1.0 + kRounding) * (sigma * sigma)),
        closing_(-d.dot(w)),
        w_squared_(w.squaredNorm()) {}

  /// A cheap question that few pairs pass: d² + 2 t d·w <= σ² for some t up to that.
  bool may_touch_within(double time_s) const {
    // closing + |closing| is 2 max(0, closing), without a branch that every other pair would take.
    return !(beyond_ > time_s * (closing_ + std::abs(closing_)));
  }

  /// s from now; kNever where they do not.
  double first_touch_s() const {
    if (!(beyond_ > 0.0)) return 0.0;
    const double discriminant = closing_ * closing_ - beyond_ * w_squared_;
    if (closing_ <= 0.0 || discriminant < 0.0) return kNever;
    return beyond_ / (closing_ + std::sqrt(discriminant));
  }

 private:
  static constexpr double kRounding = 16.0 * kEpsilon;

  double beyond_;     ///< d² - σ², m²
  double closing_;    ///< -d·w, m²/s
  double w_squared_;  ///< m²/s²
};

/// When two balls touch that are accelerated differently: the first time up to `horizon_s` at which
/// f(t) = |d + w t + ½ a t²|² - σ², a polynomial of degree four, falls through zero. Balls that overlap and
/// part are given until they fall back to where they are: then (f(t) - f(0))/t falls through zero.
template <int Dim>
double time_to_touch(const Vec<Dim>& d, const Vec<Dim>& w, const Vec<Dim>& a, double sigma, double rounding,
                     double horizon_s) {
  const double distance = d.norm();
  const Polynomial from_here(2.0 * d.dot(w), w.squaredNorm() + d.dot(a), w.dot(a), 0.25 * a.squaredNorm());
  if (distance <= sigma) {
    const double scale = distance > 0.0 ? distance : 1.0;
    if (closes(d.dot(w) / scale, d.dot(a) / scale, rounding, horizon_s)) return 0.0;
    return first_fall_through_zero(from_here, horizon_s).value_or(kNever);
  }
  Polynomial f((distance - sigma) * (distance + sigma));
  for (const double coefficient : from_here) f.push_back(coefficient);
  return first_fall_through_zero(f, horizon_s).value_or(kNever);
}

}  // namespace carom
