#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/evolvers/event.h"
#include "carom/evolvers/event_flights.h"
#include "carom/evolvers/event_plans.h"
#include "carom/evolvers/event_queue.h"
#include "carom/time_of_impact.h"

namespace carom {

/// The evolver `event`: no steps, from impact to impact.
///
/// What comes next for whom stands in event_plans.h, and why it is built so in EVENT_SPEED.md.
///
/// The time of an impact is computed from where both flights began, whoever looks and whenever, and flights
/// end only by impacts: so trajectories are the same bits however advance() is cut, whatever the cells, and
/// whenever balls are looked at. Impacts are carried out in the order of (time, first ball, kind, second ball
/// or wall).
///
/// Collapse: with e < 1 balls could collide infinitely often in finite time. A ball that has had a few
/// impacts in a row, each within t_c of the one before, has elastic ones until it flies longer than t_c.
/// Energy still never grows and momentum is kept. After S. Luding, S. McNamara, "How to handle the inelastic
/// collapse of a dissipative hard-sphere gas with the TC model", Granular Matter 1, 113 (1998). Deviation:
/// there every impact within t_c is elastic; here an impact that runs along touching balls loses on its way
/// what it should.
///
/// Rest: under gravity (with elastic walls alone, see event_refusal()) a rebound that would not rise above
/// the rounding of the ball's position is none: the wall bears the ball until it is hit.
///
/// @tparam Plans  who knows what comes next: EventPlans, or its slow twin EventSearch
template <int Dim, bool kGravity, class Law, template <int, bool> class Plans = EventPlans>
class EventEvolver final : public Simulation {
 public:
  explicit EventEvolver(const Scenario& scene)
      : flights_(scene),
        times_(flights_, scene),
        plans_(scene, flights_, times_),
        surface_(scene.ball_contact),
        wall_surface_(scene.wall_contact),
        step_s_(scene.step_s),
        window_s_(std::exp2(std::ceil(std::log2(kStepsInWindow * scene.step_s)))) {
    tally_.energy.known = true;
    if (std::min(surface_.restitution, wall_surface_.restitution) < 1.0) rapid_.assign(flights_.size(), 0);
    renumber();
  }

  void advance(double step_s, std::int64_t steps) override {
    offset_s_ += step_s * static_cast<double>(steps);
    const double windows = std::floor(offset_s_ / window_s_);
    offset_s_ -= windows * window_s_;
    windows_ += windows;
    while (const std::optional<EventMeeting> meeting = plans_.next(now())) {
      if (meeting->time >= window_s_) {
        rebase(meeting->time);
      } else {
        carry_out(*meeting);
      }
    }
  }

  void snapshot(std::span<BallState> balls) const override { flights_.snapshot(now(), balls); }

  Tally tally() const override {
    Tally tally = tally_;
    if constexpr (kGravity) {
      flights_.add_pushes(now(), tally);
    }
    return tally;
  }

  Settings settings() const override {
    Settings settings = {
        {"evolver", "event"}, {"law", std::string(Law::kName)}, {"clock_window_s", window_s_}};
    plans_.add_settings(settings);
    if (!rapid_.empty()) {
      settings["elastic_below_s"] = kRapidShare * step_s_;
      settings["elastic_after_rapid_impacts"] = static_cast<double>(kMostRapid);
    }
    if constexpr (kGravity) settings["rest_below_height_in_position_epsilons"] = kRestEpsilons;
    return settings;
  }

 private:
  /// Steps after which clocks count anew, rounded up to a power of two of seconds, so that no time loses a
  /// bit by it: often enough for clocks to keep their digits, and too seldom to be felt.
  static constexpr double kStepsInWindow = 64.0;

  /// t_c as a part of the step: far less than what any two impacts have between them that a person asks
  /// about.
  static constexpr double kRapidShare = 1e-6;
  /// Rapid impacts in a row that still lose energy: in a row of touching balls each is hit, hits the next,
  /// and may meet both once more.
  static constexpr std::uint8_t kMostRapid = 4;

  /// Events within a share of the step after which something must be wrong: more than any count of elastic
  /// impacts asks for (Galperin's are 3.1 million at a mass ratio of 10¹²), and many for each ball, should
  /// all meet at once.
  static constexpr std::int64_t kMostAtOnce = 4'000'000;
  static constexpr std::int64_t kMostAtOnceEach = 64;
  static constexpr double kAtOnceShare = 1e-9;

