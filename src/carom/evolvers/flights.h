#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "carom/account.h"
#include "carom/broad_phase/reach.h"
#include "carom/flight.h"
#include "carom/world.h"
#include "core/prefetch.h"

namespace carom {

/// The balls within a step, each flying on its own parabola from its own moment on, and the account of what
/// walls and immovable balls push.
///
/// Few balls are hit in a step. These are touched one by one, and a record is kept of each. Where fields act,
/// all fly from the step's start to its end together, in a loop over a plain array, and those with a record
/// are put back. Where none do nobody is moved: balls stand in memory where they were when they last landed,
/// or would have been had they always flown as they fly now.
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
        touched_(world_.size(), kUntouched),
        acceleration_(kAccelerates ? world_.size() : 0),
        force_(kAccelerates ? world_.size() : 0),
        spin_acceleration_(kTurning ? world_.size() : 0),
        torque_(kTurning ? world_.size() : 0) {}

  World<Dim>& world() { return world_; }
  const World<Dim>& world() const { return world_; }
  std::size_t size() const { return world_.size(); }
  double step_s() const { return step_s_; }
  double left_s(std::size_t ball) const { return step_s_ - clock(ball); }
  /// s from the start of the step: when the flight of a ball began that it flies now, or the step.
  double clock(std::size_t ball) const { return is_touched(ball) ? record(ball).clock : 0.0; }
  /// Counts the flights that a ball has begun in this step.
  std::uint32_t stamp(std::size_t ball) const { return is_touched(ball) ? record(ball).stamp : 0; }
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

  /// Ends the step. @param land  moves all balls in memory to where they are
  void finish_step(bool land) {
    // In the order of their numbers: what bears them is added up.
    std::sort(records_.begin(), records_.end(),
              [this](const Record& a, const Record& b) { return world_.before(a.ball, b.ball); });
    arrivals_.clear();
    touched_in_step_.clear();
    for (std::size_t k = 0; k < records_.size(); ++k) {
      const std::size_t ball = records_[k].ball;
      touched_[ball] = static_cast<std::uint32_t>(k);
      fly_to(ball, step_s_);
      arrivals_.push_back({world_.position[ball], world_.velocity[ball]});
    }
    if constexpr (kAccelerates) {
      fly_whole_step();
    } else {
      flown_s_ += step_s_;
      if (land) this->land();
    }
    for (std::size_t k = 0; k < records_.size(); ++k) {
      const auto& [x, v] = arrivals_[k];
      world_.velocity.set(records_[k].ball, v);
      world_.position.set(records_[k].ball, flown_s_ == 0.0 ? x : Vec<Dim>(x - flown_s_ * v));
      touched_in_step_.push_back(records_[k].ball);
      forget(records_[k].ball);
    }
    records_.clear();
  }

  /// Between steps: moves the balls in memory to where they are.
  void land() {
    world_.fly(flown_s_, threads_);
    flown_s_ = 0.0;
  }

  /// Between steps: how long balls have flown since they landed, and whose flights were not the step's.
  double flown_s() const { return flown_s_; }
  std::span<const std::uint32_t> touched() const { return touched_in_step_; }

  void snapshot(std::span<BallState> balls) const { world_.snapshot(balls, flown_s_); }

  /// How far a ball gets in this step at most, m, where fields act.
  double longest_path() const requires kAccelerates { return (fastest_ + 0.5 * field_speed_) * step_s_; }

  /// Where the ball can get in this step.
  Reach<Dim> reach(std::size_t ball) const {
    if (is_touched(ball)) return record(ball).reach;
    return {place(ball), world_.radius[ball] + path_bound(ball, step_s_)};
  }

  /// After a new flight has begun; returns whether the ball can get farther than before.
  bool widen_reach(std::size_t ball) {
    Reach<Dim>& reach = touch(ball).reach;
    const double bound = world_.radius[ball] + way_in_step(ball);
    if (bound <= reach.bound) return false;
    reach.bound = bound;
    return true;
  }

  /// How far from where it began the step a ball may get in it, m. @pre it was touched
  double way_in_step(std::size_t ball) const {
    const double moved = (world_.position[ball] - record(ball).reach.centre).norm();
    return moved + path_bound(ball, left_s(ball));
  }

  /// Has the processor load what the flight of a ball is known by.
  void fetch(std::size_t ball) const {
    world_.fetch(ball);
    prefetch(&touched_[ball]);
  }

  /// Where a ball is at its clock.
  Vec<Dim> place(std::size_t ball) const {
    return is_touched(ball) ? world_.position[ball] : place_at_start(ball);
  }

