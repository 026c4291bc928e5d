#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/engine.h"

namespace carom::plain {

/// A ball as it is now.
struct Body {
  const Ball* ball = nullptr;
  Vec3 x;  ///< m
  Vec3 v;  ///< m/s
  Vec3 w;  ///< rad/s
};

/// Two surfaces that meet. Without `b` the other one is a wall.
struct Touch {
  std::size_t a = 0;
  std::optional<std::size_t> b;
  Vec3 normal;          ///< unit vector from a to b, or into the wall
  double wait_s = 0.0;  ///< until they meet
};

/// The engine of a textbook, plain and slow: from impact to impact, each found by looking at every pair and
/// every wall; parabolas between them, or Runge and Kutta's fourth order where a force depends on the
/// velocity. It shares nothing with Carom's engine, and every step of it can be overridden: the engines that
/// are broken on purpose (defects.cpp) are this one with one step done wrong.
class Plain : public Simulation {
 public:
  explicit Plain(const Scenario& scene);

  void advance(double step_s, std::int64_t steps) override;
  void snapshot(std::span<BallState> balls) const override;
  Tally tally() const override { return tally_; }
  Settings settings() const override { return {}; }

 protected:
  // --- motion

  /// Force by mass, m/s².
  virtual Vec3 acceleration(const Body& body) const;
  /// Every ball on by a time in which nothing meets.
  virtual void fly(double time_s);

  // --- finding what meets

  virtual bool sees(const Body& /*a*/, const Body& /*b*/) const { return true; }
  virtual bool sees_wall(std::size_t /*wall*/) const { return true; }
  virtual double radius(const Body& body) const { return body.ball->radius; }
  /// Until two balls touch; nothing where they do not.
  std::optional<double> wait(const Body& a, const Body& b) const;
  /// Until a ball touches the plane normal·x = offset from the side of its normal.
  std::optional<double> wait(const Body& a, const Vec3& normal, double offset) const;
  virtual std::optional<Touch> next_touch() const;

  // --- what happens then

  virtual Contact surface(const Touch& touch) const;
  virtual double mass(const Body& body, const Touch& /*touch*/) const { return body.ball->mass; }
  virtual double inertia(const Body& body) const { return body.ball->inertia; }
  /// Velocity of b's surface against a's where they touch, m/s.
  virtual Vec3 slip(const Touch& touch) const;
  /// What b gets and a gives, N s, by the three-parameter law (Walton; Foerster et al., Phys. Fluids 6,
  /// 1108).
  virtual Vec3 impulse(const Touch& touch) const;
  virtual void push(const Touch& touch, const Vec3& impulse_Ns);
  /// Changes a ball by an impulse at the point of its surface in the direction `out`, in units of its radius.
  virtual void push(Body& body, const Touch& touch, const Vec3& out, const Vec3& impulse_Ns) const;
  /// What walls and immovable balls gave.
  virtual void book(const Vec3& impulse_Ns, const Vec3& at);
  virtual void collide(const Touch& touch);

  const Scenario& scene() const { return *scene_; }
  bool smooth() const { return scene_->effects.drag.has_value() || scene_->effects.magnus.has_value(); }
  Vec3 gravity() const { return scene_->effects.gravity.value_or(Vec3::Zero()); }

  std::vector<Body> bodies_;
  Tally tally_;
  double time_s_ = 0.0;
  double step_s_ = 0.0;  ///< of the call that is running

 private:
  void integrate(double step_s);
  void add_walls(std::optional<Touch>& first, std::size_t a) const;
  static void take(std::optional<Touch>& first, const std::optional<double>& wait_s, Touch touch);

  const Scenario* scene_;
};

}  // namespace carom::plain
