#include "reference/exact/meeting.h"

#include <array>

#include "reference/exact/polynomial.h"

namespace carom::exact {

std::optional<Real> balls_meet(const Relative& motion, const Real& distance_m, const Slack& slack,
                               const Real& end_s) {
  const Real f = dot(motion.d, motion.d) - distance_m * distance_m;
  const Real b = dot(motion.d, motion.v);
  const bool touching = f <= 2 * distance_m * slack.length_m;
  if (touching && b < -slack.speed_mps * distance_m) return Real(0);
  if (motion.accelerated) {
    const std::array<Real, 5> powers = {f, 2 * b, dot(motion.v, motion.v) + dot(motion.d, motion.a),
                                        dot(motion.v, motion.a), dot(motion.a, motion.a) / 4};
    return first_fall(powers, end_s);
  }
  if (touching || b >= 0) return std::nullopt;
  const Real square = b * b - dot(motion.v, motion.v) * f;
  if (square < 0) return std::nullopt;
  return f / (sqrt(square) - b);
}

std::optional<Real> wall_reached(const Real& gap_m, const Real& v_mps, const Real& a_mps2,
                                 const Slack& slack) {
  const bool touching = gap_m <= slack.length_m;
  if (touching && v_mps < -slack.speed_mps) return Real(0);
  const Real square = v_mps * v_mps - 2 * a_mps2 * gap_m;
  if (v_mps < 0 && !touching) {
    if (square < 0) return std::nullopt;
    return 2 * gap_m / (sqrt(square) - v_mps);
  }
  if (a_mps2 >= 0) return std::nullopt;
  return (v_mps + (square > 0 ? Real(sqrt(square)) : Real(0))) / -a_mps2;
}

}  // namespace carom::exact
