#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "reference/exact/run.h"

// What a run does where impacts come together.

namespace carom::exact {

/// What the scene's numbers leave open of a distance by now, m. They are decimals that were rounded to
/// doubles: the places and the radii of two balls, ε/2 of the scale each, and their velocities, ε/2 of the
/// speed each over the time since; twice that.
double Run::rounding_m() const {
  return 4.0 * kEpsilon * (setting_.scale_m + shadow_.top_speed_mps() * now_s_.convert_to<double>());
}

Real Run::gap_m(const Touch& touch, const Body& ball) const {
  const Real& radius = setting_.matter[touch.ball].radius_m;
  if (touch.wall) {
    const Plane& wall = setting_.walls[touch.partner];
    return dot(ball.position_m, wall.normal) - wall.offset_m - radius;
  }
  const Vector place = setting_.position(touch.partner, bodies_[touch.partner], now_s_);
  return length(place - ball.position_m) - radius - setting_.matter[touch.partner].radius_m;
}

/// Adds the contacts of a ball of the cluster, and the balls that they bring in.
void Run::add_touches(std::uint32_t ball, const Real& gap, Cluster& cluster) {
  shadow_.near(ball, gap.convert_to<double>(), prospects_);
  budget_.left -= static_cast<std::int64_t>(bodies_.size());
  for (const Prospect& prospect : prospects_) {
    const Touch touch{ball, prospect.partner, prospect.wall};
    const Touch turned{prospect.partner, ball, false};
    const auto known = [&](const Touch& t) { return t == touch || (!touch.wall && t == turned); };
    if (std::any_of(cluster.touches.begin(), cluster.touches.end(), known)) continue;
    if (gap_m(touch, cluster.bodies.at(ball)) > gap) continue;
    cluster.touches.push_back(touch);
    if (touch.wall) continue;
    cluster.bodies.try_emplace(touch.partner, setting_.moved(touch.partner, bodies_[touch.partner], now_s_));
  }
}

Cluster Run::cluster_of(const Touch& touch) {
  Cluster cluster;
  cluster.touches.push_back(touch);
  cluster.bodies.emplace(touch.ball, setting_.moved(touch.ball, bodies_[touch.ball], now_s_));
  if (!touch.wall) {
    cluster.bodies.emplace(touch.partner, setting_.moved(touch.partner, bodies_[touch.partner], now_s_));
  }
  const Real gap = rounding_m();
  std::set<std::uint32_t> done;
  while (done.size() < cluster.bodies.size()) {
    const auto next = std::find_if(cluster.bodies.begin(), cluster.bodies.end(),
                                   [&](const auto& entry) { return !done.contains(entry.first); });
    done.insert(next->first);
    add_touches(next->first, gap, cluster);
  }
  return cluster;
}

/// Whether bodies that touch have hardly moved relative to each other since the last impact of one of them:
/// then they meet infinitely often in finite time, and not by chance at one moment. In such a series the way
/// between two impacts shrinks by a factor, to some hundredths at least; so the last way before the bodies
/// touch, by rounding, is at most some hundred roundings. Ten thousand are still nothing. (Bodies that go on
/// side by side do not meet at all.)
bool Run::piles_up(const Cluster& cluster) const {
  return std::any_of(cluster.touches.begin(), cluster.touches.end(), [&](const Touch& touch) {
    const Body& ball = bodies_[touch.ball];
    const Real last_s = touch.wall ? ball.time_s : std::max(ball.time_s, bodies_[touch.partner].time_s);
    if (last_s == 0 || now_s_ - last_s <= instant_s_) return false;
    Vector velocity = cluster.bodies.at(touch.ball).velocity_mps;
    if (!touch.wall) velocity -= cluster.bodies.at(touch.partner).velocity_mps;
    const Real speed = length(velocity);
    return speed > slack_.speed_mps && speed * Real(now_s_ - last_s) <= 1e4 * rounding_m();
  });
}

/// Whether an impact that is due has one outcome; if not, stops.
bool Run::goes_on(const Touch& touch) {
  const Cluster cluster = cluster_of(touch);
  if (cluster.touches.size() == 1) return true;
  // Outcomes that should be the same differ by the rounding of the scene's numbers, as the contacts' gaps do.
  const Real tolerance = 16.0 * kEpsilon * setting_.speed_mps;
  const Order order = judge(setting_, scene_, cluster, slack_, tolerance);
  if (order == Order::single) return true;
  std::vector<std::uint32_t> balls;
  for (const auto& [ball, body] : cluster.bodies) balls.push_back(ball);
  tell_tie(balls, true);
  if (order == Order::irrelevant) return true;
  const std::string who = balls.size() == 1 ? fmt::format("ball {} and walls", balls.front())
                                            : fmt::format("balls {}", fmt::join(balls, ", "));
  if (piles_up(cluster)) {
    stop_at(now_s_, fmt::format("impacts of {} follow each other ever faster, and pile up here", who));
  } else if (order == Order::matters) {
    stop_at(now_s_,
            fmt::format("impacts of {} come at one moment, and what follows depends on their order", who));
  } else {
    stop_at(now_s_,
            fmt::format("{} touch when one of them is hit, and how an impact is passed on along touching "
                        "bodies has no unique answer",
                        who));
  }
  return false;
}

/// An impact at the moment of the last one, of other balls: whichever is first, the other is as it would be.
void Run::tell_tie_apart(const Touch& touch, const Real& approach) {
  if (impacts_.empty()) return;
  const TrueImpact& last = impacts_.back();
  if (Real(now_s_ - last.time_s) * approach > rounding_m()) return;
  std::vector<std::uint32_t> before = {last.ball};
  if (!last.wall) before.push_back(last.partner);
  std::vector<std::uint32_t> balls = {touch.ball};
  if (!touch.wall) balls.push_back(touch.partner);
  const auto shared = std::find_first_of(before.begin(), before.end(), balls.begin(), balls.end());
  if (shared != before.end()) return;
  balls.insert(balls.end(), before.begin(), before.end());
  tell_tie(std::move(balls), false);
}

/// Adds to the last tie where that was at the same moment.
void Run::tell_tie(std::vector<std::uint32_t> balls, bool shares_ball) {
  const double time_s = now_s_.convert_to<double>();
  const bool more = !ties_.empty() && now_s_ - ties_.back().time_s <= instant_s_ + kEpsilon * time_s;
  if (more) {
    Tie& tie = ties_.back();
    tie.shares_ball = tie.shares_ball || shares_ball;
    balls.insert(balls.end(), tie.balls.begin(), tie.balls.end());
  }
  std::sort(balls.begin(), balls.end());
  balls.erase(std::unique(balls.begin(), balls.end()), balls.end());
  if (more) {
    ties_.back().balls = std::move(balls);
  } else if (ties_.size() < Solution::kMostTiesTold) {
    ties_.push_back({time_s, std::move(balls), shares_ball});
  }
}

}  // namespace carom::exact