  /// Of each ball, between renumberings: in a gas of half the closest density they lead it a few diameters
  /// far, and to number it anew costs less than one.
  static constexpr std::int64_t kImpactsInOrder = 10;

  /// The moment that advance() has led to, s.
  double now() const { return windows_ * window_s_ + offset_s_; }

  void carry_out(const EventMeeting& meeting) {
    guard_progress(meeting);
    if (meeting.partner >= flights_.size()) {
      hit_wall(meeting.ball, meeting.partner - balls(), meeting.time);
    } else if (name(meeting.ball) < name(meeting.partner)) {
      hit_ball(meeting.ball, meeting.partner, meeting.time);
    } else {
      hit_ball(meeting.partner, meeting.ball, meeting.time);
    }
    if (++since_renumbered_ > kImpactsInOrder * static_cast<std::int64_t>(balls())) renumber();
  }

  void guard_progress(const EventMeeting& meeting) {
    if (meeting.time > at_once_since_ + kAtOnceShare * step_s_) {
      at_once_since_ = meeting.time;
      at_once_ = 0;
    }
    if (++at_once_ <= kMostAtOnce + kMostAtOnceEach * static_cast<std::int64_t>(balls())) return;
    throw std::runtime_error(
        fmt::format("time stands still after {} impacts at once, the last of ball {}: balls that lie against "
                    "each other are beyond the event-driven evolver",
                    at_once_, name(meeting.ball)));
  }

  /// Counts time from the window of `time_s` on: a whole number of windows, a power of two of seconds.
  void rebase(double time_s) {
    const double windows = std::floor(time_s / window_s_);
    const double shift = windows * window_s_;
    flights_.rebase(shift);
    plans_.rebase(shift);
    windows_ -= windows;
    at_once_since_ -= shift;
  }

  /// Balls that are near in space are to be near in memory. It changes nothing but how long this takes.
  void renumber() {
    since_renumbered_ = 0;
    const std::vector<std::uint32_t> order = plans_.order();
    if (order.empty()) return;
    flights_.renumber(order);
    plans_.renumber(order);
  }

  std::uint32_t balls() const { return static_cast<std::uint32_t>(flights_.size()); }
  /// A ball's number in the scene.
  std::uint32_t name(std::uint32_t ball) const { return flights_.name(ball); }

  // --- impacts

  void hit_ball(std::uint32_t a, std::uint32_t b, double time_s) {
    const Contact surface = surface_after(surface_, time_s, {a, b});
    const Motion<Dim> at_a = flights_.motion(a, time_s);
    const Motion<Dim> at_b = flights_.motion(b, time_s);
    const Vec<Dim> normal = normal_between(at_a.x, at_b.x);
    const double v_n = normal.dot(at_b.v - at_a.v);
    if constexpr (kGravity) {
      if (ends_in_rest(v_n, normal.dot(at_b.a - at_a.a), at_a.x, flights_.radius(a))) {
        throw std::runtime_error(
            fmt::format("ball {} comes to rest on ball {}: the event-driven evolver lays balls on walls only",
                        name(a), name(b)));
      }
    }
    for (const std::uint32_t ball : {a, b}) end_flight(ball, time_s);
    if (v_n < 0.0) {
      ++tally_.impacts;
      const Vec<Dim> impulse = flights_.template collide<Law>(a, b, normal, surface);
      flights_.template add_work_of_collision<Law>(normal, impulse, tally_.energy);
      if (!flights_.movable(a)) book(at_b.x - flights_.radius(b) * normal, impulse);
      if (!flights_.movable(b)) book(at_a.x + flights_.radius(a) * normal, -impulse);
    }
    for (const std::uint32_t ball : {a, b}) {
      if (flights_.movable(ball)) plans_.plan_flight(ball);
    }
  }

