#include "reference/exact/shadow.h"

#include <algorithm>
#include <cmath>

namespace carom::exact {

namespace {

/// The time to come nearer by `way_m`, falling with `fall` towards each other at first at `speed`: the root
/// of speed t + ½ fall t² = way, in the form in which nothing cancels.
double least_time_s(double way_m, double speed_mps, double fall_mps2) {
  if (way_m <= 0.0) return 0.0;
  const double root = speed_mps + std::sqrt(speed_mps * speed_mps + 2.0 * fall_mps2 * way_m);
  return root > 0.0 ? 2.0 * way_m / root : kNever;
}

}  // namespace

Shadow::Shadow(const Scenario& scene, const Setting& setting, double end_s)
    : gravity_mps2_(scene.effects.gravity.value_or(Vec3::Zero())),
      gravity_(setting.gravity),
      walls_(scene.walls),
      balls_(scene.balls.size()),
      now_m_(scene.balls.size()),
      now_mps_(scene.balls.size()),
      meet_(scene.effects.collisions),
      end_s_(end_s) {
  for (const carom::Ball& ball : scene.balls) {
    middle_m_ += ball.position / static_cast<double>(scene.balls.size());
  }
  for (Wall& wall : walls_) {
    wall.offset -= wall.normal.dot(middle_m_);
    largest_m_ = std::max(largest_m_, std::abs(wall.offset));
  }
  // Moving a plane to the middle rounds at the scale of the scene, not of the distances from the middle.
  largest_m_ = std::max(largest_m_, setting.walls.empty() ? 0.0 : setting.scale_m);
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    balls_[i].movable = setting.matter[i].movable();
    balls_[i].radius_m = scene.balls[i].radius;
    largest_m_ = std::max(largest_m_, scene.balls[i].radius);
  }
}

void Shadow::set(std::size_t ball, const Body& body) {
  Ball& own = balls_[ball];
  own.since_s = body.time_s.convert_to<double>();
  own.start_m = rounded(body.position_m - Vector(middle_m_));
  own.start_mps = rounded(body.velocity_mps);
  largest_m_ = std::max(largest_m_, own.start_m.cwiseAbs().maxCoeff());
  top_speed_mps_ = std::max(top_speed_mps_, own.start_mps.norm() + gravity_mps2_.norm() * end_s_);
}

void Shadow::advance(double now_s) {
  now_s_ = now_s;
  for (std::size_t i = 0; i < balls_.size(); ++i) catch_up(i);
}

void Shadow::catch_up(std::size_t ball) {
  const Ball& own = balls_[ball];
  const double t = now_s_ - own.since_s;
  now_m_[ball] = own.start_m + own.start_mps * t;
  now_mps_[ball] = own.start_mps;
  if (!gravity_ || !own.movable) return;
  now_m_[ball] += gravity_mps2_ * (0.5 * t * t);
  now_mps_[ball] += gravity_mps2_ * t;
}

double Shadow::error_m() const {
  return 32.0 * kEpsilon * (largest_m_ + (top_speed_mps_ + gravity_mps2_.norm() * end_s_) * end_s_);
}

double Shadow::before(double wait_s) const {
  return now_s_ + (1.0 - 1e-9) * wait_s - 4.0 * kEpsilon * end_s_;
}

double Shadow::pair_earliest_s(std::size_t a, std::size_t b, double error) const {
  const Vec3 d = now_m_[b] - now_m_[a];
  const Vec3 v = now_mps_[b] - now_mps_[a];
  const double reach = balls_[a].radius_m + balls_[b].radius_m + error;
  const double f = (1.0 - 1e-10) * d.squaredNorm() - reach * reach;
  if (f <= 0.0) return before(0.0);
  if (gravity_ && balls_[a].movable != balls_[b].movable) {
    const double way = std::sqrt(f + reach * reach) - reach;
    return before(least_time_s(way, v.norm(), gravity_mps2_.norm()));
  }
  const double approach = -d.dot(v);
  if (approach <= 0.0) return kNever;
  const double square = approach * approach - v.squaredNorm() * f;
  if (square < 0.0) return kNever;
  return before(f / (approach + std::sqrt(square)));
}

double Shadow::wall_gap_m(std::size_t ball, const Wall& wall) const {
  return wall.normal.dot(now_m_[ball]) - wall.offset - balls_[ball].radius_m - error_m();
}

double Shadow::wall_earliest_s(std::size_t ball, const Wall& wall) const {
  const double speed = std::max(0.0, -wall.normal.dot(now_mps_[ball]));
  const double fall = std::max(0.0, -wall.normal.dot(gravity_mps2_));
  return before(least_time_s(wall_gap_m(ball, wall), speed, fall));
}

void Shadow::prospects(std::size_t ball, std::vector<Prospect>& found) const {
  found.clear();
  const bool movable = balls_[ball].movable;
  const double error = error_m();
  const auto add = [&](double earliest_s, std::size_t partner, bool wall) {
    if (earliest_s <= end_s_) found.push_back({earliest_s, static_cast<std::uint32_t>(partner), wall});
  };
  for (std::size_t k = 0; meet_ && k < balls_.size(); ++k) {
    if (k != ball && (movable || balls_[k].movable)) add(pair_earliest_s(ball, k, error), k, false);
  }
  for (std::size_t k = 0; movable && k < walls_.size(); ++k) add(wall_earliest_s(ball, walls_[k]), k, true);
}

void Shadow::near(std::size_t ball, double gap_m, std::vector<Prospect>& found) const {
  found.clear();
  const bool movable = balls_[ball].movable;
  const double wider = balls_[ball].radius_m + error_m() + gap_m;
  for (std::size_t k = 0; meet_ && k < balls_.size(); ++k) {
    if (k == ball || (!movable && !balls_[k].movable)) continue;
    const double reach = wider + balls_[k].radius_m;
    if ((1.0 - 1e-10) * (now_m_[k] - now_m_[ball]).squaredNorm() <= reach * reach) {
      found.push_back({now_s_, static_cast<std::uint32_t>(k), false});
    }
  }
  for (std::size_t k = 0; movable && k < walls_.size(); ++k) {
    if (wall_gap_m(ball, walls_[k]) <= gap_m) {
      found.push_back({now_s_, static_cast<std::uint32_t>(k), true});
    }
  }
}

}  // namespace carom::exact
