#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "carom/permute.h"
#include "carom/shared_column.h"
#include "carom/threads.h"
#include "core/large_pages.h"
#include "core/prefetch.h"
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

/// A spin of a 2D scene is its z-component.
template <int Dim>
Vec<Dim == 2 ? 1 : 3> flattened_spin(const Vec3& spin) {
  return spin.tail < Dim == 2 ? 1 : 3 > ();
}

template <int Dim>
Vec3 widened_spin(const Vec<Dim == 2 ? 1 : 3>& spin) {
  Vec3 wide = Vec3::Zero();
  wide.tail<Dim == 2 ? 1 : 3>() = spin;
  return wide;
}

/// What rotation adds to the velocity of a point at `arm` from the axis: spin × arm.
template <int Dim>
Vec<Dim> turned(const Vec<Dim == 2 ? 1 : 3>& spin, const Vec<Dim>& arm) {
  if constexpr (Dim == 2) {
    return spin[0] * Vec<2>(-arm[1], arm[0]);
  } else {
    return spin.cross(arm);
  }
}

/// The moment arm × force, along z alone in 2D.
template <int Dim>
Vec<Dim == 2 ? 1 : 3> moment(const Vec<Dim>& arm, const Vec<Dim>& force) {
  if constexpr (Dim == 2) {
    return Vec<1>(arm[0] * force[1] - arm[1] * force[0]);
  } else {
    return arm.cross(force);
  }
}

/// One vector per ball, its components side by side: what is asked of a ball is in one place.
template <int Dim>
class VectorColumn {
 public:
  explicit VectorColumn(std::size_t count = 0) : vectors_(count, Vec<Dim>::Zero()) {}

  std::size_t size() const { return vectors_.size(); }
  const Vec<Dim>& operator[](std::size_t ball) const { return vectors_[ball]; }
  void set(std::size_t ball, const Vec<Dim>& v) { vectors_[ball] = v; }

  /// Place k takes what stood at order[k].
  void permute(std::span<const std::uint32_t> order, const Threads& threads) {
    carom::permute(vectors_, order, threads);
  }

  /// The smallest and the largest component along an axis; what is not a number counts for nothing, and of
  /// nothing the largest is the smaller.
  std::pair<double, double> range(int axis) const {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Vec<Dim>& v : vectors_) {
      low = std::min(low, v[axis]);
      high = std::max(high, v[axis]);
    }
    return {low, high};
  }

  /// The components of the balls from one up to, but without, another, ball by ball: for loops over all.
  std::span<double> components(std::size_t begin, std::size_t end) {
    return {reinterpret_cast<double*>(vectors_.data() + begin), Dim * (end - begin)};
  }
  std::span<const double> components(std::size_t begin, std::size_t end) const {
    return {reinterpret_cast<const double*>(vectors_.data() + begin), Dim * (end - begin)};
  }

 private:
  static_assert(sizeof(Vec<Dim>) == Dim * sizeof(double));

  Column<Vec<Dim>> vectors_;
};

/// The length of the longest vector; what is not a number counts for nothing.
template <int Dim>
double largest_norm(const VectorColumn<Dim>& vectors, const Threads& threads = Threads()) {
  return std::sqrt(
      threads.largest(vectors.size(), [&vectors](std::size_t i) { return vectors[i].squaredNorm(); }));
}

/// Components of a spin: along z alone in 2D.
template <int Dim>
inline constexpr int kSpinAxes = Dim == 2 ? 1 : 3;

template <int Dim>
using Spin = Vec<kSpinAxes<Dim>>;

/// The balls of one simulation as a structure of arrays. SI units, the scene's frame. The columns of the spin
/// are empty in a scene without it: what is not asked for takes no byte.
template <int Dim>
struct World {
  VectorColumn<Dim> position;         ///< m; of a ball in flight, where the evolver began to count its way
  VectorColumn<Dim> velocity;         ///< m/s
  SharedColumn radius;                ///< m
  SharedColumn inverse_mass;          ///< 1/kg, 0 for an immovable ball
  VectorColumn<kSpinAxes<Dim>> spin;  ///< rad/s; empty without effects.spin
  Column<double> inverse_inertia;     ///< 1/(kg m²), 0 for an immovable ball; empty without effects.spin
  /// The scene's number of the ball at each place, see reorder(); empty while it is the place.
  Column<std::uint32_t> number;

