#include "reference/exact/polynomial.h"

#include <utility>

namespace carom::exact {

namespace {

std::vector<Real> derivative_of(std::span<const Real> coefficients) {
  std::vector<Real> derivative;
  for (std::size_t k = 1; k < coefficients.size(); ++k) {
    derivative.push_back(coefficients[k] * static_cast<unsigned>(k));
  }
  return derivative;
}

/// The zero between low and high, where the polynomial has different signs: Newton's steps, and a halving of
/// the interval wherever one would leave it. Ends when the interval or the step is one unit of the last
/// digit.
Real zero_between(std::span<const Real> coefficients, Real low, Real high) {
  const std::vector<Real> derivative = derivative_of(coefficients);
  const bool rises = value_of(coefficients, high) > 0;
  const Real last_digit = pow(Real(10), -static_cast<int>(Real::default_precision())) * high;
  Real x = (low + high) / 2;
  while (high - low > last_digit) {
    const Real value = value_of(coefficients, x);
    if (value == 0) return x;
    ((value > 0) == rises ? high : low) = x;
    const Real slope = value_of(derivative, x);
    const Real step = slope == 0 ? Real(0) : Real(value / slope);
    Real next = x - step;
    if (slope == 0 || next <= low || next >= high) next = (low + high) / 2;
    if (abs(next - x) <= last_digit) return next;
    x = std::move(next);
  }
  return x;
}

}  // namespace

Real value_of(std::span<const Real> coefficients, const Real& x) {
  Real value = 0;
  for (std::size_t k = coefficients.size(); k-- > 0;) value = value * x + coefficients[k];
  return value;
}

std::vector<Real> sign_changes(std::span<const Real> coefficients, const Real& end) {
  if (coefficients.size() < 2) return {};
  std::vector<Real> bounds = sign_changes(derivative_of(coefficients), end);
  bounds.push_back(end);
  std::vector<Real> zeros;
  Real low = 0;
  Real value_low = value_of(coefficients, low);
  for (const Real& high : bounds) {
    const Real value_high = value_of(coefficients, high);
    if ((value_low < 0 && value_high > 0) || (value_low > 0 && value_high < 0)) {
      zeros.push_back(zero_between(coefficients, low, high));
    }
    low = high;
    value_low = value_high;
  }
  return zeros;
}

std::optional<Real> first_fall(std::span<const Real> coefficients, const Real& end) {
  const std::vector<Real> derivative = derivative_of(coefficients);
  for (const Real& zero : sign_changes(coefficients, end)) {
    if (value_of(derivative, zero) < 0) return zero;
  }
  return std::nullopt;
}

}  // namespace carom::exact
