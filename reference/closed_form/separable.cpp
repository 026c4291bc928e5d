#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "reference/closed_form/axis_motion.h"
#include "reference/closed_form/motion.h"
#include "reference/closed_form/scene_facts.h"

namespace carom::closed_form {

namespace {

constexpr int kAxes = 3;

/// A ball that meets no other: every coordinate moves by itself.
using Axes = std::array<AxisMotion, kAxes>;

/// The axis a wall stands across; none where it is oblique.
std::optional<int> axis_of(const Wall& wall) {
  for (int axis = 0; axis < kAxes; ++axis) {
    if (std::abs(wall.normal[axis]) == 1.0) return axis;
  }
  return std::nullopt;
}

/// The nearest wall on either side is the one that counts.
void bound_by(const Wall& wall, double sign, double radius_m, AxisScene& scene) {
  const Twofold reach = exact_sum(wall.offset, radius_m);
  if (sign > 0.0) {
    scene.low_m = scene.low_m ? std::max(*scene.low_m, reach) : reach;
  } else {
    scene.high_m = scene.high_m ? std::min(*scene.high_m, -reach) : -reach;
  }
}

AxisMotion axis_motion(const Scenario& scenario, const Ball& ball, int axis, double touch) {
  AxisScene scene;
  scene.position_m = ball.position[axis];
  scene.velocity_mps = ball.velocity[axis];
  scene.acceleration_mps2 = acceleration_of(ball, scenario.effects)[axis];
  scene.restitution = scenario.wall_contact.restitution;
  scene.touch_m = touch;
  scene.horizon_s = horizon_s(scenario);
  for (const Wall& wall : scenario.walls) {
    if (axis_of(wall) == axis) bound_by(wall, wall.normal[axis], ball.radius, scene);
  }
  return AxisMotion(scene);
}

bool touches_wall(const Axes& axes) {
  return std::any_of(axes.begin(), axes.end(), [](const AxisMotion& axis) { return axis.touches_wall(); });
}

/// Whether a ball stays on its side of an oblique wall, judged by the box that its centre stays in.
bool stays_clear(const Wall& wall, const Ball& ball, const Axes& axes, double touch) {
  Vec3 nearest;
  for (int axis = 0; axis < kAxes; ++axis) {
    const AxisRange range = axes[static_cast<std::size_t>(axis)].range();
    nearest[axis] = wall.normal[axis] > 0.0 ? range.low_m.hi : range.high_m.hi;
  }
  return gap_m(wall, ball.radius, nearest) >= -touch;
}

class SeparableMotion final : public Motion {
 public:
  SeparableMotion(const Scenario& scenario, std::vector<Axes> balls)
      : scenario_(scenario), balls_(std::move(balls)) {}

  std::string_view family() const override { return "separable axes"; }

  void evaluate(const Twofold& time_s, std::span<BallState> balls) const override {
    for (std::size_t i = 0; i < balls.size(); ++i) {
      for (std::size_t axis = 0; axis < kAxes; ++axis) {
        const AxisState state = balls_[i][axis].at(time_s);
        balls[i].position[static_cast<Eigen::Index>(axis)] = state.position_m.hi;
        balls[i].velocity[static_cast<Eigen::Index>(axis)] = state.velocity_mps.hi;
      }
    }
  }

  Tally tally(const Twofold& time_s) const override {
    Tally total;
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      if (touches_wall(balls_[i])) add_walls(scenario_.balls[i], balls_[i], time_s, total);
    }
    return total;
  }

  /// Bounces add nothing that shows: listed ones, at most 10^6, and folded ones, at most 2^40 laps, each add
  /// a pair's rounding of the way, 2^-100 or so; those of a series come from one formula. Where a ball all
  /// but turns at a wall, the root of that rounding is ε, the largest that one bounce can add.
  double uncertainty_m() const override {
    double farthest = scale_m(scenario_);
    for (const Axes& axes : balls_) {
      for (const AxisMotion& axis : axes) {
        farthest = std::max({farthest, -axis.range().low_m.hi, axis.range().high_m.hi});
      }
    }
    return rounding_bound_m(scenario_, farthest);
  }

