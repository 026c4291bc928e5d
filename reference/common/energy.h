#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "engine/engine.h"
#include "scenario/scenario.h"

namespace carom::reference {

/// What a contact of an engine did in a step, read from it after it solved the step. SI units, the scene's
/// frame. A wall or an immovable ball is no body here.
struct SolvedContact {
  struct Body {
    std::size_t ball = 0;
    Vec3 arm = Vec3::Zero();  ///< m, from its centre to where the push acts
  };
  std::optional<Body> a;
  std::optional<Body> b;
  Vec3 push = Vec3::Zero();  ///< N s, along the normal, on b
  Vec3 drag = Vec3::Zero();  ///< N s, along the surface, on b
};

/// Keeps an engine's EnergyAccount, step by step.
///
/// All pushes of a step on a ball change its velocity by Δv = Σ J/m and its spin by Δω = Σ arm × J/I (with
/// the engine's own I), whatever else happens in between, so with the velocity v' after the step each does
/// the work J·(v' - Δv/2) on it (1), and together they do what they changed of its kinetic energy. That holds
/// for many contacts at once, and for several solutions within a step.
///
/// Position correction: a ball whose contacts pushed, and that moved in the step from x to x' with the
/// velocity v' at its end, was shifted by x' - x - h v' without that velocity (2); the work of gravity on
/// that is its energy. This is zero where nothing is corrected. Where continuous collision stops a ball
/// within a step, the way that it went before counts here too. An engine that moves its balls first does so
/// by h v with the velocity v at the step's beginning, and corrects in a step what it found in the one
/// before: there the shift is x' - x - h v (3), of the balls that were pushed in the step before.
class EnergyBook {
 public:
  /// When within a step an engine moves its balls: with the velocity at its end, or with that at its
  /// beginning.
  enum class Moves { last, first };

  explicit EnergyBook(const Scenario& scene, Moves moves = Moves::last)
      : gravity_(scene.effects.gravity.value_or(Vec3::Zero())),
        moves_(moves),
        inverse_inertia_(scene.balls.size(), 0.0),
        before_(scene.balls.size()),
        change_(scene.balls.size()) {
    for (const Ball& ball : scene.balls) inverse_mass_.push_back(1.0 / ball.mass);
    account_.known = true;
  }

  /// 1/I of a ball as the engine has it, 1/(kg m²); 0 where it does not turn.
  void set_inverse_inertia(std::size_t ball, double inverse_inertia) {
    inverse_inertia_[ball] = inverse_inertia;
  }

  /// Whether it has to know where the balls are when a step begins: only gravity makes a shift cost energy.
  bool wants_places() const { return !gravity_.isZero(0.0); }

  /// The balls at the beginning of a step. To be filled where wants_places().
  std::vector<BallState>& before() { return before_; }

  /// A contact that pushed in this step.
  void add(const SolvedContact& contact) {
    contacts_.push_back(contact);
    if (contact.a) change(*contact.a, -contact.push - contact.drag);
    if (contact.b) change(*contact.b, contact.push + contact.drag);
  }

  /// Closes a step of h.
  /// @param after  the state of a ball at its end, by number
  template <class StateOf>
  void close_step(const StateOf& after, double step_s) {
    for (const std::size_t ball : pushed_before_) {
      shift(ball, after(ball).position - before_[ball].position - step_s * before_[ball].velocity);  // (3)
    }
    pushed_before_.clear();
    for (const SolvedContact& contact : contacts_) {
      const bool both = contact.a && contact.b;
      (both ? account_.ball_impacts_J : account_.wall_impacts_J) += work(contact, contact.push, after);
      account_.friction_J += work(contact, contact.drag, after);
    }
    for (const SolvedContact& contact : contacts_) {
      if (contact.a) close(contact.a->ball, after, step_s);
      if (contact.b) close(contact.b->ball, after, step_s);
    }
    contacts_.clear();
  }

  const EnergyAccount& account() const { return account_; }

 private:
  struct Change {
    Vec3 velocity = Vec3::Zero();
    Vec3 spin = Vec3::Zero();
    bool open = false;
  };

  void change(const SolvedContact::Body& body, const Vec3& impulse) {
    Change& change = change_[body.ball];
    change.velocity += inverse_mass_[body.ball] * impulse;
    change.spin += inverse_inertia_[body.ball] * body.arm.cross(impulse);
    change.open = true;
  }

  /// (1) of an impulse on b and its opposite on a.
  template <class StateOf>
  double work(const SolvedContact& contact, const Vec3& impulse, const StateOf& after) const {
    Vec3 velocity = Vec3::Zero();
    if (contact.a) velocity -= mean_velocity(*contact.a, after);
    if (contact.b) velocity += mean_velocity(*contact.b, after);
    return impulse.dot(velocity);
  }

  template <class StateOf>
  Vec3 mean_velocity(const SolvedContact::Body& body, const StateOf& after) const {
    const BallState state = after(body.ball);
    const Change& change = change_[body.ball];
    return state.velocity - 0.5 * change.velocity + (state.spin - 0.5 * change.spin).cross(body.arm);
  }

  /// Once for each ball.
  template <class StateOf>
  void close(std::size_t ball, const StateOf& after, double step_s) {
    if (!change_[ball].open) return;
    change_[ball] = {};
    if (!wants_places()) return;
    if (moves_ == Moves::first) {
      pushed_before_.push_back(ball);
      return;
    }
    const BallState state = after(ball);
    shift(ball, state.position - before_[ball].position - step_s * state.velocity);  // (2)
  }

  /// The engine moved a ball by this without a velocity.
  void shift(std::size_t ball, const Vec3& by_m) {
    account_.correction_J -= gravity_.dot(by_m) / inverse_mass_[ball];
  }

  Vec3 gravity_;
  Moves moves_;
  std::vector<double> inverse_mass_;
  std::vector<double> inverse_inertia_;
  std::vector<BallState> before_;
  std::vector<Change> change_;  // by the pushes of this step
  std::vector<SolvedContact> contacts_;
  std::vector<std::size_t> pushed_before_;  // in the step before, where balls move first
  EnergyAccount account_;
};

}  // namespace carom::reference
