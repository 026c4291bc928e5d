#pragma once

#include <tuple>

#include "carom/world.h"

namespace carom {

/// Where a ball is on its parabola at some moment: position m, velocity m/s, acceleration m/s².
template <int Dim>
struct Motion {
  Vec<Dim> x;
  Vec<Dim> v;
  Vec<Dim> a;

  /// The same flight `t` seconds on: x + v t + ½ a t², v + a t.
  Motion after(double t) const { return {x + t * (v + (0.5 * t) * a), v + t * a, a}; }
};

/// Gives every ball, for one stretch of flight, the constant acceleration that stands for the engaged
/// effects.
///
/// For accelerations that do not depend on the velocity (gravity) the parabola is exact. For damping at rate
/// λ the equation dv/dt = a₀ - λ(v) v is taken by the implicit midpoint rule over the stretch τ,
///   a = a₀ - λ(v_m) v_m,  v_m = v + ½ τ a,                                            (1)
/// solved for a with λ held at a predicted midpoint:
///   a = (a₀ - λ v) / (1 + ½ λ τ).                                                     (2)
/// It is of second order in τ and stable for every λτ: for a₀ = 0 the speed after τ is v (1-½λτ)/(1+½λτ).
/// Source: E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", §IV.3 (A-stability).
template <int Dim, class... Effects>
class FlightModel {
 public:
  /// No effect: no acceleration is stored, added, or even zero.
  static constexpr bool kAccelerates = sizeof...(Effects) > 0;
  static constexpr bool kDamps = (false || ... || Effects::kDamps);

  explicit FlightModel(Effects... effects) : effects_(effects...) {}

  /// The acceleration of a ball for the next `tau_s` seconds.
  Vec<Dim> acceleration(const World<Dim>& world, std::size_t ball, const Vec<Dim>& velocity,
                        double tau_s) const {
    Vec<Dim> a = Vec<Dim>::Zero();
    std::apply([&](const Effects&... effect) { (add_acceleration(effect, world, ball, a), ...); }, effects_);
    if constexpr (kDamps) {
      const double rate = midpoint_rate(world, ball, velocity, a, tau_s);
      a = (a - rate * velocity) / (1.0 + 0.5 * rate * tau_s);
    }
    return a;
  }

  /// By how much less than 1/m a force accelerates the ball over `tau_s`, because its own motion is damped: a
  /// force N beside the effects turns (2) into a = (a₀ + N/m - λ v)/(1 + ½ λ τ), and this is 1/(1 + ½ λ τ).
  double yield(const World<Dim>& world, std::size_t ball, const Vec<Dim>& velocity, double tau_s) const {
    if constexpr (!kDamps) return 1.0;
    Vec<Dim> a = Vec<Dim>::Zero();
    std::apply([&](const Effects&... effect) { (add_acceleration(effect, world, ball, a), ...); }, effects_);
    return 1.0 / (1.0 + 0.5 * tau_s * midpoint_rate(world, ball, velocity, a, tau_s));
  }

 private:
  /// λ at the midpoint that λ at the start predicts; with it (2) is of second order.
  double midpoint_rate(const World<Dim>& world, std::size_t ball, const Vec<Dim>& velocity, const Vec<Dim>& a,
                       double tau_s) const {
    const auto rate_at = [&](const Vec<Dim>& at) {
      double rate = 0.0;
      std::apply([&](const Effects&... effect) { (add_rate(effect, world, ball, at, rate), ...); }, effects_);
      return rate;
    };
    const double first = rate_at(velocity);
    const Vec<Dim> change = (a - first * velocity) / (1.0 + 0.5 * first * tau_s);
    return rate_at(velocity + (0.5 * tau_s) * change);
  }

  template <class Effect>
  static void add_acceleration(const Effect& effect, const World<Dim>& world, std::size_t ball, Vec<Dim>& a) {
    if constexpr (!Effect::kDamps) a += effect.acceleration(world, ball);
  }

  template <class Effect>
  static void add_rate(const Effect& effect, const World<Dim>& world, std::size_t ball, const Vec<Dim>& at,
                       double& rate) {
    if constexpr (Effect::kDamps) rate += effect.damping_rate(world, ball, at);
  }

  std::tuple<Effects...> effects_;
};

}  // namespace carom
