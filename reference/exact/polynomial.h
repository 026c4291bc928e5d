#pragma once

#include <optional>
#include <span>
#include <vector>

#include "reference/exact/number.h"

namespace carom::exact {

/// c[0] + c[1] x + c[2] x² + …
Real value_of(std::span<const Real> coefficients, const Real& x);

/// All x in (0, end) where a polynomial changes its sign, ascending, to the digits in force. Between two
/// neighbouring zeros of its derivative a polynomial is monotonic and so has at most one zero, which the
/// signs at both ends tell; the zeros of the derivative are found in the same way. A zero without a change of
/// sign is none.
std::vector<Real> sign_changes(std::span<const Real> coefficients, const Real& end);

/// The first x in [0, end) from which on a polynomial is negative where before it was positive.
std::optional<Real> first_fall(std::span<const Real> coefficients, const Real& end);

}  // namespace carom::exact
