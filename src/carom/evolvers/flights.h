#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "carom/account.h"
#include "carom/broad_phase/reach.h"
#include "carom/flight.h"
#include "carom/world.h"

namespace carom {

/// The balls within a step, each flying on its own parabola from its own moment on, and the account of what
/// walls and immovable balls push.
///
/// Few balls are hit in a step. These are touched one by one, and a record is kept of each; all fly
/// from the step's start to its end together, in loops over plain arrays, and those with a record are put
/// back. Nobody asks where they are until the next step, so that they land as it goes from ball to ball.
///
/// @tparam kAccelerates  false: no acceleration is stored, added, or even zero
/// @tparam kFriction     whether pushes can turn the balls
template <int Dim, bool kAccelerates, bool kFriction>
class Flights {
 public:
  static constexpr bool kFieldsAct = kAccelerates;
  /// Whether a push that lasts turns balls: then spins change in flight.
  static constexpr bool kTurning = kAccelerates && kFriction;

  Flights(const Scenario& scene, std::unique_ptr<Flight<Dim>> model, const Threads& threads)
      : threads_(threads),
        world_(scene.balls, scene.effects.spin),
        model_(std::move(model)),
        clock_(world_.size(), 0.0),
        stamp_(world_.size(), 0),
        touched_(world_.size(), kUntouched),
        acceleration_(kAccelerates ? world_.size() : 0),
        force_(kAccelerates ? world_.size() : 0),
        spin_acceleration_(kTurning ? world_.size() : 0),
        torque_(kTurning ? world_.size() : 0) {}

  World<Dim>& world() { return world_; }
  const World<Dim>& world() const { return world_; }
  std::size_t size() const { return world_.size(); }
  double step_s() const { return step_s_; }
  double left_s(std::size_t ball) const { return step_s_ - clock_[ball]; }
  double clock(std::size_t ball) const { return clock_[ball]; }
  /// Counts the flights that a ball has begun in this step.
  std::uint32_t stamp(std::size_t ball) const { return stamp_[ball]; }
  /// What the strongest acceleration gives in a step, m/s.
  double field_speed() const { return field_speed_; }
  Account<Dim>& account() { return account_; }
  const Account<Dim>& account() const { return account_; }

  /// The columns that statics changes: accelerations m/s² and rad/s².
  VectorColumn<Dim>& accelerations() { return acceleration_; }
  VectorColumn<kSpinAxes<Dim>>& spin_accelerations() { return spin_acceleration_; }
  Vec<Dim> acceleration(std::size_t ball) const {
    if constexpr (kAccelerates) return acceleration_[ball];
    return Vec<Dim>::Zero();
  }

  /// Begins a step: every ball flies freely.
  void begin_step(double step_s) {
    step_s_ = step_s;
    if constexpr (kAccelerates) {
      threads_.in_parallel(size(), [&](std::size_t begin, std::size_t end) {
        model_->accelerations(world_, begin, end, step_s, acceleration_);
      });
      field_speed_ = step_s * largest_norm(acceleration_, threads_);
      fastest_ = largest_norm(world_.velocity, threads_);
    }
  }

  /// Ends the step: whoever was touched arrives. All are in the air then until they land(), which has time
  /// until somebody asks where they are; where fields act the next step does so at once.
  void finish_step() {
    // In the order of their numbers: what bears them is added up.
    std::sort(records_.begin(), records_.end(),
              [this](const Record& a, const Record& b) { return world_.before(a.ball, b.ball); });
    arrivals_.clear();
    for (const Record& record : records_) {
      fly_to(record.ball, step_s_);
      arrivals_.push_back({record.ball, world_.position[record.ball], world_.velocity[record.ball]});
      forget(record.ball);
    }
    records_.clear();
    std::sort(arrivals_.begin(), arrivals_.end(), before_in_memory);
    in_the_air_s_ = step_s_;
    if constexpr (kAccelerates) land();
  }

  /// Brings all balls to the end of the last step, if they are not there.
  void land() {
    threads_.in_parallel(size(), [this](std::size_t begin, std::size_t end) { land(begin, end); });
    all_have_landed();
  }

