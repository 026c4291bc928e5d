#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "reference/closed_form/chain.h"
#include "reference/closed_form/motion.h"
#include "reference/closed_form/scene_facts.h"
#include "reference/closed_form/timeline.h"

namespace carom::closed_form {

namespace {

/// The line that all centres are on: x = origin + s direction.
struct Line {
  Vec3Twofold origin_m;
  Vec3Twofold direction;
  double offline_m = 0.0;  ///< how far off it rounding lets a centre get within the duration, by free flight
  double tilt = 0.0;       ///< by which rounding lets a wall lean, radians

  Twofold coordinate_m(const Vec3& place) const { return direction.dot(widened(place) - origin_m); }
};

/// The sine of the angle between a wall's normal and the line.
double tilt_of(const Wall& wall, const Line& line) {
  return length(widened(wall.normal).cross(line.direction)).hi;
}

/// Which way a wall across the line faces, +1 or -1 along it; none where it is not across, by rounding.
std::optional<double> facing(const Wall& wall, const Line& line) {
  constexpr double kRoundings = 4.0;
  if (tilt_of(wall, line) > kRoundings * kEpsilon) return std::nullopt;
  return widened(wall.normal).dot(line.direction) > 0.0 ? 1.0 : -1.0;
}

/// The line through the centres, or the path of one that is alone; none where a centre or a velocity is off
/// it by more than rounding: the numbers of a vector are off by ½ ε each and so its direction by less than ε;
/// a difference of two vectors by 2 ε of the larger, and twice that against a line that is off likewise.
std::optional<Line> line_of(const Scenario& scenario) {
  constexpr double kRoundings = 4.0;
  const std::vector<Ball>& balls = scenario.balls;
  Line line{widened(balls.front().position), widened(balls.front().velocity)};
  for (const Ball& ball : balls) {
    const Vec3Twofold away = widened(ball.position) - line.origin_m;
    const bool first = &ball == &balls.front();
    const bool second = &ball == &balls.front() + 1;
    if (second || (!first && length(away) > length(line.direction))) line.direction = away;
  }
  if (length(line.direction) == 0.0) return std::nullopt;
  line.direction = line.direction / length(line.direction);
  const double place_tolerance = kRoundings * kEpsilon * scale_m(scenario);
  for (const Ball& ball : balls) {
    const Vec3Twofold away = widened(ball.position) - line.origin_m;
    const double off_m = length(line.direction.cross(away)).hi;
    const double off_mps = length(line.direction.cross(widened(ball.velocity))).hi;
    const double speed_tolerance = kRoundings * kEpsilon * ball.velocity.norm();
    if (off_m > place_tolerance || off_mps > speed_tolerance) return std::nullopt;
    line.offline_m = std::max(line.offline_m, off_m + off_mps * scenario.duration_s);
  }
  for (const Wall& wall : scenario.walls) {
    if (facing(wall, line)) line.tilt = std::max(line.tilt, tilt_of(wall, line));
  }
  return line;
}

/// The bodies in their order along the line, with the nearest wall at either end.
std::vector<Body> bodies_on(const Line& line, const Scenario& scenario) {
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < scenario.balls.size(); ++i) {
    const Ball& ball = scenario.balls[i];
    const Leg leg{0.0, line.coordinate_m(ball.position), line.direction.dot(widened(ball.velocity))};
    bodies.push_back({ball.mass, ball.radius, i, {leg}});
  }
  std::sort(bodies.begin(), bodies.end(), [](const Body& a, const Body& b) {
    return a.legs.front().position_m < b.legs.front().position_m;
  });
  std::optional<Twofold> low_m;
  std::optional<Twofold> high_m;
  for (const Wall& wall : scenario.walls) {
    const std::optional<double> face = facing(wall, line);
    if (!face) continue;
    const Twofold place = (Twofold(wall.offset) - widened(wall.normal).dot(line.origin_m)) * *face;
    if (*face > 0.0) {
      low_m = low_m ? std::max(*low_m, place) : place;
    } else {
      high_m = high_m ? std::min(*high_m, place) : place;
    }
  }
  Body wall;
  wall.legs.resize(1);
  if (low_m) {
    wall.legs.front().position_m = *low_m;
    bodies.insert(bodies.begin(), wall);
  }
  if (high_m) {
    wall.legs.front().position_m = *high_m;
    bodies.push_back(wall);
  }
  return bodies;
}

class LineMotion final : public Motion {
 public:
  LineMotion(const Scenario& scenario, Line line, Chain chain)
      : scenario_(scenario), line_(std::move(line)), chain_(std::move(chain)) {}

  std::string_view family() const override { return "balls on a line"; }

  /// A centre keeps what it is off the line by.
  void evaluate(const Twofold& time_s, std::span<BallState> balls) const override {
    for (const Body& body : chain_.bodies()) {
      if (!body.ball) continue;
      const Leg& leg = stretch_at(body.legs, time_s);
      const Twofold moved = leg.position_at(time_s) - body.legs.front().position_m;
      const Vec3Twofold start = widened(scenario_.balls[*body.ball].position);
      balls[*body.ball].position = rounded(start + line_.direction * moved);
      balls[*body.ball].velocity = rounded(line_.direction * leg.velocity_mps);
    }
  }

