#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/engine.h"
#include "reference/common/scene_scale.h"

namespace carom::reference {

/// One push of a contact on one ball, read from the engine after it solved the step.
struct Push {
  Vec3 impulse = Vec3::Zero();  ///< N s, on the ball
  Vec3 point = Vec3::Zero();    ///< m, where it acts, in the scene's frame
};

/// Adds up what an engine's contacts did, step by step.
///
/// An engine keeps a contact alive for as long as the shapes touch, which may be many steps. An impact is a
/// contact that pushes in a step and did not push in the step before; so a bounce counts once although the
/// balls still overlap in the next step, and a ball that bounces again without having come free counts again.
/// A push that only holds against gravity is no impact, nor is one below the engine's rounding.
class Account {
 public:
  Account(const Scenario& scene, double epsilon)
      : balls_(scene.balls.size()),
        gravity_mps2_(scene.effects.gravity.value_or(Vec3::Zero()).norm()),
        rounding_mps_(kRoundings * epsilon * expected_top_speed_mps(scene)) {}

  /// Opens a step of this length.
  void begin_step(double step_s) { resting_mps_ = kRestingSteps * gravity_mps2_ * step_s; }

  /// Two bodies pushed each other apart in this step: by number, the balls first and then the walls.
  /// @param speed_change_mps  of their approach: the normal impulse over the pair's reduced mass
  void contact(std::uint32_t a, std::uint32_t b, double speed_change_mps) {
    if (speed_change_mps <= rounding_mps_) return;
    const std::uint64_t pair = std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
    pushing_.push_back(pair);
    if (speed_change_mps > rounding_mps_ + resting_mps_) hitting_.push_back(pair);
  }

  /// A wall pushed a ball along its normal, N s, as part of what external() is told.
  void wall(double push_Ns) { tally_.wall_push_Ns += push_Ns; }

  /// A wall or an immovable ball pushed a movable ball.
  void external(const Push& push) {
    tally_.external_impulse += push.impulse;
    tally_.external_angular_impulse += push.point.cross(push.impulse);
  }

  /// Closes the step: counts the contacts that hit now and did not push before.
  void end_step() {
    sort_unique(pushing_);
    sort_unique(hitting_);
    for (const std::uint64_t pair : hitting_) {
      if (std::binary_search(pushed_before_.begin(), pushed_before_.end(), pair)) continue;
      ++tally_.impacts;
      if (is_wall(static_cast<std::uint32_t>(pair))) ++tally_.wall_impacts;
    }
    std::swap(pushing_, pushed_before_);
    pushing_.clear();
    hitting_.clear();
  }

  const Tally& tally() const { return tally_; }
  bool is_wall(std::uint32_t body) const { return body >= balls_; }

 private:
  static void sort_unique(std::vector<std::uint64_t>& pairs) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  }

  // An impulse changes speeds by a rounding or two in each of the iterations that move it; changes smaller
  // than this many roundings of the scene's top speed are noise.
  static constexpr double kRoundings = 16.0;
  // At rest gravity adds g h to the approach in a step. An engine that takes that for an impact at e = 1
  // turns it round, 2 g h, and the ball is back at most one step later with what two steps add, 2 · 2 g h.
  static constexpr double kRestingSteps = 4.0;

  std::size_t balls_;
  double gravity_mps2_;
  double rounding_mps_;
  double resting_mps_ = 0.0;                  // what a push against gravity can change in a step
  std::vector<std::uint64_t> pushing_;        // pairs of this step
  std::vector<std::uint64_t> hitting_;        // those of them that push harder than gravity
  std::vector<std::uint64_t> pushed_before_;  // pairs of the step before, sorted
  Tally tally_ = {.walls_known = true};
};

}  // namespace carom::reference
