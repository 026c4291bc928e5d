#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "reference/exact/motion.h"
#include "reference/exact/scene_facts.h"

namespace carom::exact {

namespace {

constexpr std::size_t kBalls = 2;

/// The one impact of two balls: what it changes.
struct Meeting {
  Twofold time_s;
  std::array<Vec3Twofold, kBalls> jump_mps;  ///< what is added to each velocity
};

/// The shares of the change of relative velocity: the lighter ball takes the larger one.
std::array<Twofold, kBalls> shares(const Ball& a, const Ball& b) {
  if (is_immovable(a)) return {0.0, 1.0};
  if (is_immovable(b)) return {1.0, 0.0};
  const Twofold total = exact_sum(a.mass, b.mass);
  return {Twofold(b.mass) / total, Twofold(a.mass) / total};
}

/// The impact of two balls whose relative motion is uniform: d and u the place and velocity of b against a,
/// R the sum of the radii.
///
///   |d + u t| = R                                                          (1)
///   t = (d² - R²) / (-d·u + √D),   D = u² R² - |d × u|²                    (2)
///   n = (d + u t) / R,   u·n = -√D / R                                     (3)
///
/// (2) is the earlier root of (1) without its cancellation, and D its discriminant by way of the impact
/// parameter |d × u| / |u|. None where they part, or pass (D <= 0: at best they graze without a push).
/// A frictionless impact then adds -(1 + e) (u·n) n to u.
std::optional<Meeting> meeting_of(const Scenario& scenario) {
  const Ball& a = scenario.balls[0];
  const Ball& b = scenario.balls[1];
  const Vec3Twofold d = widened(b.position) - widened(a.position);
  const Vec3Twofold u = widened(b.velocity) - widened(a.velocity);
  const Twofold reach = exact_sum(a.radius, b.radius);
  const Twofold approach = -d.dot(u);
  const Twofold square = u.dot(u) * reach * reach - d.cross(u).dot(d.cross(u));
  if (approach <= 0.0 || square <= 0.0) return std::nullopt;
  const Twofold root = sqrt(square);
  const Twofold apart = std::max(Twofold(0.0), d.dot(d) - reach * reach);
  const Twofold time_s = apart / (approach + root);
  const Vec3Twofold n = (d + u * time_s) / reach;
  const Twofold change = root / reach * (Twofold(1.0) + scenario.ball_contact.restitution);
  const auto [share_a, share_b] = shares(a, b);
  return Meeting{time_s, {Vec3Twofold(n * (-share_a * change)), Vec3Twofold(n * (share_b * change))}};
}

class PairMotion final : public Motion {
 public:
  PairMotion(const Scenario& scenario, const std::optional<Meeting>& meeting)
      : scenario_(scenario), meeting_(meeting) {}

  std::string_view family() const override { return "two balls"; }

  void evaluate(const Twofold& time_s, std::span<BallState> balls) const override {
    for (std::size_t i = 0; i < kBalls; ++i) {
      balls[i].position = rounded(position(i, time_s));
      balls[i].velocity = rounded(velocity(i, time_s));
    }
  }

  /// An immovable ball is outside the system: its push on the other one acts along the line of centres, and
  /// so has the same moment at the centre as at the contact.
  Tally tally(const Twofold& time_s) const override {
    Tally total;
    if (!meeting_ || time_s < meeting_->time_s) return total;
    total.impacts = 1;
    if (is_immovable(scenario_.balls[0]) == is_immovable(scenario_.balls[1])) return total;
    const std::size_t movable = is_immovable(scenario_.balls[0]) ? 1 : 0;
    const Vec3Twofold push = meeting_->jump_mps[movable] * Twofold(scenario_.balls[movable].mass);
    total.external_impulse = rounded(push);
    total.external_angular_impulse = rounded(position(movable, meeting_->time_s).cross(push));
    return total;
  }

  /// Even where the balls all but graze, √D is right to the root of a pair's rounding, which is ε: one more ε
  /// of the way that the change of velocity covers.
  double uncertainty_m() const override {
    double farthest = scale_m(scenario_);
    const double end_s = scenario_.duration_s;
    for (std::size_t i = 0; i < kBalls; ++i) {
      const Ball& ball = scenario_.balls[i];
      const double speed = ball.velocity.norm() + (meeting_ ? rounded(meeting_->jump_mps[i]).norm() : 0.0);
      const double acceleration = acceleration_of(ball, scenario_.effects).norm();
      const double way = end_s * (speed + 0.5 * acceleration * end_s);
      farthest = std::max(farthest, ball.position.norm() + way);
    }
    return kEpsilon * farthest + rounding_bound_m(scenario_, farthest);
  }

