#pragma once

#include <algorithm>
#include <optional>

#include "reference/closed_form/twofold.h"

// Uniformly accelerated motion along a line.

namespace carom::closed_form {

struct Arrival {
  Twofold after_s;
  Twofold speed_mps;  ///< towards what is arrived at, > 0
};

/// The first moment s >= 0 at which the distance d is covered, with the velocity v and the acceleration a
/// counted towards what is d away:
///
///   v s + ½ a s² = d                             (1)
///   s = 2 d / (v + √(v² + 2 a d))    for v > 0   (2)
///   s = (√(v² + 2 a d) - v) / a      for v <= 0  (3)
///
/// Neither form subtracts what is nearly equal. The root is the speed of arrival; at 0 the motion turns at
/// d, which is no arrival. An overlap by rounding, d < 0, counts as 0.
inline std::optional<Arrival> first_arrival(const Twofold& distance_m, const Twofold& velocity_mps,
                                            const Twofold& acceleration_mps2) {
  const Twofold d = std::max(Twofold(0.0), distance_m);
  const Twofold& v = velocity_mps;
  const Twofold& a = acceleration_mps2;
  const Twofold square = v * v + d * (a * 2.0);
  if (square <= 0.0) return std::nullopt;
  const Twofold speed = sqrt(square);
  if (v > 0.0) return Arrival{d * 2.0 / (v + speed), speed};
  if (a > 0.0) return Arrival{(speed - v) / a, speed};
  return std::nullopt;
}

/// When the velocity v + a t changes sign; at the start where it never does.
inline Twofold turn_s(const Twofold& velocity_mps, const Twofold& acceleration_mps2) {
  return velocity_mps * acceleration_mps2 < 0.0 ? -velocity_mps / acceleration_mps2 : Twofold(0.0);
}

}  // namespace carom::closed_form
