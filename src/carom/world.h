#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/vec.h"
#include "engine/engine.h"
#include "scenario/scenario.h"

namespace carom {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// A vector with as many components as the scene has dimensions; a 2D scene spends nothing on z.
template <int Dim>
using Vec = Eigen::Matrix<double, Dim, 1>;

template <int Dim>
Vec<Dim> flattened(const Vec3& v) {
  return v.head<Dim>();
}

template <int Dim>
Vec3 widened(const Vec<Dim>& v) {
  Vec3 wide = Vec3::Zero();
  wide.head<Dim>() = v;
  return wide;
}

/// One vector per ball, stored axis by axis so that loops over all balls run over plain arrays.
template <int Dim>
class VectorColumn {
 public:
  explicit VectorColumn(std::size_t count = 0) {
    for (auto& axis : axes_) axis.assign(count, 0.0);
  }

  Vec<Dim> operator[](std::size_t ball) const {
    Vec<Dim> v;
    for (int axis = 0; axis < Dim; ++axis) v[axis] = axes_[static_cast<std::size_t>(axis)][ball];
    return v;
  }

  void set(std::size_t ball, const Vec<Dim>& v) {
    for (int axis = 0; axis < Dim; ++axis) axes_[static_cast<std::size_t>(axis)][ball] = v[axis];
  }

  std::span<double> axis(int axis) { return axes_[static_cast<std::size_t>(axis)]; }
  std::span<const double> axis(int axis) const { return axes_[static_cast<std::size_t>(axis)]; }

 private:
  std::array<std::vector<double>, Dim> axes_;
};

/// The balls of one simulation as a structure of arrays. SI units, the scene's frame.
template <int Dim>
struct World {
  VectorColumn<Dim> position;        ///< m
  VectorColumn<Dim> velocity;        ///< m/s
  std::vector<double> radius;        ///< m
  std::vector<double> inverse_mass;  ///< 1/kg, 0 for an immovable ball

  explicit World(const std::vector<Ball>& balls) : position(balls.size()), velocity(balls.size()) {
    for (std::size_t i = 0; i < balls.size(); ++i) {
      position.set(i, flattened<Dim>(balls[i].position));
      velocity.set(i, flattened<Dim>(balls[i].velocity));
      radius.push_back(balls[i].radius);
      inverse_mass.push_back(1.0 / balls[i].mass);
    }
  }

  std::size_t size() const { return radius.size(); }

  void snapshot(std::span<BallState> balls) const {
    for (std::size_t i = 0; i < size(); ++i) {
      balls[i] = {widened<Dim>(position[i]), widened<Dim>(velocity[i]), Vec3::Zero()};
    }
  }
};

}  // namespace carom
