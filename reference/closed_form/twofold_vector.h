#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/vec.h"
#include "reference/closed_form/twofold.h"

/// Lets Eigen's vectors hold pairs of doubles.
template <>
struct Eigen::NumTraits<carom::closed_form::Twofold> : Eigen::GenericNumTraits<carom::closed_form::Twofold> {
};

namespace carom::closed_form {

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

}  // namespace carom::closed_form