  /// The same for balls from one up to, but without, another: each once, and then all_have_landed().
  void land(std::size_t begin, std::size_t end) {
    if (in_the_air_s_ == 0.0) return;
    fly_whole_step(begin, end);
    const Arrival first{static_cast<std::uint32_t>(begin), {}, {}};
    for (auto arrival = std::lower_bound(arrivals_.begin(), arrivals_.end(), first, before_in_memory);
         arrival != arrivals_.end() && arrival->ball < end; ++arrival) {
      world_.position.set(arrival->ball, arrival->x);
      if constexpr (kAccelerates) world_.velocity.set(arrival->ball, arrival->v);
    }
  }

  void all_have_landed() { in_the_air_s_ = 0.0; }

  /// How far a ball gets in this step at most, m, where fields act.
  double longest_path() const requires kAccelerates { return (fastest_ + 0.5 * field_speed_) * step_s_; }

  /// Where the ball can get in this step.
  Reach<Dim> reach(std::size_t ball) const {
    if (touched_[ball] != kUntouched) return records_[touched_[ball]].reach;
    return {world_.position[ball], world_.radius[ball] + path_bound(ball, step_s_)};
  }

  /// After a new flight has begun; returns whether the ball can get farther than before.
  bool widen_reach(std::size_t ball) {
    Reach<Dim>& reach = record_of(ball).reach;
    const double bound = world_.radius[ball] + way_in_step(ball);
    if (bound <= reach.bound) return false;
    reach.bound = bound;
    return true;
  }

  /// How far from where it began the step a ball may get in it, m. @pre it was touched
  double way_in_step(std::size_t ball) const {
    const double moved = (world_.position[ball] - records_[touched_[ball]].reach.centre).norm();
    return moved + path_bound(ball, left_s(ball));
  }

  /// A ball's flight from its clock on.
  Motion<Dim> motion(std::size_t ball) const {
    return {world_.position[ball], world_.velocity[ball], acceleration(ball)};
  }

  /// Where the ball is at a time of the step, its clock or later.
  Motion<Dim> motion_at(std::size_t ball, double time_s) const {
    return motion(ball).after(time_s - clock_[ball]);
  }

  /// How far the ball can get in `duration_s`, m.
  double path_bound(std::size_t ball, double duration_s) const {
    double speed = world_.velocity[ball].norm();
    if constexpr (kAccelerates) speed += 0.5 * duration_s * acceleration_[ball].norm();
    return speed * duration_s;
  }

  /// Moves the ball along its flight to a time of the step, and books what bears it on the way.
  void fly_to(std::size_t ball, double time_s) {
    record_of(ball);
    const double tau = time_s - clock_[ball];
    if constexpr (kAccelerates) {
      if (!force_[ball].isZero(0.0)) book_force(ball, tau);
      const Motion<Dim> then = motion(ball).after(tau);
      world_.position.set(ball, then.x);
      world_.velocity.set(ball, then.v);
    } else {
      world_.position.set(ball, world_.position[ball] + tau * world_.velocity[ball]);
    }
    if constexpr (kTurning) world_.spin.set(ball, world_.spin[ball] + tau * spin_acceleration_[ball]);
    clock_[ball] = time_s;
  }

  /// After an impact: a new, free flight from here to the end of the step.
  void begin_flight(std::size_t ball) {
    if constexpr (kAccelerates) {
      acceleration_.set(ball, model_->acceleration(world_, ball, left_s(ball)));
      force_.set(ball, Vec<Dim>::Zero());
    }
    if constexpr (kTurning) still(ball);
    note_flight(ball);
  }

  /// A new, straight flight with the velocity as it stands.
  void coast(std::size_t ball) {
    if constexpr (kAccelerates) {
      acceleration_.set(ball, Vec<Dim>::Zero());
      force_.set(ball, Vec<Dim>::Zero());
    }
    if constexpr (kTurning) still(ball);
    note_flight(ball);
  }

  /// What a force N accelerates a ball by, 1/kg: less than 1/m where its own motion is damped.
  double response(std::size_t ball) const {
    if constexpr (!kAccelerates) return world_.inverse_mass[ball];
    return world_.inverse_mass[ball] * model_->yield(world_, ball, left_s(ball));
  }

  /// From now on the ball bears a further force, N, that acts at `arm` from its centre.
  void bear(std::size_t ball, const Vec<Dim>& force, const Vec<Dim>& arm) {
    force_.set(ball, force_[ball] + force);
    if constexpr (kTurning) torque_.set(ball, torque_[ball] + moment<Dim>(arm, force));
  }

 private:
  /// Of a ball that was touched in this step.
  struct Record {
    std::uint32_t ball;
    Reach<Dim> reach;
  };

