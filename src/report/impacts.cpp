#include "report/impacts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "scenario/cast.h"

namespace carom {

namespace {

constexpr double kSpeedNoise = 1e-5;  // by the largest speed: a hundred roundings of single precision
constexpr double kTouching = 0.02;    // by the smaller radius: how near two flights must come to touch
constexpr double kPressing = 4.0;     // times what gravity changes in an interval: held, not hit
constexpr double kNever = 2.0;        // of an interval: no contact in it

using Meeting = std::pair<std::int32_t, std::int32_t>;

Vec3 acceleration(const Scenario& scenario, const Ball& ball, const BallState& state) {
  Vec3 a = scenario.effects.gravity.value_or(Vec3::Zero());
  if (scenario.effects.drag) {
    const double c = scenario.effects.drag->coefficient / ball.mass;
    const bool linear = scenario.effects.drag->kind == Drag::Kind::linear;
    a -= (linear ? c : c * state.velocity.norm()) * state.velocity;
  }
  if (scenario.effects.magnus) a += *scenario.effects.magnus / ball.mass * state.spin.cross(state.velocity);
  return a;
}

/// The share of an interval after which points at distance `from`, moving on by `by` in the whole interval,
/// come to a distance of `reach`; kNever where they do not, 0 where they touch and approach at once.
double meets_after(const Vec3& from, const Vec3& by, double reach) {
  const double a = by.squaredNorm();
  const double b = from.dot(by);
  const double c = from.squaredNorm() - reach * reach;
  if (b >= 0.0 || a == 0.0) return kNever;
  if (c <= 0.0) return 0.0;
  const double discriminant = b * b - a * c;
  return discriminant < 0.0 ? kNever : c / (-b + std::sqrt(discriminant));
}

/// One interval between two frames.
class Interval {
 public:
  /// @param balls  by number, those that are there throughout and that no event changes in this interval
  Interval(const Scenario& scenario, const std::vector<std::optional<Ball>>& balls,
           const Trajectory& trajectory, std::size_t frame, double speed_noise)
      : scene_(scenario),
        balls_(balls),
        before_(trajectory.frame(frame)),
        after_(trajectory.frame(frame + 1)),
        start_s_(trajectory.time(frame)),
        length_s_(trajectory.time(frame + 1) - start_s_) {
    for (std::size_t i = 0; i < before_.size(); ++i) {
      if (balls_[i] && is_hit(i, speed_noise)) hit_.push_back(i);
    }
  }

  bool quiet() const { return hit_.empty(); }
  std::vector<SeenImpact> impacts() const;
  /// Whether what changed the ball's velocity is no more than what presses it onto what it lies on.
  bool presses(std::size_t ball) const {
    const Vec3 gravity = scene_.effects.gravity.value_or(Vec3::Zero());
    return jump(ball).norm() <= kPressing * gravity.norm() * length_s_;
  }

 private:
  struct Span {
    std::size_t ball;
    double low;
    double high;
  };

  Vec3 jump(std::size_t i) const {
    const Ball& ball = *balls_[i];
    return after_[i].velocity - before_[i].velocity -
           0.5 * length_s_ * (acceleration(scene_, ball, before_[i]) + acceleration(scene_, ball, after_[i]));
  }

  bool is_hit(std::size_t i, double speed_noise) const {
    const Ball& ball = *balls_[i];
    if (!std::isfinite(ball.mass)) return false;
    const Vec3 change = acceleration(scene_, ball, after_[i]) - acceleration(scene_, ball, before_[i]);
    return jump(i).norm() > change.norm() * length_s_ + speed_noise;
  }

  Vec3 fall() const { return 0.5 * length_s_ * length_s_ * scene_.effects.gravity.value_or(Vec3::Zero()); }
  Vec3 onward(std::size_t i) const { return length_s_ * before_[i].velocity + fall(); }
  Vec3 backward(std::size_t i) const { return fall() - length_s_ * after_[i].velocity; }

  std::vector<Span> spans() const;
  std::optional<double> pair_meets(std::size_t i, std::size_t j) const;
  std::optional<double> wall_meets(std::size_t i) const;
  double turns_after(std::size_t i) const;
  SeenImpact impact(double share, std::size_t ball, std::int32_t other) const {
    return {start_s_ + length_s_ * share, static_cast<std::int32_t>(ball), other};
  }

