#pragma once

#include <array>
#include <boost/multiprecision/mpfr.hpp>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/vec.h"

namespace carom::exact {

/// Of double, in which bounds are reckoned and the scene's numbers are given.
inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// The time of what does not happen.
inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// A number with as many decimal digits as the Digits in force say; every operation on it is rounded
/// correctly to them (MPFR). A double is taken over exactly where they are 17 or more.
using Real = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<0>,
                                           boost::multiprecision::et_off>;

/// While it lives, new numbers have so many decimal digits.
class Digits {
 public:
  explicit Digits(int count) : count_(count), before_(Real::default_precision()) {
    Real::default_precision(static_cast<unsigned>(count));
  }
  Digits(const Digits&) = delete;
  Digits& operator=(const Digits&) = delete;
  ~Digits() { Real::default_precision(before_); }

  int count() const { return count_; }

 private:
  int count_;
  unsigned before_;
};

/// A vector of such numbers, in the scene's frame.
struct Vector {
  std::array<Real, 3> c;

  Vector() = default;
  Vector(Real x, Real y, Real z) : c{std::move(x), std::move(y), std::move(z)} {}
  explicit Vector(const Vec3& v) : c{Real(v.x()), Real(v.y()), Real(v.z())} {}

  Vector& operator+=(const Vector& b) {
    for (std::size_t k = 0; k < 3; ++k) c[k] += b.c[k];
    return *this;
  }
  Vector& operator-=(const Vector& b) {
    for (std::size_t k = 0; k < 3; ++k) c[k] -= b.c[k];
    return *this;
  }
  Vector& operator*=(const Real& s) {
    for (Real& component : c) component *= s;
    return *this;
  }
};

inline Vector operator+(Vector a, const Vector& b) {
  return a += b;
}
inline Vector operator-(Vector a, const Vector& b) {
  return a -= b;
}
inline Vector operator*(Vector a, const Real& s) {
  return a *= s;
}

inline Real dot(const Vector& a, const Vector& b) {
  return a.c[0] * b.c[0] + a.c[1] * b.c[1] + a.c[2] * b.c[2];
}

inline Vector cross(const Vector& a, const Vector& b) {
  return {a.c[1] * b.c[2] - a.c[2] * b.c[1], a.c[2] * b.c[0] - a.c[0] * b.c[2],
          a.c[0] * b.c[1] - a.c[1] * b.c[0]};
}

inline Real length(const Vector& a) {
  return sqrt(dot(a, a));
}

/// The nearest vector of doubles.
inline Vec3 rounded(const Vector& a) {
  return {a.c[0].convert_to<double>(), a.c[1].convert_to<double>(), a.c[2].convert_to<double>()};
}

}  // namespace carom::exact
