#include "carom/roots.h"

namespace carom {

namespace {

Polynomial derivative(const Polynomial& f) {
  Polynomial result;
  for (std::size_t power = 1; power < f.size(); ++power) {
    result.push_back(static_cast<double>(power) * f[power]);
  }
  return result;
}

/// @pre f has different signs at low and high.
double bisect(const Polynomial& f, double low, double high) {
  const bool rises = value_at(f, high) > 0.0;
  while (true) {
    const double middle = low + 0.5 * (high - low);
    if (middle <= low || middle >= high) return middle;
    ((value_at(f, middle) > 0.0) == rises ? high : low) = middle;
  }
}

}  // namespace

double value_at(const Polynomial& f, double t) {
  double value = 0.0;
  for (std::size_t power = f.size(); power-- > 0;) value = value * t + f[power];
  return value;
}

FewNumbers sign_changes(const Polynomial& f, double end) {
  FewNumbers roots;
  if (f.size() < 2) return roots;
  FewNumbers ends = sign_changes(derivative(f), end);
  ends.push_back(end);
  double low = 0.0;
  for (const double high : ends) {
    if ((value_at(f, low) > 0.0) != (value_at(f, high) > 0.0)) roots.push_back(bisect(f, low, high));
    low = high;
  }
  return roots;
}

std::optional<double> first_fall_through_zero(const Polynomial& f, double end) {
  bool positive = value_at(f, 0.0) > 0.0;
  for (const double root : sign_changes(f, end)) {
    if (positive) return root;
    positive = true;
  }
  return std::nullopt;
}

}  // namespace carom
