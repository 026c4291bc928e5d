#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "reference/closed_form/accelerated.h"
#include "reference/closed_form/friction.h"
#include "reference/closed_form/motion.h"
#include "reference/closed_form/scene_facts.h"

namespace carom::closed_form {

namespace {

constexpr std::size_t kBalls = 2;

/// The one impact of two balls: what it changes.
struct Meeting {
  Twofold time_s;
  Vec3Twofold normal;                               ///< unit, from the first ball to the second
  std::array<Vec3Twofold, kBalls> jump_mps;         ///< what is added to each velocity
  std::array<Vec3Twofold, kBalls> spin_jump_radps;  ///< what is added to each spin
};

/// The shares of the change of relative velocity: the lighter ball takes the larger one.
std::array<Twofold, kBalls> shares(const Ball& a, const Ball& b) {
  if (is_immovable(a)) return {0.0, 1.0};
  if (is_immovable(b)) return {1.0, 0.0};
  const Twofold total = exact_sum(a.mass, b.mass);
  return {Twofold(b.mass) / total, Twofold(a.mass) / total};
}

/// The friction of an impact. The surface of b slips over that of a at
///
///   s = u - (u·n) n - (r_a ω_a + r_b ω_b) × n                              (1)
///
/// and the impulse J on b and -J on a, along the surface at r_a n and -r_b n, changes each velocity by ∓J/m
/// and each spin by -r n × J / (κ m r²) = -n × J / (κ m r), of the same sign for both.
void add_friction(const Scenario& scenario, const Vec3Twofold& u, const Twofold& change, Meeting& meeting) {
  const Ball& a = scenario.balls[0];
  const Ball& b = scenario.balls[1];
  const Twofold w = slip_per_impulse(a) + slip_per_impulse(b);
  if (scenario.ball_contact.friction == 0.0 || w == 0.0) return;
  const Vec3Twofold& n = meeting.normal;
  const Vec3Twofold rims = widened(a.spin) * Twofold(a.radius) + widened(b.spin) * Twofold(b.radius);
  const Vec3Twofold slip = u - n * n.dot(u) - rims.cross(n);
  const Twofold normal_Ns = change / (inverse_mass(a) + inverse_mass(b));
  const Vec3Twofold impulse = friction_impulse(scenario.ball_contact, slip, w, normal_Ns);
  for (std::size_t i = 0; i < kBalls; ++i) {
    const Ball& ball = scenario.balls[i];
    const Twofold per_kg = inverse_mass(ball);
    meeting.jump_mps[i] += impulse * (i == 0 ? -per_kg : per_kg);
    meeting.spin_jump_radps[i] = impulse.cross(n) * (per_kg / exact_product(ball.inertia, ball.radius));
  }
}

/// The impact of two balls whose relative motion is uniform: d and u the place and velocity of b against a,
/// R the sum of the radii.
///
///   |d + u t| = R                                                          (2)
///   t = (d² - R²) / (-d·u + √D),   D = u² R² - |d × u|²                    (3)
///   n = (d + u t) / R,   u·n = -√D / R                                     (4)
///
/// (3) is the earlier root of (2) without its cancellation, and D its discriminant by way of the impact
/// parameter |d × u| / |u|. None where they part, or pass (D <= 0: at best they graze without a push).
/// The impact then adds -(1 + e) (u·n) n to u, and friction what add_friction() says.
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
  Meeting meeting{time_s, n, {Vec3Twofold(n * (-share_a * change)), Vec3Twofold(n * (share_b * change))}, {}};
  add_friction(scenario, u, change, meeting);
  return meeting;
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
      if (happened(time_s)) {
        balls[i].spin = rounded(widened(scenario_.balls[i].spin) + meeting_->spin_jump_radps[i]);
      }
    }
  }

  /// An immovable ball is outside the system: its push on the other one acts at the contact.
  Tally tally(const Twofold& time_s) const override {
    Tally total;
    if (!happened(time_s)) return total;
    total.impacts = 1;
    if (is_immovable(scenario_.balls[0]) == is_immovable(scenario_.balls[1])) return total;
    const std::size_t movable = is_immovable(scenario_.balls[0]) ? 1 : 0;
    const Vec3Twofold push = meeting_->jump_mps[movable] * Twofold(scenario_.balls[movable].mass);
    total.external_impulse = rounded(push);
    const double to_other = movable == 0 ? 1.0 : -1.0;
    const Vec3Twofold arm = meeting_->normal * Twofold(to_other * scenario_.balls[movable].radius);
    total.external_angular_impulse = rounded((position(movable, meeting_->time_s) + arm).cross(push));
    return total;
  }

  /// Even where the balls all but graze, √D is right to the root of a pair's rounding, which is ε: one more ε
  /// of the way that the change of velocity covers. With friction that is off by the turn of the normal as
  /// well, which turns what the surfaces slip: one more ε of the way that the fastest point of them covers.
  double uncertainty_m() const override {
    const bool rough = scenario_.ball_contact.friction > 0.0;
    double farthest = scale_m(scenario_);
    const double end_s = scenario_.duration_s;
    for (std::size_t i = 0; i < kBalls; ++i) {
      const Ball& ball = scenario_.balls[i];
      const double rim = rough ? ball.radius * ball.spin.norm() : 0.0;
      const double jump = meeting_ ? rounded(meeting_->jump_mps[i]).norm() : 0.0;
      const double speed = ball.velocity.norm() + rim + jump;
      const double acceleration = acceleration_of(ball, scenario_.effects).norm();
      const double way = end_s * (speed + 0.5 * acceleration * end_s);
      farthest = std::max(farthest, ball.position.norm() + way);
    }
    return (rough ? 2.0 : 1.0) * kEpsilon * farthest + rounding_bound_m(scenario_, farthest);
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
    if (happened(time_s)) v += meeting_->jump_mps[i];
    return v;
  }

 private:
  bool happened(const Twofold& time_s) const { return meeting_ && time_s >= meeting_->time_s; }

  const Scenario& scenario_;
  std::optional<Meeting> meeting_;
};

/// Whether a ball reaches a wall. Its way has two parabolas; each is nearest to the wall at an end or where
/// it turns.
bool reaches(const Wall& wall, std::size_t i, const PairMotion& motion, const Twofold& meeting_s,
             const Scenario& scenario) {
  const Ball& ball = scenario.balls[i];
  const Twofold end_s = horizon_s(scenario);
  const Twofold middle_s = std::min(meeting_s, end_s);
  const Vec3Twofold normal = widened(wall.normal);
  const Vec3Twofold a = widened(acceleration_of(ball, scenario.effects));
  const Twofold before_s = turn_s(normal.dot(widened(ball.velocity)), normal.dot(a));
  const Twofold after_s = middle_s + turn_s(normal.dot(motion.velocity(i, middle_s)), normal.dot(a));
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
  if (scenario.balls.size() != kBalls || !scenario.effects.collisions) return {};
  if (has_drag(scenario) || has_magnus(scenario)) return {};
  std::string reason = refusal(scenario);
  if (!reason.empty()) return {nullptr, reason};
  std::optional<Meeting> meeting = meeting_of(scenario);
  if (meeting && meeting->time_s > horizon_s(scenario)) meeting.reset();
  if (meeting && is_immovable(scenario.balls[0]) && is_immovable(scenario.balls[1])) {
    return {nullptr, "two immovable balls meet"};
  }
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

}  // namespace carom::closed_form
