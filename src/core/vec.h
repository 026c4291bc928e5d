#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace carom {

/// A vector in the scene's inertial frame, x to the right, y up, z out of the page; SI units.
/// Scenes of dimension 2 keep z = 0 in positions and velocities, and x = y = 0 in spins.
using Vec3 = Eigen::Vector3d;

}  // namespace carom