  Vec3Twofold position(std::size_t i, const Twofold& time_s) const {
    const Ball& ball = scenario_.balls[i];
    const Vec3Twofold a = widened(acceleration_of(ball, scenario_.effects));
    Vec3Twofold x = widened(ball.position) + (widened(ball.velocity) + a * (time_s * 0.5)) * time_s;
    if (meeting_ && time_s > meeting_->time_s) x += meeting_->jump_mps[i] * (time_s - meeting_->time_s);
    return x;
  }

  Vec3Twofold velocity(std::size_t i, const Twofold& time_s) const {
    const Ball& ball = scenario_.balls[i];
    const Vec3Twofold a = widened(acceleration_of(ball, scenario_.effects));
    Vec3Twofold v = widened(ball.velocity) + a * time_s;
    if (meeting_ && time_s >= meeting_->time_s) v += meeting_->jump_mps[i];
    return v;
  }

 private:
  const Scenario& scenario_;
  std::optional<Meeting> meeting_;
};

/// When the velocity v + a t along a direction changes sign; at the start where it never does.
Twofold turn_s(const Vec3Twofold& normal, const Vec3Twofold& v, const Vec3Twofold& a) {
  const Twofold v_n = normal.dot(v);
  const Twofold a_n = normal.dot(a);
  return v_n * a_n < 0.0 ? -v_n / a_n : Twofold(0.0);
}

/// Whether a ball reaches a wall. Its way has two parabolas; each is nearest to the wall at an end or where
/// it turns.
bool reaches(const Wall& wall, std::size_t i, const PairMotion& motion, const Twofold& meeting_s,
             const Scenario& scenario) {
  const Ball& ball = scenario.balls[i];
  const Twofold end_s = horizon_s(scenario);
  const Twofold middle_s = std::min(meeting_s, end_s);
  const Vec3Twofold normal = widened(wall.normal);
  const Vec3Twofold a = widened(acceleration_of(ball, scenario.effects));
  const Twofold before_s = turn_s(normal, widened(ball.velocity), a);
  const Twofold after_s = middle_s + turn_s(normal, motion.velocity(i, middle_s), a);
  const std::array moments = {Twofold(0.0), std::min(before_s, middle_s), middle_s, std::min(after_s, end_s),
                              end_s};
  return std::any_of(moments.begin(), moments.end(), [&](const Twofold& t) {
    return gap_m(wall, ball.radius, rounded(motion.position(i, t))) < -touch_m(scenario);
  });
}

/// Why two balls are beyond this family before anything is computed; empty where they are not.
std::string refusal(const Scenario& scenario) {
  const Ball& a = scenario.balls[0];
  const Ball& b = scenario.balls[1];
  const Vec3Twofold d = widened(b.position) - widened(a.position);
  if (sqrt(d.dot(d)) < exact_sum(a.radius, b.radius) - touch_m(scenario)) return "balls start overlapping";
  if (is_immovable(a) != is_immovable(b) &&
      !acceleration_of(is_immovable(a) ? b : a, scenario.effects).isZero(0.0)) {
    return "one ball falls and the other is immovable";
  }
  return {};
}

}  // namespace

Attempt try_pair(const Scenario& scenario) {
  if (scenario.balls.size() != kBalls || !scenario.effects.collisions || has_drag(scenario)) return {};
  std::string reason = refusal(scenario);
  if (!reason.empty()) return {nullptr, reason};
  std::optional<Meeting> meeting = meeting_of(scenario);
  if (meeting && meeting->time_s > horizon_s(scenario)) meeting.reset();
  if (meeting && is_immovable(scenario.balls[0]) && is_immovable(scenario.balls[1])) {
    return {nullptr, "two immovable balls meet"};
  }
  if (meeting && scenario.ball_contact.friction > 0.0) return {nullptr, "the balls are rough and meet"};
  auto motion = std::make_unique<PairMotion>(scenario, meeting);
  const Twofold meeting_s = meeting ? meeting->time_s : horizon_s(scenario);
  for (std::size_t i = 0; i < kBalls; ++i) {
    for (const Wall& wall : scenario.walls) {
      if (reaches(wall, i, *motion, meeting_s, scenario)) {
        return {nullptr, fmt::format("two balls, and ball {} reaches a wall", i)};
      }
    }
  }
  return {std::move(motion), {}};
}

}  // namespace carom::exact
