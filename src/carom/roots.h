#pragma once

#include <optional>
#include <vector>

namespace carom {

/// Coefficients c₀ + c₁ t + c₂ t² + …
using Polynomial = std::vector<double>;

double value_at(const Polynomial& f, double t);

/// The roots in (0, end) at which f changes sign, ascending. Between neighbouring roots of its derivative,
/// found in the same way, a polynomial is monotonic and a change of sign encloses one root; bisection then
/// runs until neighbouring doubles are reached.
std::vector<double> sign_changes(const Polynomial& f, double end);

/// The first time in (0, end) at which f goes from positive to negative.
std::optional<double> first_fall_through_zero(const Polynomial& f, double end);

}  // namespace carom