  const Scenario& scene_;
  const std::vector<std::optional<Ball>>& balls_;
  std::span<const BallState> before_;
  std::span<const BallState> after_;
  double start_s_;
  double length_s_;
  std::vector<std::size_t> hit_;
};

/// When the pair touches in the interval, as a share of it, from either end.
std::optional<double> Interval::pair_meets(std::size_t i, std::size_t j) const {
  const double smaller = std::min(balls_[i]->radius, balls_[j]->radius);
  const double reach = balls_[i]->radius + balls_[j]->radius + kTouching * smaller;
  const double forward = meets_after(before_[i].position - before_[j].position, onward(i) - onward(j), reach);
  if (forward <= 1.0) return forward;
  const double back = meets_after(after_[i].position - after_[j].position, backward(i) - backward(j), reach);
  if (back <= 1.0) return 1.0 - back;
  return std::nullopt;
}

/// Where the flight onward from the frame before and that back from the frame after are nearest each other.
double Interval::turns_after(std::size_t i) const {
  const Vec3 gap = after_[i].position + backward(i) - before_[i].position;
  const Vec3 apart = (before_[i].velocity - after_[i].velocity) * length_s_ + 2.0 * fall();
  const double square = apart.squaredNorm();
  return square > 0.0 ? std::clamp(gap.dot(apart) / square, 0.0, 1.0) : 0.5;
}

std::optional<double> Interval::wall_meets(std::size_t i) const {
  const double near = kTouching * balls_[i]->radius;
  const double share = turns_after(i);
  const Vec3 there = before_[i].position + share * length_s_ * before_[i].velocity + share * share * fall();
  const auto is_at = [&](const Vec3& normal, double offset, double reach) {
    const double depth_m = length_s_ * std::abs(jump(i).dot(normal)) * 1e-3;
    return std::abs(std::abs(normal.dot(there) - offset) - reach) < near + depth_m;
  };
  const double radius = balls_[i]->radius;
  for (const Wall& wall : scene_.walls) {
    if (is_at(wall.normal, wall.offset, radius)) return share;
  }
  for (const Slab& slab : scene_.slabs) {
    if (is_at(slab.normal, slab.offset, 0.5 * slab.thickness + radius)) return share;
  }
  for (const Barrier& barrier : scene_.barriers) {
    // A barrier acts on a ball's centre where it stands in for a particle, on its surface where it does for a
    // ball.
    if (is_at(barrier.normal, barrier.offset, 0.5 * barrier.thickness + radius)) return share;
    if (is_at(barrier.normal, barrier.offset, 0.5 * barrier.thickness)) return share;
  }
  return std::nullopt;
}

/// What each ball that was hit, or that cannot be moved, sweeps along x in the interval, by its lower end.
std::vector<Interval::Span> Interval::spans() const {
  std::vector<Span> spans;
  const auto add = [&](std::size_t i) {
    const double r = (1.0 + kTouching) * balls_[i]->radius;
    const double x[] = {before_[i].position.x(), before_[i].position.x() + onward(i).x(),
                        after_[i].position.x(), after_[i].position.x() + backward(i).x()};
    const auto [low, high] = std::minmax_element(std::begin(x), std::end(x));
    spans.push_back({i, *low - r, *high + r});
  };
  for (const std::size_t i : hit_) add(i);
  for (std::size_t i = 0; i < before_.size(); ++i) {
    if (balls_[i] && !std::isfinite(balls_[i]->mass)) add(i);
  }
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.low < b.low; });
  return spans;
}

std::vector<SeenImpact> Interval::impacts() const {
  std::vector<SeenImpact> found;
  std::vector<bool> told(before_.size(), false);
  const std::vector<Span> sweeps = scene_.effects.collisions ? spans() : std::vector<Span>{};
  for (std::size_t a = 0; a < sweeps.size(); ++a) {
    for (std::size_t b = a + 1; b < sweeps.size() && sweeps[b].low <= sweeps[a].high; ++b) {
      const auto [i, j] = std::minmax(sweeps[a].ball, sweeps[b].ball);
      if (!std::isfinite(balls_[i]->mass) && !std::isfinite(balls_[j]->mass)) continue;
      const std::optional<double> share = pair_meets(i, j);
      if (!share) continue;
      found.push_back(impact(*share, i, static_cast<std::int32_t>(j)));
      told[i] = told[j] = true;
    }
  }
  for (const std::size_t i : hit_) {
    if (told[i]) continue;
    const std::optional<double> share = wall_meets(i);
    found.push_back(
        impact(share.value_or(turns_after(i)), i, share ? SeenImpact::kWall : SeenImpact::kUnknown));
  }
  return found;
}

/// The balls that the next interval can be read from.
std::vector<std::optional<Ball>> undisturbed(Cast& cast, std::int64_t frame_after) {
  std::vector<std::optional<Ball>> balls;
  for (std::size_t i = 0; i < cast.size(); ++i) balls.push_back(cast[i]);
  cast.to_frame(frame_after, [&](const BallChange& change) { balls[change.ball].reset(); });
  return balls;
}

double fastest_mps(const Trajectory& trajectory) {
  double square = 0.0;
  for (std::size_t k = 0; k < trajectory.frames(); ++k) {
    for (const BallState& state : trajectory.frame(k))
      square = std::max(square, state.velocity.squaredNorm());
  }
  return std::sqrt(square);
}

}  // namespace

SeenImpacts find_impacts(const Scenario& scenario, const Trajectory& trajectory, std::size_t most) {
  SeenImpacts seen;
  const double speed_noise = kSpeedNoise * fastest_mps(trajectory);
  std::set<Meeting> held;
  Cast cast(scenario);
  cast.to_frame(0);
  std::vector<std::optional<Ball>> balls(scenario.balls.begin(), scenario.balls.end());
  for (std::size_t k = 0; k + 1 < trajectory.frames(); ++k) {
    if (!scenario.events.empty()) balls = undisturbed(cast, static_cast<std::int64_t>(k) + 1);
    const Interval interval(scenario, balls, trajectory, k, speed_noise);
    std::set<Meeting> meeting;
    if (!interval.quiet()) {
      std::vector<SeenImpact> impacts = interval.impacts();
      std::sort(impacts.begin(), impacts.end(), [](const SeenImpact& a, const SeenImpact& b) {
        return std::tie(a.time_s, a.ball, a.other) < std::tie(b.time_s, b.ball, b.other);
      });
      for (const SeenImpact& impact : impacts) {
        const Meeting who(impact.ball, impact.other);
        meeting.insert(who);
        if (held.contains(who) && interval.presses(static_cast<std::size_t>(impact.ball))) continue;
        if (seen.impacts.size() == most) {
          seen.more = true;
          return seen;
        }
        seen.impacts.push_back(impact);
      }
    }
    held = std::move(meeting);
  }
  return seen;
}

}  // namespace carom
