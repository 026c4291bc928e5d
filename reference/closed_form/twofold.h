#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

namespace carom::closed_form {

/// A number as the unevaluated sum of two doubles, about 32 digits, |lo| <= ulp(hi)/2.
///
/// The numbers of a scene are doubles and count as exact. Carried through a closed form in this arithmetic,
/// a result is wrong by its last rounding to double and by little else, however many bounces came before and
/// however much cancelled on the way.
///
/// Error-free sum: Knuth, The Art of Computer Programming 2, 4.2.2, theorem B. Error-free product: by fused
/// multiply-add. Sum, quotient and root of pairs: Dekker, Numer. Math. 18, 224 (1971); bounds in Joldes,
/// Muller, Popescu, ACM Trans. Math. Softw. 44, 15 (2017).
struct Twofold {
  double hi = 0.0;
  double lo = 0.0;

  Twofold() = default;
  Twofold(double value) : hi(value) {}  // implicit, as a double is one exactly
  Twofold(double high, double low) : hi(high), lo(low) {}

  /// With |lo| <= ulp(hi)/2 the pairs are ordered like their values.
  friend std::partial_ordering operator<=>(const Twofold& a, const Twofold& b) {
    return a.hi == b.hi ? a.lo <=> b.lo : a.hi <=> b.hi;
  }
  friend bool operator==(const Twofold& a, const Twofold& b) { return a.hi == b.hi && a.lo == b.lo; }
};

/// No operation below has a larger relative error: 2 to the power -102, the largest bound in Joldes et al.
/// (the quotient's, 15 u² with u = 2^-53) rounded up.
constexpr double kTwofoldUnit = 0x1p-102;

/// a + b, exactly.
inline Twofold exact_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// a b, exactly (short of underflow).
inline Twofold exact_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

inline Twofold operator-(const Twofold& a) {
  return {-a.hi, -a.lo};
}

inline Twofold operator+(const Twofold& a, const Twofold& b) {
  const Twofold high = exact_sum(a.hi, b.hi);
  const Twofold low = exact_sum(a.lo, b.lo);
  const Twofold carried = exact_sum(high.hi, high.lo + low.hi);
  return exact_sum(carried.hi, carried.lo + low.lo);
}

inline Twofold operator-(const Twofold& a, const Twofold& b) {
  return a + (-b);
}

inline Twofold operator*(const Twofold& a, const Twofold& b) {
  const Twofold high = exact_product(a.hi, b.hi);
  return exact_sum(high.hi, high.lo + (a.hi * b.lo + a.lo * b.hi));
}

inline Twofold operator/(const Twofold& a, const Twofold& b) {
  const double first = a.hi / b.hi;
  const Twofold rest = a - b * first;
  const double second = rest.hi / b.hi;
  const double third = (rest - b * second).hi / b.hi;
  return exact_sum(first, second) + third;
}

inline Twofold& operator+=(Twofold& a, const Twofold& b) {
  return a = a + b;
}
inline Twofold& operator-=(Twofold& a, const Twofold& b) {
  return a = a - b;
}
inline Twofold& operator*=(Twofold& a, const Twofold& b) {
  return a = a * b;
}
inline Twofold& operator/=(Twofold& a, const Twofold& b) {
  return a = a / b;
}

/// √a by one Newton step from the double's root; 0 where a <= 0.
inline Twofold sqrt(const Twofold& a) {
  if (a.hi <= 0.0) return 0.0;
  const double root = std::sqrt(a.hi);
  const double correction = (a - exact_product(root, root)).hi / (2.0 * root);
  return exact_sum(root, correction);
}

inline Twofold abs(const Twofold& a) {
  return a.hi < 0.0 ? -a : a;
}

/// The largest whole number not above a. @pre |a| < 2^53.
inline double floor(const Twofold& a) {
  const double whole = std::floor(a.hi);
  return whole == a.hi && a.lo < 0.0 ? whole - 1.0 : whole;
}

/// base to the power n by repeated squaring, relative error n times that of a product. @pre n >= 0.
inline Twofold power(Twofold base, std::int64_t n) {
  Twofold result = 1.0;
  for (; n > 0; n /= 2) {
    if (n % 2 == 1) result *= base;
    base *= base;
  }
  return result;
}

}  // namespace carom::closed_form