  /// Where a ball that was touched is at the end of the step.
  struct Arrival {
    std::uint32_t ball;
    Vec<Dim> x;
    Vec<Dim> v;
  };

  static constexpr std::uint32_t kUntouched = std::numeric_limits<std::uint32_t>::max();

  /// Makes a record of the ball as it is, unless there is one.
  Record& record_of(std::size_t ball) {
    if (touched_[ball] == kUntouched) {
      const Reach<Dim> from_here = reach(ball);
      touched_[ball] = static_cast<std::uint32_t>(records_.size());
      records_.push_back({static_cast<std::uint32_t>(ball), from_here});
    }
    return records_[touched_[ball]];
  }

  void note_flight(std::size_t ball) {
    record_of(ball);
    ++stamp_[ball];
    if constexpr (kAccelerates) fastest_ = std::max(fastest_, world_.velocity[ball].norm());
  }

  void forget(std::size_t ball) {
    touched_[ball] = kUntouched;
    clock_[ball] = 0.0;
    stamp_[ball] = 0;
    if constexpr (kAccelerates) force_.set(ball, Vec<Dim>::Zero());
    if constexpr (kTurning) still(ball);
  }

  /// What fly_to() does, for balls from one up to, but without, another, and from the step's start to its
  /// end. Whoever was touched flies as well: to ask each would take longer than to put few back.
  void fly_whole_step(std::size_t begin, std::size_t end) {
    const std::span<double> x = world_.position.components(begin, end);
    const std::span<double> v = world_.velocity.components(begin, end);
    if constexpr (kAccelerates) {
      const std::span<const double> a = std::as_const(acceleration_).components(begin, end);
      for (std::size_t k = 0; k < x.size(); ++k) {
        x[k] += in_the_air_s_ * (v[k] + (0.5 * in_the_air_s_) * a[k]);
        v[k] += in_the_air_s_ * a[k];
      }
    } else {
      for (std::size_t k = 0; k < x.size(); ++k) x[k] += in_the_air_s_ * v[k];
    }
  }

  static bool before_in_memory(const Arrival& a, const Arrival& b) { return a.ball < b.ball; }

  void still(std::size_t ball) {
    spin_acceleration_.set(ball, Spin<Dim>::Zero());
    torque_.set(ball, Spin<Dim>::Zero());
  }

  /// ∫ x dt over the parabola gives the moment of a constant force. Its work is force times way and moment
  /// times turn; what bears the ball does none of it along its normal.
  void book_force(std::size_t ball, double tau) {
    const Motion<Dim> m = motion(ball);
    const Vec3 force = widened<Dim>(force_[ball]);
    const Vec<Dim> path_integral = tau * (m.x + (0.5 * tau) * m.v + (tau * tau / 6.0) * m.a);
    account_.tally.external_impulse += tau * force;
    account_.tally.external_angular_impulse += widened<Dim>(path_integral).cross(force);
    EnergyAccount& energy = account_.tally.energy;
    const double work_J = force_[ball].dot(tau * (m.v + (0.5 * tau) * m.a));
    if constexpr (kTurning) {
      account_.tally.external_angular_impulse += tau * widened_spin<Dim>(torque_[ball]);
      const Spin<Dim> turn = tau * (world_.spin[ball] + (0.5 * tau) * spin_acceleration_[ball]);
      energy.friction_J += work_J + torque_[ball].dot(turn);
    } else {
      energy.wall_impacts_J += work_J;
    }
  }

  const Threads& threads_;
  World<Dim> world_;
  std::unique_ptr<Flight<Dim>> model_;
  Account<Dim> account_;
  double step_s_ = 0.0;
  double field_speed_ = 0.0;
  double fastest_ = 0.0;  ///< m/s, no ball is faster; where fields act
  Column<double> clock_;  ///< s, from the start of the step: where position and velocity stand
  Column<std::uint32_t> stamp_;
  Column<std::uint32_t> touched_;  ///< of each ball, which of the records is its
  std::vector<Record> records_;
  std::vector<Arrival> arrivals_;
  double in_the_air_s_ = 0.0;  ///< how long the balls have flown without being moved
  VectorColumn<Dim> acceleration_;
  VectorColumn<Dim> force_;  ///< N, by the walls and immovable balls that bear the ball
  VectorColumn<kSpinAxes<Dim>> spin_acceleration_;
  VectorColumn<kSpinAxes<Dim>> torque_;  ///< N m, of force_ about the centre
};

}  // namespace carom