  /// Where a ball that was not touched is at the start of the step.
  Vec<Dim> place_at_start(std::size_t ball) const {
    if constexpr (kAccelerates) return world_.position[ball];
    return world_.place_after(flown_s_, ball);
  }

  /// A ball's flight from its clock on.
  Motion<Dim> motion(std::size_t ball) const {
    return {place(ball), world_.velocity[ball], acceleration(ball)};
  }

  /// Where the ball is at a time of the step, its clock or later.
  Motion<Dim> motion_at(std::size_t ball, double time_s) const {
    return motion(ball).after(time_s - clock(ball));
  }

  /// How far the ball can get in `duration_s`, m.
  double path_bound(std::size_t ball, double duration_s) const {
    double speed = world_.velocity[ball].norm();
    if constexpr (kAccelerates) speed += 0.5 * duration_s * acceleration_[ball].norm();
    return speed * duration_s;
  }

  /// Moves the ball along its flight to a time of the step, and books what bears it on the way.
  void fly_to(std::size_t ball, double time_s) {
    Record& record = touch(ball);
    const double tau = time_s - record.clock;
    if constexpr (kAccelerates) {
      if (!force_[ball].isZero(0.0)) book_force(ball, tau);
      const Motion<Dim> then = motion(ball).after(tau);
      world_.position.set(ball, then.x);
      world_.velocity.set(ball, then.v);
    } else {
      world_.position.set(ball, world_.position[ball] + tau * world_.velocity[ball]);
    }
    if constexpr (kTurning) world_.spin.set(ball, world_.spin[ball] + tau * spin_acceleration_[ball]);
    record.clock = time_s;
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
    std::uint32_t stamp;
    double clock;  ///< s, from the start of the step: where position and velocity stand
    Reach<Dim> reach;
  };

  /// Where a ball that was touched is at the end of the step.
  struct Arrival {
    Vec<Dim> x;
    Vec<Dim> v;
  };

  static constexpr std::uint32_t kUntouched = std::numeric_limits<std::uint32_t>::max();

  bool is_touched(std::size_t ball) const { return touched_[ball] != kUntouched; }
  const Record& record(std::size_t ball) const { return records_[touched_[ball]]; }

  /// Makes a record of the ball as it is at the start of the step, unless there is one. To change the
  /// velocity of a ball without one would be to put it somewhere else.
  Record& touch(std::size_t ball) {
    if (!is_touched(ball)) {
      const Reach<Dim> from_here = reach(ball);
      world_.position.set(ball, from_here.centre);
      touched_[ball] = static_cast<std::uint32_t>(records_.size());
      records_.push_back({static_cast<std::uint32_t>(ball), 0, 0.0, from_here});
    }
    return records_[touched_[ball]];
  }

  void note_flight(std::size_t ball) {
    ++touch(ball).stamp;
    if constexpr (kAccelerates) fastest_ = std::max(fastest_, world_.velocity[ball].norm());
  }

  void forget(std::size_t ball) {
    touched_[ball] = kUntouched;
    if constexpr (kAccelerates) force_.set(ball, Vec<Dim>::Zero());
    if constexpr (kTurning) still(ball);
  }

  /// What fly_to() does, for all balls and from the step's start to its end. Whoever was touched flies as
  /// well: to ask each would take longer than to put few back.
  void fly_whole_step() requires kAccelerates {
    threads_.in_parallel(size(), [this](std::size_t begin, std::size_t end) {
      const std::span<double> x = world_.position.components(begin, end);
      const std::span<double> v = world_.velocity.components(begin, end);
      const std::span<const double> a = std::as_const(acceleration_).components(begin, end);
      for (std::size_t k = 0; k < x.size(); ++k) {
        x[k] += step_s_ * (v[k] + (0.5 * step_s_) * a[k]);
        v[k] += step_s_ * a[k];
      }
    });
  }

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
  double fastest_ = 0.0;           ///< m/s, no ball is faster; where fields act
  Column<std::uint32_t> touched_;  ///< of each ball, which of the records is its
  std::vector<Record> records_;
  std::vector<Arrival> arrivals_;
  std::vector<std::uint32_t> touched_in_step_;
  double flown_s_ = 0.0;  ///< how long balls have flown by the start of the step since they landed
  VectorColumn<Dim> acceleration_;
  VectorColumn<Dim> force_;  ///< N, by the walls and immovable balls that bear the ball
  VectorColumn<kSpinAxes<Dim>> spin_acceleration_;
  VectorColumn<kSpinAxes<Dim>> torque_;  ///< N m, of force_ about the centre
};

}  // namespace carom
