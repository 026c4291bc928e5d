#include "reference/closed_form/wall_story.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "reference/closed_form/accelerated.h"
#include "reference/closed_form/friction.h"
#include "reference/closed_form/scene_facts.h"

namespace carom::closed_form {

namespace {

/// More stretches than this are not listed: at 312 bytes each the list then takes 31 MB.
constexpr std::size_t kMostStretches = 100'000;

/// A difference of two numbers as an author writes them, each a product of two doubles and so off by 2 ε of
/// itself, can be anything up to this share of them and mean zero.
constexpr double kWrittenZero = 4.0 * kEpsilon;

/// Bounces that together take less than this share of the horizon are left out.
constexpr double kShortestRest = 0x1p-60;

bool is_written_zero(const Vec3Twofold& difference, const Twofold& scale) {
  return length(difference) <= scale * kWrittenZero;
}

Vec3Twofold unit(const Vec3Twofold& v) {
  return v / length(v);
}

/// How far a ball is above a wall. In the direction of the normal, whose length is 1 but for its rounding.
Twofold height_m(const Wall& wall, const Ball& ball, const Vec3Twofold& position_m) {
  const Vec3Twofold normal = widened(wall.normal);
  return (normal.dot(position_m) - exact_sum(wall.offset, ball.radius)) / length(normal);
}

}  // namespace

Stretch Stretch::from(const Twofold& time_s) const {
  const Twofold t = time_s - start_s;
  const Twofold half = t * 0.5;
  Stretch later = *this;
  later.start_s = time_s;
  later.position_m += (velocity_mps + acceleration_mps2 * half) * t;
  later.velocity_mps += acceleration_mps2 * t;
  later.spin_radps += spin_rate_radps2 * t;
  later.area_ms += (position_m + (velocity_mps + acceleration_mps2 * (t / 3.0)) * half) * t;
  return later;
}

WallStory::WallStory(const Scenario& scenario, const Ball& ball)
    : scenario_(scenario), ball_(ball), horizon_s_(horizon_s(scenario)) {
  now_.position_m = widened(ball.position);
  now_.velocity_mps = widened(ball.velocity);
  now_.spin_radps = widened(ball.spin);
  find_wall();
  if (!wall_) return;
  const Vec3Twofold g = widened(acceleration_of(ball, scenario.effects));
  normal_ = unit(widened(wall_->normal));
  pressing_mps2_ = -normal_.dot(g);
  const Vec3Twofold along = along_wall(g);
  if (!is_written_zero(along, length(g))) along_mps2_ = along;
  if (starts_lying_on(*wall_)) come_to_rest();
}

bool WallStory::starts_lying_on(const Wall& wall) const {
  const Vec3Twofold normal = unit(widened(wall.normal));
  const Twofold away = normal.dot(now_.velocity_mps);
  return abs(height_m(wall, ball_, now_.position_m)) <= touch_m(scenario_) &&
         abs(away) <= length(now_.velocity_mps) * kWrittenZero &&
         normal.dot(widened(acceleration_of(ball_, scenario_.effects))) < 0.0;
}

/// The wall that the ball lies on, or else the one that it flies to first.
void WallStory::find_wall() {
  std::optional<Twofold> first_s;
  for (const Wall& wall : scenario_.walls) {
    if (starts_lying_on(wall)) {
      wall_ = &wall;
      return;
    }
    const Vec3Twofold towards = -unit(widened(wall.normal));
    const auto hit = first_arrival(height_m(wall, ball_, now_.position_m), towards.dot(now_.velocity_mps),
                                   towards.dot(widened(acceleration_of(ball_, scenario_.effects))));
    if (!hit || hit->after_s > horizon_s_ || (first_s && *first_s <= hit->after_s)) continue;
    first_s = hit->after_s;
    wall_ = &wall;
  }
}

std::string WallStory::follow() {
  while (!ends_) {
    if (stretches_.size() > kMostStretches) {
      return fmt::format("it bounces more than {} times", kMostStretches);
    }
    if (!lying_) {
      fly();
      continue;
    }
    std::string reason = slide_or_roll();
    if (!reason.empty()) return reason;
  }
  return {};
}

/// (1) of the class.
Vec3Twofold WallStory::slip_mps() const {
  return along_wall(now_.velocity_mps) - now_.spin_radps.cross(normal_) * Twofold(ball_.radius);
}

/// A stretch that begins now, with (2) of the class for the spin; friction is a force per mass.
void WallStory::begin(const Vec3Twofold& acceleration_mps2, const Vec3Twofold& friction_mps2) {
  now_.acceleration_mps2 = acceleration_mps2;
  now_.spin_rate_radps2 = friction_mps2.cross(normal_) / exact_product(ball_.inertia, ball_.radius);
  stretches_.push_back(now_);
}

/// Ends the stretch after a time, or at the horizon.
void WallStory::end_after(const Twofold& time_s) {
  ends_ = now_.start_s + time_s > horizon_s_;
  if (!ends_) now_ = now_.from(now_.start_s + time_s);
}

void WallStory::fly() {
  begin(widened(acceleration_of(ball_, scenario_.effects)), Vec3Twofold::Zero());
  ends_ = wall_ == nullptr;
  if (ends_) return;
  const auto hit = first_arrival(height_m(*wall_, ball_, now_.position_m), -normal_.dot(now_.velocity_mps),
                                 pressing_mps2_);
  ends_ = !hit;
  if (ends_) return;
  end_after(hit->after_s);
  if (!ends_) bounce(hit->speed_mps);
}

/// An impact at the speed u, exactly at the wall: v_n' = e u, and friction_impulse() along the wall.
///
/// With e < 1 and g_n > 0 all bounces from here on end after R = 2 e u / (g_n (1 - e)). Where R is next to
/// nothing the ball comes to rest at once. What friction does in the time R is left out with it: no more than
/// μ g_n R of velocity.
void WallStory::bounce(const Twofold& u) {
  const Contact& contact = scenario_.wall_contact;
  const Twofold e = contact.restitution;
  const Ball of_one_kg = {.mass = 1.0, .inertia = ball_.inertia};
  const Vec3Twofold jump =
      friction_impulse(contact, slip_mps(), slip_per_impulse(of_one_kg), (Twofold(1.0) + e) * u);
  now_.position_m -= normal_ * height_m(*wall_, ball_, now_.position_m);
  now_.velocity_mps = along_wall(now_.velocity_mps) + jump + normal_ * (e * u);
  now_.spin_radps += jump.cross(normal_) / exact_product(ball_.inertia, ball_.radius);
  ++now_.impacts;
  const Twofold shortest_s = horizon_s_ * kShortestRest;
  if (pressing_mps2_ > 0.0 && e * u * 2.0 <= pressing_mps2_ * (Twofold(1.0) - e) * shortest_s) come_to_rest();
}

void WallStory::come_to_rest() {
  lying_ = true;
  now_.velocity_mps = along_wall(now_.velocity_mps);
}

/// A ball that lies on the wall slides as long as it slips. When it no longer does it rolls, or where the
/// wall is too steep for that, goes on sliding down.
///
/// Slip turns its direction only where gravity along the wall is not along it: that has no closed form here.
std::string WallStory::slide_or_roll() {
  const Vec3Twofold slip = slip_mps();
  const Twofold speed = length(now_.velocity_mps) + length(now_.spin_radps) * ball_.radius;
  if (is_written_zero(slip, speed)) {
    roll();
    return {};
  }
  const Vec3Twofold direction = unit(slip);
  if (!is_written_zero(direction.cross(along_mps2_), length(along_mps2_))) {
    return "it slides across the slope of a wall";
  }
  slide(direction, length(slip));
  return {};
}

/// Without slip friction is whatever keeps it so. By (2) of the class, with ds/dt = g_t + (1 + 1/κ) f/m = 0,
///
///   f/m = -g_t κ / (1 + κ),    dv/dt = g_t / (1 + κ),                                (3)
///
/// as long as |f| <= μ m g_n. Otherwise the ball starts to slide down the wall, and slips ever faster.
void WallStory::roll() {
  const Twofold kappa = ball_.inertia;
  const Vec3Twofold hold = along_mps2_ * (-kappa / (kappa + 1.0));
  if (length(hold) > pressing_mps2_ * scenario_.wall_contact.friction) {
    slide(unit(along_mps2_), 0.0);
    return;
  }
  begin(along_mps2_ + hold, hold);
  ends_ = true;
}

/// Sliding along a direction d, friction is f/m = -μ g_n d and the slip changes by (2) of the class:
///
///   ds/dt = g_t·d - (1 + 1/κ) μ g_n                                                  (4)
///
/// On a level floor a solid sphere without spin then slips for 2 v / (7 μ g), and rolls at 5 v / 7.
void WallStory::slide(const Vec3Twofold& direction, const Twofold& slip_mps) {
  const Vec3Twofold friction = direction * (-pressing_mps2_ * scenario_.wall_contact.friction);
  begin(along_mps2_ + friction, friction);
  const Twofold slowing = (Twofold(1.0) + Twofold(1.0) / ball_.inertia) * length(friction);
  const Twofold braking = slowing - along_mps2_.dot(direction);
  ends_ = braking <= 0.0;
  if (!ends_) end_after(slip_mps / braking);
}

Twofold WallStory::end_s(std::size_t stretch) const {
  return stretch + 1 < stretches_.size() ? stretches_[stretch + 1].start_s : horizon_s_;
}

bool WallStory::overlaps_another() const {
  return std::any_of(scenario_.walls.begin(), scenario_.walls.end(),
                     [this](const Wall& wall) { return &wall != wall_ && overlaps(wall); });
}

/// Each stretch is nearest to the wall at an end or where it turns.
bool WallStory::overlaps(const Wall& wall) const {
  const Vec3Twofold normal = widened(wall.normal);
  for (std::size_t k = 0; k < stretches_.size(); ++k) {
    const Stretch& stretch = stretches_[k];
    const Twofold turn =
        stretch.start_s + turn_s(normal.dot(stretch.velocity_mps), normal.dot(stretch.acceleration_mps2));
    for (const Twofold& t : std::array{stretch.start_s, std::min(turn, end_s(k)), end_s(k)}) {
      if (height_m(wall, ball_, stretch.from(t).position_m) < -touch_m(scenario_)) return true;
    }
  }
  return false;
}

double WallStory::farthest_m() const {
  double farthest = 0.0;
  for (std::size_t k = 0; k < stretches_.size(); ++k) {
    const Stretch& s = stretches_[k];
    const Twofold t = end_s(k) - s.start_s;
    const Twofold way = (length(s.velocity_mps) + length(s.acceleration_mps2) * t * 0.5) * t;
    farthest = std::max(farthest, (length(s.position_m) + way).hi);
  }
  return farthest;
}

double WallStory::fastest_mps() const {
  double fastest = 0.0;
  for (std::size_t k = 0; k < stretches_.size(); ++k) {
    const Stretch& s = stretches_[k];
    const Twofold t = end_s(k) - s.start_s;
    const Twofold speed = length(s.velocity_mps) + length(s.acceleration_mps2) * t;
    const Twofold rim = (length(s.spin_radps) + length(s.spin_rate_radps2) * t) * ball_.radius;
    fastest = std::max(fastest, (speed + rim).hi);
  }
  return fastest;
}

}  // namespace carom::closed_form
