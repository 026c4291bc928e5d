#include "reference/exact/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"

namespace carom::exact {

namespace {

/// Half of the digits below one.
Real half_of_digits(const Digits& digits) {
  return pow(Real(10), -digits.count() / 2);
}

/// The sooner is on top of the heap.
bool later(const Prospect& a, const Prospect& b) {
  return a.earliest_s > b.earliest_s;
}

/// In steps of 10 ns: looking at a ball in double precision, solving for a meeting, carrying out an impact.
constexpr std::int64_t kLook = 1;
std::int64_t cost_of_meeting(int digits) {
  return 250 + digits / 2;
}
std::int64_t cost_of_impact(int digits) {
  return 4 * cost_of_meeting(digits);
}

/// A ball that leaves a surface and is back after so small a part of the duration comes to rest on it: no run
/// of doubles can tell. It is the same for any number of digits, and far above the rounding of forty.
constexpr double kRest = 1e-17;

/// The seed of a twin's random direction: any number will do, but always the same.
constexpr std::uint64_t kDirection = 20;

/// Whether no ball ever leaves its place along an axis of the scene's frame, whatever is rounded: they are
/// all level and still along it, and nothing pushes them. (Friction of a spinning ball could.)
bool idle(const Scenario& scene, int axis) {
  if (axis >= scene.dimension) return true;
  if (scene.ball_contact.friction > 0.0 || scene.wall_contact.friction > 0.0) return false;
  if (scene.effects.gravity && (*scene.effects.gravity)[axis] != 0.0) return false;
  const bool level = std::all_of(scene.balls.begin(), scene.balls.end(), [&](const Ball& ball) {
    return ball.velocity[axis] == 0.0 && ball.position[axis] == scene.balls.front().position[axis];
  });
  return level && std::all_of(scene.walls.begin(), scene.walls.end(), [&](const Wall& wall) {
           return wall.normal[axis] == 0.0 || std::abs(wall.normal[axis]) == 1.0;
         });
}

/// With every axis that is not idle.
Vector random_direction(Random& random, const std::array<bool, 3>& idle) {
  Vec3 direction = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (!idle[static_cast<std::size_t>(axis)]) direction[axis] = random.uniform(-1.0, 1.0);
  }
  return Vector(direction);
}

}  // namespace

Run::Run(const Scenario& scene, const Digits& digits, double end_s, Budget& budget)
    : scene_(scene),
      digits_(digits.count()),
      setting_(scene),
      slack_{half_of_digits(digits) * setting_.scale_m, half_of_digits(digits) * setting_.speed_mps},
      instant_s_(half_of_digits(digits) * end_s),
      end_s_(end_s),
      shadow_(scene, setting_, end_s),
      budget_(budget),
      perturbation_m_(0),
      due_(scene.balls.size()),
      now_s_(0),
      moment_s_(0) {
  for (const Ball& ball : scene.balls) {
    bodies_.push_back({0, Vector(ball.position), Vector(ball.velocity), Vector(ball.spin)});
  }
}

void Run::perturb(const Real& change_m) {
  const Digits digits(digits_);
  Random random(kDirection);
  const std::array idle_axes = {idle(scene_, 0), idle(scene_, 1), idle(scene_, 2)};
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Vector place = random_direction(random, idle_axes) * change_m;
    const Vector velocity = random_direction(random, idle_axes) * Real(change_m / end_s_);
    if (!setting_.matter[i].movable()) continue;
    bodies_[i].position_m += place;
    bodies_[i].velocity_mps += velocity;
    perturbation_m_ = std::max({perturbation_m_, length(place), Real(length(velocity) * end_s_)});
  }
}

/// Finds the soonest impacts of all balls, from where they are now.
void Run::look_ahead() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) shadow_.set(i, bodies_[i]);
  shadow_.advance(now_s_.convert_to<double>());
  for (std::size_t i = 0; i < bodies_.size(); ++i) predict(i);
  started_ = true;
}

void Run::turn_round() {
  const Digits digits(digits_);
  now_s_ = moment_s_;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i] = setting_.moved(i, bodies_[i], now_s_);
    bodies_[i].velocity_mps *= -1;
    bodies_[i].spin_radps *= -1;
  }
  look_ahead();
}

bool Run::follow(const Moment& moment) {
  const Digits digits(digits_);
  if (!started_) look_ahead();
  moment_s_ = Real(moment.step_s) * moment.steps;
  const Real until_s = moment_s_ + instant_s_;
  while (!stop_) {
    const std::optional<std::size_t> next = soonest();
    if (!next || *due_[*next].time_s > until_s) return true;
    perform(*next);
  }
  return false;
}

/// By the rounded times, and where those are the same by all digits. (Rounding keeps the order.)
std::optional<std::size_t> Run::soonest() const {
  std::optional<std::size_t> soonest;
  double rounded_s = kNever;
  for (std::size_t i = 0; i < due_.size(); ++i) {
    if (due_[i].rounded_s > rounded_s || !due_[i].time_s) continue;
    if (due_[i].rounded_s == rounded_s && *due_[i].time_s >= *due_[*soonest].time_s) continue;
    soonest = i;
    rounded_s = due_[i].rounded_s;
  }
  return soonest;
}

