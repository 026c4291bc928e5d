#pragma once

#include <optional>

#include "reference/exact/number.h"

namespace carom::exact {

/// What counts as zero in a run: half of its digits below the scene's scales. A touch without approach (two
/// balls after an impact with e = 0 go on side by side) differs from one by rounding alone, and that is far
/// smaller than this.
struct Slack {
  Real length_m;
  Real speed_mps;
};

/// How two bodies move relative to each other: d(t) = d + v t + ½ a t², from the first's centre to the
/// second's.
struct Relative {
  Vector d;
  Vector v;
  Vector a;
  bool accelerated = false;  ///< a is not zero
};

/// When the centres come as near as `distance_m`, seconds from now; nothing where they do not before end_s.
/// Balls that touch or overlap by rounding meet now if they approach, and not if they part.
///
/// |d(t)|² = R². Without acceleration, with f = |d|² - R², b = d·v:
///
///   t = f / (-b + √(b² - |v|² f))        for b < 0                                        (1)
///
/// the smaller root in the form in which nothing cancels (M. N. Bannerman, S. Strobl, A. Formella, T.
/// Pöschel, Comput. Part. Mech. 1, 191 (2014), equation 7). With acceleration (a falling ball and an
/// immovable one)
///
///   f + 2 b t + (|v|² + d·a) t² + (v·a) t³ + ¼ |a|² t⁴ = 0                              (2)
std::optional<Real> balls_meet(const Relative& motion, const Real& distance_m, const Slack& slack,
                               const Real& end_s);

/// When a ball reaches a wall, seconds from now: gap + v t + ½ a t² = 0, all along the wall's normal, at the
/// root where the gap goes from positive to negative:
///
///   t = 2 gap / (-v + √(v² - 2 a gap)) = (v + √(v² - 2 a gap)) / (-a)                   (3)
///
/// the first form for v < 0, the second for v >= 0 (and a < 0), where nothing cancels.
std::optional<Real> wall_reached(const Real& gap_m, const Real& v_mps, const Real& a_mps2,
                                 const Slack& slack);

}  // namespace carom::exact
