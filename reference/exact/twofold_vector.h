#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/vec.h"
#include "reference/exact/twofold.h"

/// Lets Eigen's vectors hold pairs of doubles.
template <>
struct Eigen::NumTraits<carom::exact::Twofold> : Eigen::GenericNumTraits<carom::exact::Twofold> {};

namespace carom::exact {

using Vec3Twofold = Eigen::Matrix<Twofold, 3, 1>;

inline Vec3Twofold widened(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
inline Vec3 rounded(const Vec3Twofold& v) {
  return {v.x().hi, v.y().hi, v.z().hi};
}

inline Twofold length(const Vec3Twofold& v) {
  return sqrt(v.dot(v));
}

}  // namespace carom::exact
