#pragma once

#include <memory>
#include <tuple>

#include "carom/effects/kind.h"
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

/// Gives every ball, for one stretch of flight, the constant acceleration that stands for the effects that
/// the scene engages. As an evolver sees it: one call for many balls a step, and one for each ball that was
/// hit.
template <int Dim>
class Flight {
 public:
  Flight() = default;
  Flight(const Flight&) = delete;
  Flight& operator=(const Flight&) = delete;
  virtual ~Flight() = default;

  /// The accelerations of balls for the next `tau_s` seconds, from one ball up to, but without, another.
  virtual void accelerations(const World<Dim>& world, std::size_t begin, std::size_t end, double tau_s,
                             VectorColumn<Dim>& a) const = 0;

  /// The acceleration of a ball for the next `tau_s` seconds.
  virtual Vec<Dim> acceleration(const World<Dim>& world, std::size_t ball, double tau_s) const = 0;

  /// By how much less than 1/m a force accelerates the ball over `tau_s`, because its own motion is damped.
  virtual double yield(const World<Dim>& world, std::size_t ball, double tau_s) const = 0;
};

/// The flight with exactly the effects that the scene engages; null where it engages none, and balls fly
/// straight on.
template <int Dim>
std::unique_ptr<Flight<Dim>> make_flight(const Scenario& scene);

/// A flight composed of effects.
///
/// For accelerations that do not depend on the velocity (gravity) the parabola is exact. For damping at rate
/// λ and turning at rate Ω the equation dv/dt = a₀ - λ(v) v + Ω × v is taken by the implicit midpoint rule
/// over the stretch τ,
///   a = a₀ - λ(v_m) v_m + Ω × v_m,  v_m = v + ½ τ a,                                  (1)
/// solved for a with λ held at a predicted midpoint: with α = 1 + ½ λ τ and β = ½ τ Ω,
///   (α - β×) a = b,  b = a₀ - λ v + Ω × v,
///   a = (α b + β × b + β (β·b)/α) / (α² + β²).                                        (2)
/// It is of second order in τ and stable for every λτ: for a₀ = Ω = 0 the speed after τ is
/// v (1-½λτ)/(1+½λτ), and for a₀ = λ = 0 it stays as it is.
/// Source: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration" (2006), §II.1.3, and for the
/// stability E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", §IV.3.
template <int Dim, class... Effects>
class FlightModel final : public Flight<Dim> {
 public:
  static constexpr bool kDamps = (false || ... || (Effects::kKind == EffectKind::damping));
  static constexpr bool kTurns = (false || ... || (Effects::kKind == EffectKind::turning));

  explicit FlightModel(Effects... effects) : effects_(effects...) {}

  void accelerations(const World<Dim>& world, std::size_t begin, std::size_t end, double tau_s,
                     VectorColumn<Dim>& a) const override {
    for (std::size_t ball = begin; ball < end; ++ball) a.set(ball, acceleration(world, ball, tau_s));
  }

  Vec<Dim> acceleration(const World<Dim>& world, std::size_t ball, double tau_s) const override {
    Vec<Dim> a = field(world, ball);
    if constexpr (kDamps || kTurns) {
      const Vec<Dim> velocity = world.velocity[ball];
      const Spin<Dim> omega = turning_rate(world, ball);
      const double rate = midpoint_rate(world, ball, velocity, a, tau_s);
      if constexpr (kTurns) a += turned<Dim>(omega, velocity);
      a = responding(a - rate * velocity, 1.0 + 0.5 * rate * tau_s, (0.5 * tau_s) * omega);
    }
    return a;
  }

  /// A force N beside the effects adds N/m to b in (2), and this is 1/α. What Ω turns of it is left out.
  double yield(const World<Dim>& world, std::size_t ball, double tau_s) const override {
    if constexpr (!kDamps) return 1.0;
    const double rate = midpoint_rate(world, ball, world.velocity[ball], field(world, ball), tau_s);
    return 1.0 / (1.0 + 0.5 * tau_s * rate);
  }

 private:
  /// a of (2).
  static Vec<Dim> responding(const Vec<Dim>& b, double alpha, const Spin<Dim>& beta) {
    if constexpr (!kTurns) {
      return b / alpha;
    } else {
      Vec<Dim> sum = alpha * b + turned<Dim>(beta, b);
      if constexpr (Dim == 3) sum += (beta.dot(b) / alpha) * beta;
      return sum / (alpha * alpha + beta.squaredNorm());
    }
  }

  /// λ at the midpoint that λ at the start predicts; with it (2) is of second order.
  double midpoint_rate(const World<Dim>& world, std::size_t ball, const Vec<Dim>& velocity,
                       const Vec<Dim>& field, double tau_s) const {
    if constexpr (!kDamps) return 0.0;
    const double first = damping_rate(world, ball, velocity);
    const Vec<Dim> change = (field - first * velocity) / (1.0 + 0.5 * first * tau_s);
    return damping_rate(world, ball, velocity + (0.5 * tau_s) * change);
  }

  Vec<Dim> field(const World<Dim>& world, std::size_t ball) const {
    Vec<Dim> a = Vec<Dim>::Zero();
    const auto add = [&]<class Effect>(const Effect& effect) {
      if constexpr (Effect::kKind == EffectKind::field) a += effect.acceleration(world, ball);
    };
    std::apply([&](const Effects&... effect) { (add(effect), ...); }, effects_);
    return a;
  }

  double damping_rate(const World<Dim>& world, std::size_t ball, const Vec<Dim>& velocity) const {
    double rate = 0.0;
    const auto add = [&]<class Effect>(const Effect& effect) {
      if constexpr (Effect::kKind == EffectKind::damping) rate += effect.damping_rate(world, ball, velocity);
    };
    std::apply([&](const Effects&... effect) { (add(effect), ...); }, effects_);
    return rate;
  }

  Spin<Dim> turning_rate(const World<Dim>& world, std::size_t ball) const {
    Spin<Dim> rate = Spin<Dim>::Zero();
    const auto add = [&]<class Effect>(const Effect& effect) {
      if constexpr (Effect::kKind == EffectKind::turning) rate += effect.turning_rate(world, ball);
    };
    std::apply([&](const Effects&... effect) { (add(effect), ...); }, effects_);
    return rate;
  }

  std::tuple<Effects...> effects_;
};

}  // namespace carom