 private:
  /// Only gravity and walls change a ball's momentum m v and angular momentum m x × v, so the walls gave
  ///
  ///   J = m (v(t) - v(0) - a t),    ∫ x × dJ = m (x × v |₀ᵗ - (∫ x dt) × a)
  ///
  /// which is exact over any number of bounces, and counts the push on a ball at rest. A frictionless wall
  /// pushes along the line through the centre, so that the moment at the contact is that at the centre.
  void add_walls(const Ball& ball, const Axes& axes, const Twofold& time_s, Tally& total) const {
    Vec3Twofold x;
    Vec3Twofold v;
    Vec3Twofold area;
    for (int axis = 0; axis < kAxes; ++axis) {
      const AxisState state = axes[static_cast<std::size_t>(axis)].at(time_s);
      x[axis] = state.position_m;
      v[axis] = state.velocity_mps;
      area[axis] = state.area_ms;
      total.impacts += state.bounces;
    }
    const Vec3Twofold a = widened(acceleration_of(ball, scenario_.effects));
    const Vec3Twofold start_x = widened(ball.position);
    const Vec3Twofold start_v = widened(ball.velocity);
    const Twofold m = ball.mass;
    total.external_impulse += rounded((v - start_v - a * time_s) * m);
    total.external_angular_impulse += rounded((x.cross(v) - start_x.cross(start_v) - area.cross(a)) * m);
  }

  const Scenario& scenario_;
  std::vector<Axes> balls_;
};

/// Whether no two balls can meet: the boxes that two centres stay in are apart, along some axis, by the sum
/// of their radii. A sweep along x spares most pairs.
bool never_meet(const Scenario& scenario, const std::vector<Axes>& balls, double touch) {
  const auto apart = [&](std::size_t i, std::size_t j, std::size_t axis) {
    const Twofold reach = exact_sum(scenario.balls[i].radius, scenario.balls[j].radius) - touch;
    const AxisRange a = balls[i][axis].range();
    const AxisRange b = balls[j][axis].range();
    return b.low_m - a.high_m >= reach || a.low_m - b.high_m >= reach;
  };
  const auto left_edge = [&](std::size_t i) {
    return balls[i][0].range().low_m.hi - scenario.balls[i].radius - touch;
  };
  const auto right_edge = [&](std::size_t i) {
    return balls[i][0].range().high_m.hi + scenario.balls[i].radius + touch;
  };
  std::vector<std::size_t> order(balls.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return left_edge(i) < left_edge(j); });
  for (std::size_t p = 0; p < order.size(); ++p) {
    for (std::size_t q = p + 1; q < order.size() && left_edge(order[q]) <= right_edge(order[p]); ++q) {
      const std::size_t i = order[p];
      const std::size_t j = order[q];
      if (!apart(i, j, 0) && !apart(i, j, 1) && !apart(i, j, 2)) return false;
    }
  }
  return true;
}

/// Why a ball that meets no other is beyond this family; empty where it is not.
std::string refusal(const Scenario& scenario, std::size_t index, const Axes& axes, double touch) {
  const Ball& ball = scenario.balls[index];
  if (touches_wall(axes)) {
    if (is_immovable(ball)) return fmt::format("ball {} is immovable and reaches a wall", index);
    if (scenario.wall_contact.friction > 0.0) return fmt::format("ball {} reaches a rough wall", index);
  }
  for (const Wall& wall : scenario.walls) {
    if (!axis_of(wall) && !stays_clear(wall, ball, axes, touch)) {
      return fmt::format("ball {} can reach a wall that is not across an axis", index);
    }
  }
  return {};
}

}  // namespace

Attempt try_separable(const Scenario& scenario) {
  if (has_drag(scenario) || has_magnus(scenario)) return {};
  std::vector<Axes> balls;
  balls.reserve(scenario.balls.size());
  const double touch = touch_m(scenario);
  for (std::size_t i = 0; i < scenario.balls.size(); ++i) {
    const auto along = [&](int axis) { return axis_motion(scenario, scenario.balls[i], axis, touch); };
    balls.push_back({along(0), along(1), along(2)});
    for (const AxisMotion& axis : balls.back()) {
      if (!axis.complete()) return {nullptr, fmt::format("ball {} bounces more than a million times", i)};
    }
  }
  if (scenario.effects.collisions && balls.size() > 1 && !never_meet(scenario, balls, touch)) return {};
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const std::string reason = refusal(scenario, i, balls[i], touch);
    if (!reason.empty()) return {nullptr, reason};
  }
  return {std::make_unique<SeparableMotion>(scenario, std::move(balls)), {}};
}

}  // namespace carom::closed_form