std::optional<Real> Run::meeting_s(std::size_t ball, const Prospect& prospect) const {
  const Body& own = bodies_[ball];
  const Vector place = setting_.position(ball, own, now_s_);
  const Vector velocity = setting_.velocity(ball, own, now_s_);
  std::optional<Real> wait;
  if (prospect.wall) {
    const Plane& wall = setting_.walls[prospect.partner];
    const Real gap = dot(place, wall.normal) - wall.offset_m - setting_.matter[ball].radius_m;
    const Real fall = setting_.falls(ball) ? dot(setting_.gravity_mps2, wall.normal) : Real(0);
    wait = wall_reached(gap, dot(velocity, wall.normal), fall, slack_);
  } else {
    const std::size_t k = prospect.partner;
    Relative motion{setting_.position(k, bodies_[k], now_s_) - place,
                    setting_.velocity(k, bodies_[k], now_s_) - velocity,
                    {0, 0, 0},
                    setting_.falls(ball) != setting_.falls(k)};
    if (motion.accelerated) motion.a = setting_.gravity_mps2 * Real(setting_.falls(k) ? 1 : -1);
    const Real distance = setting_.matter[ball].radius_m + setting_.matter[k].radius_m;
    wait = balls_meet(motion, distance, slack_, end_s_ - now_s_);
  }
  if (wait) *wait += now_s_;
  return wait;
}

/// The ball's soonest impact of all: those of whom it surely does not meet before the soonest found so far
/// are not looked for.
void Run::predict(std::size_t ball) {
  shadow_.prospects(ball, prospects_);
  budget_.left -= kLook * static_cast<std::int64_t>(bodies_.size());
  std::make_heap(prospects_.begin(), prospects_.end(), later);
  Due& due = due_[ball];
  due = {std::nullopt, kNever, 0, false};
  while (!prospects_.empty() && prospects_.front().earliest_s <= due.rounded_s) {
    std::pop_heap(prospects_.begin(), prospects_.end(), later);
    const Prospect prospect = prospects_.back();
    prospects_.pop_back();
    const std::optional<Real> time_s = meeting_s(ball, prospect);
    budget_.left -= cost_of_meeting(digits_);
    if (!time_s || *time_s > end_s_ || (due.time_s && *time_s >= *due.time_s)) continue;
    due = {time_s, time_s->convert_to<double>(), prospect.partner, prospect.wall};
  }
}

/// After an impact of these two, and of all who had counted on one of them.
void Run::predict_anew(const Touch& touch) {
  const auto hit = [&](std::size_t ball) {
    return ball == touch.ball || (!touch.wall && ball == touch.partner);
  };
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Due& due = due_[i];
    if (hit(i) || (due.time_s && !due.wall && hit(due.partner))) predict(i);
  }
}

void Run::perform(std::size_t ball) {
  const Due& due = due_[ball];
  const Touch touch{static_cast<std::uint32_t>(ball), due.partner, due.wall};
  now_s_ = std::max(now_s_, *due.time_s);
  shadow_.advance(now_s_.convert_to<double>());
  budget_.left -= cost_of_impact(digits_) + kLook * static_cast<std::int64_t>(bodies_.size());
  if (budget_.left < 0) {
    stop_at(now_s_, "", true);
    return;
  }
  if (goes_on(touch)) carry_out(touch);
}

void Run::carry_out(const Touch& touch) {
  Body& ball = bodies_[touch.ball];
  ball = setting_.moved(touch.ball, ball, now_s_);
  Body& partner = touch.wall ? ball : bodies_[touch.partner];
  if (!touch.wall) partner = setting_.moved(touch.partner, partner, now_s_);
  Encounter encounter(setting_, scene_, touch, ball, partner);
  const Real approach = encounter.approach_mps();
  tell_tie_apart(touch, approach);
  if (approach > 0) account(touch, encounter, encounter.collide());
  impacts_.push_back({now_s_.convert_to<double>(), touch.ball, touch.partner, touch.wall});
  const Real pressing = encounter.pressing_mps2();
  if (pressing > 0 && -2 * encounter.approach_mps() <= pressing * kRest * end_s_) {
    stop_at(now_s_, fmt::format("ball {} comes to rest on {} {}: a contact that lasts is no impact",
                                touch.ball, touch.wall ? "wall" : "ball", touch.partner));
    return;
  }
  for (const std::size_t hit : {touch.ball, touch.wall ? touch.ball : touch.partner}) {
    shadow_.set(hit, bodies_[hit]);
    shadow_.catch_up(hit);
  }
  predict_anew(touch);
}

/// Walls and immovable balls push movable ones, at the contact.
void Run::account(const Touch& touch, const Encounter& encounter, const Vector& impulse) {
  const bool on_ball = setting_.matter[touch.ball].movable();
  const bool on_partner = !touch.wall && setting_.matter[touch.partner].movable();
  if (on_ball && on_partner) return;
  const std::size_t pushed = on_ball ? touch.ball : touch.partner;
  // The impulse is on b and the normal points to b, which is the ball at a wall and else the partner.
  const bool is_b = touch.wall || on_partner;
  const Real sign = is_b ? 1 : -1;
  const Vector push = impulse * sign;
  const Vector contact =
      bodies_[pushed].position_m - encounter.normal() * Real(sign * setting_.matter[pushed].radius_m);
  external_impulse_ += push;
  external_angular_impulse_ += cross(contact, push);
}

void Run::stop_at(const Real& time_s, std::string reason, bool budget) {
  stop_ = Stop{time_s.convert_to<double>(), std::move(reason), budget};
}

Body Run::state(std::size_t ball) const {
  const Digits digits(digits_);
  return setting_.moved(ball, bodies_[ball], moment_s_);
}

Tally Run::tally() const {
  Tally tally;
  tally.impacts = static_cast<std::int64_t>(impacts_.size());
  tally.external_impulse = rounded(external_impulse_);
  tally.external_angular_impulse = rounded(external_angular_impulse_);
  return tally;
}

}  // namespace carom::exact