  explicit World(const std::vector<Ball>& balls, bool spins = false)
      : position(balls.size()),
        velocity(balls.size()),
        radius(balls.size(), [&balls](std::size_t i) { return balls[i].radius; }),
        inverse_mass(balls.size(), [&balls](std::size_t i) { return 1.0 / balls[i].mass; }),
        spin(spins ? balls.size() : 0) {
    for (std::size_t i = 0; i < balls.size(); ++i) {
      position.set(i, flattened<Dim>(balls[i].position));
      velocity.set(i, flattened<Dim>(balls[i].velocity));
    }
    if (!spins) return;
    inverse_inertia.reserve(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
      spin.set(i, flattened_spin<Dim>(balls[i].spin));
      inverse_inertia.push_back(inverse_mass[i] / (balls[i].inertia * radius[i] * radius[i]));
    }
  }

  std::size_t size() const { return radius.size(); }
  bool spins() const { return !inverse_inertia.empty(); }

  /// What decides an order is the number that a ball has in the scene, wherever it stands in memory.
  std::uint32_t number_of(std::size_t place) const {
    return number.empty() ? static_cast<std::uint32_t>(place) : number[place];
  }
  bool before(std::size_t a, std::size_t b) const { return number_of(a) < number_of(b); }

  /// Puts the ball at place order[k] to place k: balls that lie side by side in memory are loaded together.
  void reorder(std::span<const std::uint32_t> order, const Threads& threads) {
    reorder_columns(order, threads);
    Column<std::uint32_t> numbers(order.size());
    threads.in_parallel(order.size(), [&](std::size_t first, std::size_t end) {
      for (std::size_t k = first; k < end; ++k) numbers[k] = number_of(order[k]);
    });
    number.swap(numbers);
  }

  /// Has the processor load what the flight of a ball is known by.
  void fetch(std::size_t ball) const {
    prefetch(&position[ball]);
    prefetch(&velocity[ball]);
  }

  void fetch_number(std::size_t ball) const {
    if (!number.empty()) prefetch(&number[ball]);
  }
  void fetch_pair(const std::pair<std::uint32_t, std::uint32_t>& balls) const {
    fetch(balls.first);
    fetch(balls.second);
  }

  /// Where a ball is after it has flown straight on for so long.
  Vec<Dim> place_after(double flown_s, std::size_t ball) const {
    Vec<Dim> place;
    for (int axis = 0; axis < Dim; ++axis) {
      place[axis] = position[ball][axis] + flown_s * velocity[ball][axis];
    }
    return place;
  }

  /// Moves all balls straight on for so long.
  void fly(double duration_s, const Threads& threads) {
    if (duration_s == 0.0) return;
    threads.in_parallel(size(), [&](std::size_t begin, std::size_t end) {
      const std::span<double> x = position.components(begin, end);
      const std::span<const double> v = std::as_const(velocity).components(begin, end);
      for (std::size_t k = 0; k < x.size(); ++k) x[k] += duration_s * v[k];
    });
  }

  /// What the balls are like after they have flown straight on for so long.
  void snapshot(std::span<BallState> balls, double flown_s = 0.0) const {
    for (std::size_t i = 0; i < size(); ++i) {
      const Vec<Dim> place = flown_s == 0.0 ? position[i] : place_after(flown_s, i);
      balls[number_of(i)] = {widened<Dim>(place), widened<Dim>(velocity[i]), Vec3::Zero()};
    }
    if (!spins()) return;
    for (std::size_t i = 0; i < size(); ++i) balls[number_of(i)].spin = widened_spin<Dim>(spin[i]);
  }

 private:
  void reorder_columns(std::span<const std::uint32_t> order, const Threads& threads) {
    position.permute(order, threads);
    velocity.permute(order, threads);
    radius.permute(order, threads);
    inverse_mass.permute(order, threads);
    if (!spins()) return;
    spin.permute(order, threads);
    carom::permute(inverse_inertia, order, threads);
  }
};

}  // namespace carom
