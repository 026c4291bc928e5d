#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "reference/closed_form/motion.h"
#include "reference/closed_form/scene_facts.h"
#include "reference/closed_form/wall_story.h"

namespace carom::closed_form {

namespace {

class RoughWallMotion final : public Motion {
 public:
  RoughWallMotion(const Scenario& scenario, std::vector<WallStory> stories)
      : scenario_(scenario), stories_(std::move(stories)) {}

  std::string_view family() const override { return "a rough wall"; }

  void evaluate(const Twofold& time_s, std::span<BallState> balls) const override {
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const Stretch now = stories_[i].at(time_s);
      balls[i] = {rounded(now.position_m), rounded(now.velocity_mps), rounded(now.spin_radps)};
    }
  }

  Tally tally(const Twofold& time_s) const override {
    Tally total;
    for (std::size_t i = 0; i < stories_.size(); ++i) {
      if (stories_[i].wall()) add_wall(scenario_.balls[i], stories_[i], time_s, total);
    }
    return total;
  }

  /// What counts as zero at 4 ε adds as much of the way, once each: a velocity off the wall, a slip, gravity
  /// along the wall, and slip across gravity. As the way counts what the fastest point of a surface could go,
  /// and no acceleration lasts longer than it takes to reach that speed, the bounces that are left out, 2^-60
  /// of the time, and the pairs' own rounding do not show beside it.
  double uncertainty_m() const override {
    constexpr double kRoundings = 4.0 * 4.0;
    double farthest = scale_m(scenario_);
    double way = 0.0;
    for (const WallStory& story : stories_) {
      farthest = std::max(farthest, story.farthest_m());
      if (story.wall()) way = std::max(way, story.fastest_mps() * scenario_.duration_s);
    }
    return kRoundings * kEpsilon * way + rounding_bound_m(scenario_, farthest);
  }

 private:
  /// As only gravity and the wall change a ball's momentum m v, its angular momentum m x × v and its spin,
  /// the wall gave, at the contact x - r n,
  ///
  ///   J = m (v(t) - v(0) - g t),    ∫ (x - r n) × dJ = m (x × v |₀ᵗ - (∫ x dt) × g) - r n × J
  void add_wall(const Ball& ball, const WallStory& story, const Twofold& time_s, Tally& total) const {
    const Stretch now = story.at(time_s);
    const Vec3Twofold g = widened(acceleration_of(ball, scenario_.effects));
    const Vec3Twofold x = widened(ball.position);
    const Vec3Twofold v = widened(ball.velocity);
    const Twofold m = ball.mass;
    const Vec3Twofold push = (now.velocity_mps - v - g * time_s) * m;
    const Vec3Twofold turned =
        (now.position_m.cross(now.velocity_mps) - x.cross(v) - now.area_ms.cross(g)) * m;
    total.impacts += now.impacts;
    total.external_impulse += rounded(push);
    total.external_angular_impulse += rounded(turned - story.normal().cross(push) * Twofold(ball.radius));
  }

  const Scenario& scenario_;
  std::vector<WallStory> stories_;
};

}  // namespace

Attempt try_rough_wall(const Scenario& scenario) {
  const bool meet = scenario.effects.collisions && scenario.balls.size() > 1;
  if (scenario.wall_contact.friction == 0.0 || meet || has_drag(scenario) || has_magnus(scenario)) return {};
  std::vector<WallStory> stories;
  stories.reserve(scenario.balls.size());
  for (std::size_t i = 0; i < scenario.balls.size(); ++i) {
    WallStory& story = stories.emplace_back(scenario, scenario.balls[i]);
    const std::string reason = story.follow();
    if (!reason.empty()) return {nullptr, fmt::format("ball {} is on a rough wall, and {}", i, reason)};
    if (story.wall() && is_immovable(scenario.balls[i])) {
      return {nullptr, fmt::format("ball {} is immovable and reaches a wall", i)};
    }
    if (story.overlaps_another()) return {nullptr, fmt::format("ball {} reaches two rough walls", i)};
  }
  return {std::make_unique<RoughWallMotion>(scenario, std::move(stories)), {}};
}

}  // namespace carom::closed_form
