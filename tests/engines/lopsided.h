#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/engines/still.h"

namespace carom::test {

/// Elastic smooth balls in free space, from impact to impact on exact flights, every pair looked at each
/// time: right in every symmetry, but for what `Flaw` does to it. What an engine keeps although it has a flaw
/// is told by nothing but the flaw.
///
/// A Flaw has static functions, each right as NoFlaw has it:
///   mass(scene, ball)          kg, what the ball weighs in impacts
///   stretched(v)               what a distance is measured with
///   normal(n)                  the direction of the impulse, from a unit vector between the centres
///   restitution(v_n_mps)       of an impact at that speed
///   kKept                      the share of its velocity that a ball keeps in an impact
template <class Flaw>
class LopsidedGas final : public StillSimulation {
 public:
  explicit LopsidedGas(const Scenario& scene) : StillSimulation(scene), scene_(scene) {}

  void advance(double step_s, std::int64_t steps) override {
    double left_s = step_s * static_cast<double>(steps);
    while (true) {
      const Meeting next = next_meeting();
      const double flight_s = std::min(next.time_s, left_s);
      for (BallState& state : states_) state.position += flight_s * state.velocity;
      left_s -= flight_s;
      if (next.time_s > flight_s || left_s <= 0.0) return;
      collide(next.a, next.b);
    }
  }

  Tally tally() const override {
    Tally tally;
    tally.impacts = impacts_;
    return tally;
  }

 private:
  struct Meeting {
    double time_s = std::numeric_limits<double>::infinity();
    std::size_t a = 0;
    std::size_t b = 0;
  };

  /// When two balls on straight paths touch: the root of |x + v t|² = d² on the way in, without cancellation.
  double meeting_s(std::size_t a, std::size_t b) const {
    const Vec3 x = Flaw::stretched(Vec3(states_[b].position - states_[a].position));
    const Vec3 v = Flaw::stretched(Vec3(states_[b].velocity - states_[a].velocity));
    const double reach_m = scene_.balls[a].radius + scene_.balls[b].radius;
    const double approach = -x.dot(v);
    const double gap = x.squaredNorm() - reach_m * reach_m;
    const double root = approach * approach - v.squaredNorm() * gap;
    if (approach <= 0.0 || root < 0.0) return std::numeric_limits<double>::infinity();
    return std::max(gap, 0.0) / (approach + std::sqrt(root));
  }

  Meeting next_meeting() const {
    Meeting next;
    for (std::size_t a = 0; a < states_.size(); ++a) {
      for (std::size_t b = a + 1; b < states_.size(); ++b) {
        const double time_s = meeting_s(a, b);
        if (time_s < next.time_s) next = {time_s, a, b};
      }
    }
    return next;
  }

  void collide(std::size_t a, std::size_t b) {
    const Vec3 n = Flaw::normal(Vec3((states_[b].position - states_[a].position).normalized()));
    const double closing_mps = -n.dot(states_[b].velocity - states_[a].velocity);
    const double mass_a = Flaw::mass(scene_, a);
    const double mass_b = Flaw::mass(scene_, b);
    const double impulse_Ns =
        (1.0 + Flaw::restitution(closing_mps)) * closing_mps / (1.0 / mass_a + 1.0 / mass_b);
    states_[a].velocity = Flaw::kKept * Vec3(states_[a].velocity - impulse_Ns / mass_a * n);
    states_[b].velocity = Flaw::kKept * Vec3(states_[b].velocity + impulse_Ns / mass_b * n);
    ++impacts_;
  }

  const Scenario& scene_;
  std::int64_t impacts_ = 0;
};

struct NoFlaw {
  static constexpr double kKept = 1.0;
  static double mass(const Scenario& scene, std::size_t ball) { return scene.balls[ball].mass; }
  static Vec3 stretched(const Vec3& v) { return v; }
  static Vec3 normal(const Vec3& n) { return n; }
  static double restitution(double /*v_n_mps*/) { return 1.0; }
};

/// Ball 0 weighs a hundredth more than it should: who has which number matters.
struct BallZeroIsHeavier : NoFlaw {
  static double mass(const Scenario& scene, std::size_t ball) {
    return scene.balls[ball].mass * (ball == 0 ? 1.01 : 1.0);
  }
};

/// Balls are a thousandth wider across than they are high, with a normal of their own: x is not y. The left
/// is as good as the right.
struct WiderThanHigh : NoFlaw {
  static Vec3 stretched(const Vec3& v) { return {v.x() / 1.001, v.y(), v.z()}; }
};

/// Every impulse is a thousandth of a radian to the left of where it belongs: a handedness.
struct LeftHanded : NoFlaw {
  static Vec3 normal(const Vec3& n) {
    return Vec3(n.x() - 1e-3 * n.y(), n.y() + 1e-3 * n.x(), n.z()).normalized();
  }
};

/// A ball loses a millionth of its velocity at each impact, as seen from here: a frame that is at rest.
struct FrameAtRest : NoFlaw {
  static constexpr double kKept = 1.0 - 1e-6;
};

/// An impact takes a thousandth of the speed: time has a direction.
struct Lossy : NoFlaw {
  static double restitution(double /*v_n_mps*/) { return 0.999; }
};

/// Impacts below half a metre per second are taken for rest: a speed of its own, and a loss.
struct OwnSpeed : NoFlaw {
  static double restitution(double v_n_mps) { return v_n_mps < 0.5 ? 0.0 : 1.0; }
};

}  // namespace carom::test
