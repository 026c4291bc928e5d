#pragma once

#include "core/random.h"
#include "core/vec.h"

namespace carom {

/// Three independent numbers of mean 0 and variance 1: no direction is preferred.
inline Vec3 random_vector(Random& random) {
  return {random.normal(), random.normal(), random.normal()};
}

}  // namespace carom
