#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "carom/account.h"
#include "carom/laws/frictionless.h"
#include "carom/plane.h"

namespace carom {

/// A quantum barrier: a ball that meets a face passes with the probability
///   E < V:  T = 1 / (1 + V² sinh²(κ a) / (4 E (V - E))),  κ = √(2 m (V - E)) / ħ,      (1)
///   E > V:  T = 1 / (1 + V² sin²(k a) / (4 E (E - V))),   k = √(2 m (E - V)) / ħ,
///   E = V:  T = 1 / (1 + m a² V / (2 ħ²)),
/// with E = ½ m v_n² J, V the height J, a the thickness m, ħ in J s; it keeps its velocity and appears at the
/// other face. Otherwise it is reflected elastically. Under gravity g the other face is another height: with
/// the way s across, the velocity along the normal becomes
///   v_n'² = v_n² + 2 g·s,                                                               (2)
/// so that the energy is kept; a ball that has not enough for the way up is reflected. Source: e.g. L. D.
/// Landau, E. M. Lifshitz, "Quantum Mechanics", §25. Not to be confused with a slab that a ball jumps because
/// the step is too long.
///
/// @param v_n_mps  the velocity along the normal
inline double transmission(const Barrier& barrier, double mass_kg, double v_n_mps) {
  if (barrier.height == 0.0) return 1.0;
  if (v_n_mps == 0.0) return 0.0;
  const double above = 0.5 * mass_kg * v_n_mps * v_n_mps - barrier.height;
  const double a_over_hbar = barrier.thickness / barrier.hbar;
  // All three are one: 1/T - 1 = (V a s(x)/(ħ v_n))², s = sinh x/x, 1, sin x/x, with x = a √(2 m |E - V|)/ħ.
  const double x =
      std::min(a_over_hbar * std::sqrt(2.0 * mass_kg * std::abs(above)), std::numeric_limits<double>::max());
  const double ratio = x == 0.0 ? 1.0 : (above < 0.0 ? std::sinh(x) : std::sin(x)) / x;
  const double amplitude = barrier.height * a_over_hbar * ratio / v_n_mps;
  return 1.0 / (1.0 + amplitude * amplitude);
}

/// A number in [0, 1) that belongs to the n-th time a ball meets this barrier, whatever else happens in
/// between and in whatever order. Source of the mixing: the finalizer of S. Vigna's SplitMix64.
inline double draw(const Barrier& barrier, std::size_t ball, std::uint32_t meeting) {
  const auto mixed = [](std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  };
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;
  const std::uint64_t state = mixed(mixed(barrier.seed + kGolden) + ball) + meeting * kGolden;
  return static_cast<double>(mixed(state) >> 11U) * 0x1p-53;
}

/// The barriers of a scene, and how often each ball has met one.
template <int Dim>
class Barriers {
 public:
  explicit Barriers(const Scenario& scene)
      : barriers_(scene.barriers),
        meetings_(scene.barriers.empty() ? 0 : scene.balls.size(), 0),
        gravity_(flattened<Dim>(scene.effects.gravity.value_or(Vec3::Zero()))) {}

  /// A ball that approaches this face passes, or is reflected.
  void meet(World<Dim>& world, std::size_t ball, const Plane<Dim>& face, Account<Dim>& account) {
    const Barrier& barrier = barriers_[static_cast<std::size_t>(face.barrier)];
    const double mass = 1.0 / world.inverse_mass[ball];
    const double v_n = face.normal.dot(world.velocity[ball]);
    const Vec<Dim> way = -2.0 * (face.depth + world.radius[ball]) * face.normal;
    const double fall = 2.0 * gravity_.dot(way);
    const std::uint32_t number = world.number_of(ball);
    const bool passes = draw(barrier, number, meetings_[number]++) < transmission(barrier, mass, v_n);
    if (passes && v_n * v_n + fall > 0.0) {
      world.position.set(ball, world.position[ball] + way);
      account.book_moment(way, mass * world.velocity[ball]);
      if (fall != 0.0) push(world, ball, (-std::sqrt(v_n * v_n + fall) - v_n) * face.normal, account);
    } else {
      const Contact mirror;  // elastic and smooth
      const Vec<Dim> impulse = Frictionless::on_wall<Dim>(world, ball, face.normal, mirror);
      account.book(world.position[ball], impulse);
      add_work_of_wall<false, Dim>(world, ball, face.normal, impulse, account.tally.energy);
    }
  }

 private:
  static void push(World<Dim>& world, std::size_t ball, const Vec<Dim>& change, Account<Dim>& account) {
    world.velocity.set(ball, world.velocity[ball] + change);
    account.book(world.position[ball], change / world.inverse_mass[ball]);
  }

  std::vector<Barrier> barriers_;
  std::vector<std::uint32_t> meetings_;  ///< of each ball by its number; empty without barriers
  Vec<Dim> gravity_;                     ///< m/s²
};

template <int Dim>
void add_barriers(const Scenario& scene, std::vector<Plane<Dim>>& planes) {
  for (std::size_t i = 0; i < scene.barriers.size(); ++i) {
    add_faces<Dim>(scene.barriers[i], static_cast<std::int32_t>(i), planes);
  }
}

}  // namespace carom
