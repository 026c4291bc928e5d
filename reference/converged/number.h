#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

#include "core/vec.h"

namespace carom::converged {

/// A binary floating-point number of 113 bits (IEEE quadruple), the same on every machine.
using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;
using Vector = Eigen::Matrix<Real, 3, 1>;

constexpr int kRealBits = 113;

inline Vector widened(const Vec3& v) {
  return v.cast<Real>();
}

inline Vec3 rounded(const Vector& v) {
  return v.cast<double>();
}

/// 2^exponent
inline Real power_of_two(int exponent) {
  return ldexp(Real(1), exponent);
}

/// x rounded to its leading `bits` bits. In (2^s + 1) x the bits below are pushed out (T. J. Dekker, Numer.
/// Math. 18, 224, 1971, §4). Numbers of all kRealBits bits stay as they are.
inline Real rounded_to(const Real& x, int bits) {
  if (bits >= kRealBits) return x;
  const Real lifted = x * (power_of_two(kRealBits - bits) + 1);
  return lifted - (lifted - x);
}

inline Vector rounded_to(const Vector& v, int bits) {
  return {rounded_to(v.x(), bits), rounded_to(v.y(), bits), rounded_to(v.z(), bits)};
}

}  // namespace carom::converged
