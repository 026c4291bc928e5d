#pragma once

#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <string_view>
#include <type_traits>

#include "carom/flight.h"
#include "carom/laws/frictionless.h"
#include "carom/laws/law_formula.h"
#include "carom/laws/three_parameter.h"
#include "carom/world.h"

namespace carom {

/// A law of a file (law_file.h) between two balls; walls have the right law, so that what goes wrong is the
/// law's own.
/// @tparam Friction  whether it pushes along the surface, or walls do; then the world spins
template <bool Friction>
class WrittenLaw {
 public:
  static constexpr std::string_view kName = "written";
  static constexpr bool kFriction = Friction;

  explicit WrittenLaw(std::shared_ptr<LawFormula> formula) : formula_(std::move(formula)) {}

  /// Returns the impulse on b, N s; what a gets is the law's business. @pre not both are immovable.
  /// @throws std::runtime_error where the law gives what is not a number, or leaves the balls approaching as
  /// they did: no evolver could ever be done with that impact
  template <int Dim>
  Vec<Dim> between(World<Dim>& world, std::size_t a, std::size_t b, const Vec<Dim>& normal,
                   const Contact& surface) const {
    const PairMeeting pair{ball_of(world, a), ball_of(world, b), widened<Dim>(normal), surface};
    const PairImpulses impulses = formula_->impulses(pair);
    const double v_n = normal.dot(world.velocity[b] - world.velocity[a]);
    const double speeds = world.velocity[a].norm() + world.velocity[b].norm();
    push(world, a, Vec<Dim>(world.radius[a] * normal), flattened<Dim>(impulses.on_one));
    push(world, b, Vec<Dim>(-world.radius[b] * normal), flattened<Dim>(impulses.on_two));
    const double v_after = normal.dot(world.velocity[b] - world.velocity[a]);
    if (!(v_after > v_n) && !(-v_n <= velocity_rounding(speeds))) refuse(pair, impulses, v_n, v_after);
    return flattened<Dim>(impulses.on_two);
  }

  template <int Dim>
  static Vec<Dim> on_wall(World<Dim>& world, std::size_t ball, const Vec<Dim>& normal,
                          const Contact& surface) {
    return std::conditional_t<Friction, ThreeParameter, Frictionless>::template on_wall<Dim>(world, ball,
                                                                                             normal, surface);
  }

 private:
  template <int Dim>
  static PairBall ball_of(const World<Dim>& world, std::size_t ball) {
    PairBall of;
    of.mass = 1.0 / world.inverse_mass[ball];
    of.radius = world.radius[ball];
    of.velocity = widened<Dim>(world.velocity[ball]);
    if (world.spins()) {
      of.inertia = 1.0 / world.inverse_inertia[ball];
      of.spin = widened_spin<Dim>(world.spin[ball]);
    }
    return of;
  }

  template <int Dim>
  static void push(World<Dim>& world, std::size_t ball, const Vec<Dim>& arm, const Vec<Dim>& impulse) {
    world.velocity.set(ball, world.velocity[ball] + world.inverse_mass[ball] * impulse);
    if constexpr (Friction) {
      world.spin.set(ball, world.spin[ball] + world.inverse_inertia[ball] * moment<Dim>(arm, impulse));
    }
  }

  [[noreturn]] void refuse(const PairMeeting& pair, const PairImpulses& impulses, double v_n,
                           double v_after) const {
    throw std::runtime_error(
        fmt::format("the law \"{}\" does not end an impact: m1 = {:.4g} kg, m2 = {:.4g} kg, e = {:.4g}, vn = "
                    "{:.4g} m/s get "
                    "{:.4g} N s and {:.4g} N s along n, and go on at vn = {:.4g} m/s",
                    formula_->file().name, pair.one.mass, pair.two.mass, pair.surface.restitution, v_n,
                    pair.normal.dot(impulses.on_one), pair.normal.dot(impulses.on_two), v_after));
  }

  std::shared_ptr<LawFormula> formula_;
};

}  // namespace carom