  void hit_wall(std::uint32_t ball, std::uint32_t wall, double time_s) {
    const Contact surface = surface_after(wall_surface_, time_s, {ball});
    const Vec<Dim>& normal = times_.wall(wall).normal;
    const std::uint32_t bearer = flights_.bearer(ball);
    const Motion<Dim> at = flights_.motion(ball, time_s);
    const double v_n = normal.dot(at.v);
    end_flight(ball, time_s);
    if constexpr (kGravity) {
      if (ends_in_rest(v_n, normal.dot(at.a), at.x, flights_.radius(ball))) {
        lay_down(ball, wall, bearer);
        plans_.plan_flight(ball);
        return;
      }
    }
    if (v_n < 0.0) {
      ++tally_.impacts;
      ++tally_.wall_impacts;
      const Vec<Dim> impulse = flights_.template bounce<Law>(ball, normal, surface);
      tally_.wall_push_Ns += normal.dot(impulse);
      flights_.template add_work_of_bounce<Law>(normal, impulse, tally_.energy);
      book(at.x - flights_.radius(ball) * normal, impulse);
    }
    plans_.plan_flight(ball);
  }

  /// An immovable ball flies on as it did.
  void end_flight(std::uint32_t ball, double time_s) {
    if (!flights_.movable(ball)) return;
    if constexpr (kGravity) flights_.add_push(ball, time_s, tally_);
    flights_.begin_flight(ball, time_s);
    plans_.end_flight(ball);
  }

  /// Two balls at one point have no normal; any fixed one keeps the laws.
  static Vec<Dim> normal_between(const Vec<Dim>& a, const Vec<Dim>& b) {
    const Vec<Dim> between = b - a;
    return between.isZero(0.0) ? Vec<Dim>(Vec<Dim>::UnitX()) : Vec<Dim>(between.normalized());
  }

  /// The surface of an impact of these balls; elastic where one of them chatters (see above). Counts their
  /// rapid impacts.
  Contact surface_after(const Contact& surface, double time_s, std::initializer_list<std::uint32_t> hit) {
    Contact result = surface;
    if (rapid_.empty()) return result;
    for (const std::uint32_t ball : hit) {
      std::uint8_t& rapid = rapid_[name(ball)];
      if (time_s - flights_.clock(ball) >= kRapidShare * step_s_) {
        rapid = 0;
      } else if (rapid < kMostRapid) {
        ++rapid;
      } else {
        result.restitution = 1.0;
      }
    }
    return result;
  }

  // --- rest, under gravity

  /// Whether a contact closes by no more than a fall from the height of rounding gives: v² = 2 |a| h.
  static bool ends_in_rest(double v_n, double a_n, const Vec<Dim>& place, double radius) {
    const double height = kRestEpsilons * kEpsilon * (place.cwiseAbs().maxCoeff() + radius);
    return a_n < 0.0 && v_n * v_n <= -2.0 * a_n * height;
  }

  void lay_down(std::uint32_t ball, std::uint32_t wall, std::uint32_t bearer) {
    if (bearer != flights_.kNoWall) {
      throw std::runtime_error(fmt::format(
          "ball {} comes to rest in a corner: the event-driven evolver lays balls on one wall only",
          name(ball)));
    }
    if (Law::kFriction && wall_surface_.friction > 0.0) {
      throw std::runtime_error(fmt::format(
          "ball {} comes to lie on a wall with friction: the event-driven evolver lets balls only slide",
          name(ball)));
    }
    tally_.energy.wall_impacts_J += flights_.lay_on(ball, wall, times_.wall(wall).normal);
  }

  // --- the account of walls and immovable balls

  void book(const Vec<Dim>& contact_point, const Vec<Dim>& impulse) {
    const Vec3 wide = widened<Dim>(impulse);
    tally_.external_impulse += wide;
    tally_.external_angular_impulse += widened<Dim>(contact_point).cross(wide);
  }

  EventFlights<Dim, kGravity> flights_;
  EventTimes<Dim, kGravity> times_;
  Plans<Dim, kGravity> plans_;
  Contact surface_;
  Contact wall_surface_;
  std::vector<std::uint8_t> rapid_;  ///< rapid impacts in a row, by name; empty where all are elastic
  double step_s_;
  Tally tally_ = {.walls_known = true};

  // Times count from the last rebase(); what advance() asks for, in windows and a remainder.
  double window_s_;
  double windows_ = 0.0;
  double offset_s_ = 0.0;
  double at_once_since_ = -kNever;
  std::int64_t at_once_ = 0;
  std::int64_t since_renumbered_ = 0;  ///< impacts
};

}  // namespace carom