  /// Every push acts along the line, and so has the moment origin × J.
  Tally tally(const Twofold& time_s) const override {
    const std::vector<Impact>& all = chain_.impacts();
    const auto after = std::upper_bound(all.begin(), all.end(), time_s,
                                        [](const Twofold& t, const Impact& i) { return t < i.time_s; });
    Tally total;
    if (after == all.begin()) return total;
    total.impacts = after - all.begin();
    const Vec3Twofold push = line_.direction * std::prev(after)->external_Ns;
    total.external_impulse = rounded(push);
    total.external_angular_impulse = rounded(line_.origin_m.cross(push));
    return total;
  }

  double uncertainty_m() const override {
    return rounding_bound_m(scenario_, farthest_m()) + growth_m() + offline_growth_m();
  }

  /// With coordinates scaled by √m the balls on a line are one billiard point between flat mirrors. A mirror
  /// with e <= 1 never lengthens a distance between two paths, so that the errors of n impacts only add up;
  /// going back to single coordinates costs √(m_max/m_min). Each impact rounds about 16 times (the position,
  /// the time, and twice the velocity, each of a few operations), and a velocity's error acts for the whole
  /// duration.
  double growth_m() const {
    constexpr double kRoundings = 16.0;
    double heaviest = 0.0;
    double lightest = std::numeric_limits<double>::infinity();
    for (const Body& body : chain_.bodies()) {
      if (body.immovable()) continue;
      heaviest = std::max(heaviest, body.mass_kg);
      lightest = std::min(lightest, body.mass_kg);
    }
    if (heaviest == 0.0) return 0.0;
    return kRoundings * kTwofoldUnit * std::sqrt(heaviest / lightest) * impact_count() *
           (farthest_m() + fastest_mps() * scenario_.duration_s);
  }

  /// Two balls that are off the line by δ, to either side, meet at a slope 2 δ/R, R the sum of their radii.
  /// An impact at the relative speed w <= 2 v then adds at most (1 + e) w 2 δ/R <= 8 v δ/R of velocity across
  /// the line, so that n impacts in the time T make δ (1 + 8 v T/R)^n of it. Before, δ is what free flight
  /// makes and what walls that lean by α make, which turn a velocity by 2 α. Exactly 0 along an axis.
  double offline_growth_m() const {
    const double way = fastest_mps() * scenario_.duration_s;
    const double offline = line_.offline_m + 2.0 * line_.tilt * way * impact_count();
    if (offline == 0.0) return 0.0;
    double reach = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < chain_.bodies().size(); ++i) {
      const Body& a = chain_.bodies()[i];
      const Body& b = chain_.bodies()[i + 1];
      if (a.ball && b.ball) reach = std::min(reach, a.radius_m + b.radius_m);
    }
    return offline * std::pow(1.0 + 8.0 * way / reach, impact_count());
  }

  /// Whether a wall that is not across the line stays out of reach. Between impacts the balls move uniformly,
  /// so the ends of the legs decide.
  bool reaches(const Wall& wall) const {
    if (facing(wall, line_)) return false;
    const double touch = touch_m(scenario_);
    for (const Body& body : chain_.bodies()) {
      if (!body.ball) continue;
      const Vec3Twofold start = widened(scenario_.balls[*body.ball].position);
      const auto gap_at = [&](const Twofold& position_m) {
        const Twofold moved = position_m - body.legs.front().position_m;
        return gap_m(wall, body.radius_m, rounded(start + line_.direction * moved));
      };
      if (gap_at(body.legs.back().position_at(horizon_s(scenario_))) < -touch) return true;
      for (const Leg& leg : body.legs) {
        if (gap_at(leg.position_m) < -touch) return true;
      }
    }
    return false;
  }

 private:
  /// The largest coordinate that a centre comes to.
  double farthest_m() const {
    double farthest = 0.0;
    for (const Body& body : chain_.bodies()) {
      for (const Leg& leg : body.legs) farthest = std::max(farthest, std::abs(leg.position_m.hi));
      const Twofold end = body.legs.back().position_at(horizon_s(scenario_));
      farthest = std::max(farthest, std::abs(end.hi));
    }
    return farthest + length(line_.origin_m).hi;
  }

  double fastest_mps() const {
    double fastest = 0.0;
    for (const Body& body : chain_.bodies()) {
      for (const Leg& leg : body.legs) fastest = std::max(fastest, std::abs(leg.velocity_mps.hi));
    }
    return fastest;
  }

  double impact_count() const { return static_cast<double>(chain_.impacts().size()); }

  const Scenario& scenario_;
  Line line_;
  Chain chain_;
};

}  // namespace

Attempt try_line(const Scenario& scenario) {
  const bool accelerated = std::any_of(scenario.balls.begin(), scenario.balls.end(), [&](const Ball& ball) {
    return !acceleration_of(ball, scenario.effects).isZero(0.0);
  });
  if (scenario.balls.empty() || !scenario.effects.collisions) return {};
  if (accelerated || has_drag(scenario) || has_magnus(scenario)) return {};
  const std::optional<Line> line = line_of(scenario);
  if (!line) return {};
  Chain chain(scenario, bodies_on(*line, scenario));
  std::string reason = chain.follow();
  if (!reason.empty()) return {nullptr, reason};
  auto motion = std::make_unique<LineMotion>(scenario, *line, std::move(chain));
  for (const Wall& wall : scenario.walls) {
    if (motion->reaches(wall)) return {nullptr, "balls on a line reach a wall that is not across it"};
  }
  const double offline_m = motion->offline_growth_m();
  if (offline_m > std::sqrt(kEpsilon) * scale_m(scenario)) {
    return {nullptr, "balls on a slanted line, whose impacts magnify the rounding of their places"};
  }
  return {std::move(motion), {}};
}

}  // namespace carom::closed_form
