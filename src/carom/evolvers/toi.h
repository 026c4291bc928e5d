#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <queue>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "carom/effects/barrier.h"
#include "carom/effects/slab.h"
#include "carom/evolvers/parts.h"
#include "carom/evolvers/resting.h"
#include "carom/laws/frictionless.h"

namespace carom {

/// The evolver `toi`: fixed steps, and within a step every impact at its time of impact and in order of time.
///
/// Flights are parabolas (flight.h), so without drag and Magnus force a step of any length is exact but for
/// rounding; those make it second order. The result does not depend on the broad phase, bit for bit: what
/// happens is carried out in the order of (time, first ball, kind, second ball or plane), balls by their
/// numbers in the scene. How contact becomes rest stands in resting.h.
///
/// @tparam Traits  what the scene calls for, see traits.h: kDim, kAccelerates, Law, kSheets
template <class Traits>
class ToiEvolver final : public Simulation {
 public:
  static constexpr int kDim = Traits::kDim;
  using Law = typename Traits::Law;

  ToiEvolver(const Scenario& scene, Parts<kDim> parts)
      : threads_(parts.threads),
        law_(law_of<Law>(parts)),
        flights_(scene, std::move(parts.flight), threads_),
        planes_(planes_of<kDim>(scene.walls)),
        neighbours_(flights_, std::move(parts.broad_phase), parts.listed, planes_, threads_),
        cluster_law_(std::move(parts.cluster_law)),
        resting_(scene, flights_, neighbours_, planes_),
        barriers_(scene),
        surface_(scene.ball_contact),
        wall_surface_(scene.wall_contact),
        most_flights_(most_flights(surface_.restitution)),
        most_wall_flights_(most_flights(wall_surface_.restitution)) {
    if constexpr (Traits::kSheets) {
      add_slabs<kDim>(scene, planes_);
      add_barriers<kDim>(scene, planes_);
    }
  }

  void advance(double step_s, std::int64_t steps) override {
    for (std::int64_t k = 0; k < steps; ++k) step(step_s);
  }

  void snapshot(std::span<BallState> balls) const override { flights_.snapshot(balls); }
  Tally tally() const override { return flights_.account().tally; }

  Settings settings() const override {
    Settings settings = Rest::settings();
    settings["evolver"] = std::string("toi");
    settings["law"] = std::string(Law::kName);
    settings["touching_law"] = std::string(cluster_law_ ? cluster_law_->name() : "sequential");
    settings["broad_phase"] = std::string(neighbours_.name());
    settings["threads"] = static_cast<double>(threads_.count());
    return settings;
  }

 private:
  using Balls = Flights<kDim, Traits::kAccelerates, Law::kFriction>;
  using Rest = Resting<kDim, Traits::kAccelerates, Law::kFriction>;
  using Place = Vec<kDim>;

  /// Of the step: impacts of a ball that follow each other sooner may be a chatter. A bounce with e < 1 gets
  /// there, elastic ones between lossy ones do not.
  static constexpr double kRapidShare = 1e-3;

  /// Contacts resolved in a step after which something must be wrong: more than any count of elastic impacts
  /// asks for (Galperin's are 3.1 million at a mass ratio of 10¹²).
  static constexpr std::size_t kMostInAStep = 4'000'000;

  /// Impacts of a ball within a step after which it chatters: with restitution e, e^k of a velocity is left
  /// after k impacts, and that is below rounding for k = ln ε / ln e. Elastic balls lose nothing and never
  /// chatter.
  static std::uint32_t most_flights(double restitution) {
    constexpr double kAtLeast = 64.0;
    if (restitution == 1.0) return std::numeric_limits<std::uint32_t>::max();
    if (restitution == 0.0) return static_cast<std::uint32_t>(kAtLeast);
    return static_cast<std::uint32_t>(std::clamp(std::log(kEpsilon) / std::log(restitution), kAtLeast, 1e9));
  }

  enum class Kind : std::uint8_t { pair, plane, grip_of_pair, grip_of_plane };

  /// What is to come: ball a meets ball b or plane b, or the slip of such a contact ends. It is stale once
  /// either ball has a later stamp.
  struct Meeting {
    double time;  ///< s, from the start of the step
    std::uint32_t a;
    std::uint32_t b;
    Kind kind;
    std::uint32_t stamp_a;
    std::uint32_t stamp_b;

    bool with_plane() const { return kind == Kind::plane || kind == Kind::grip_of_plane; }
    typename Rest::Seed seed() const { return {a, b, with_plane()}; }
  };

  /// The order in which meetings are carried out, the last first.
  struct Later {
    const World<kDim>& world;

    bool operator()(const Meeting& x, const Meeting& y) const {
      return x.time != y.time ? x.time > y.time : rank(x) > rank(y);
    }
    std::tuple<std::uint32_t, Kind, std::uint32_t> rank(const Meeting& meeting) const {
      const std::uint32_t b = meeting.with_plane() ? meeting.b : world.number_of(meeting.b);
      return {world.number_of(meeting.a), meeting.kind, b};
    }
  };

  const World<kDim>& world() const { return flights_.world(); }

  void step(double step_s) {
    neighbours_.sort();
    flights_.begin_step(step_s);
    resting_.begin_step();
    neighbours_.begin_step();
    find_meetings();
    resolve_meetings();
    neighbours_.end_step();
    const bool hold = neighbours_.hold_for_a_step();
    flights_.finish_step(!hold);
    if constexpr (!Traits::kAccelerates) neighbours_.expect_anew(hold);
  }

  void find_meetings() {
    coming_near_.clear();
    const double fall_m = flights_.step_s() * flights_.field_speed();
    neighbours_.find_meeting(coming_near_,
                             [&](std::uint32_t a, std::uint32_t b) { return come_near(a, b, fall_m); });
    forget_twins(coming_near_);
    for (const auto& [a, b] : coming_near_) expect_pair(a, b);
    coming_near_.clear();
    for (const auto& [ball, plane] : neighbours_.besides()) {
      const double reach_m = flights_.reach(ball).bound;
      if (planes_[plane].gap(flights_.place_at_start(ball), reach_m) <= 0.0) {
        coming_near_.emplace_back(ball, plane);
      }
    }
    forget_twins(coming_near_);
    for (const auto& [ball, plane] : coming_near_) expect_plane(ball, plane);
  }

  /// Some are listed twice.
  static void forget_twins(std::vector<BallPair>& pairs) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  }

  /// A cheap question that leaves few pairs to the exact one: may these touch in the step, both flying as
  /// they do? Fields have a part of at most f = h² max|a| in their approach.
  bool come_near(std::size_t a, std::size_t b, double fall_m) const {
    const Approach<kDim> approach(flights_.place_at_start(b) - flights_.place_at_start(a),
                                  world().velocity[b] - world().velocity[a],
                                  world().radius[a] + world().radius[b] + fall_m);
    return approach.may_touch_within(flights_.step_s());
  }

  void resolve_meetings() {
    for (std::size_t resolved = 0; !meetings_to_come_.empty();) {
      const Meeting next = meetings_to_come_.top();
      meetings_to_come_.pop();
      if (stale(next)) continue;
      fetch_for(next);
      if (++resolved > kMostInAStep) {
        throw std::runtime_error(
            fmt::format("more than {} impacts in one step, {} s into it, of balls {} and {}", kMostInAStep,
                        next.time, next.a, next.with_plane() ? next.a : next.b));
      }
      switch (next.kind) {
        case Kind::pair:
          resolve_pair(next);
          break;
        case Kind::plane:
          resolve_plane(next);
          break;
        case Kind::grip_of_pair:
        case Kind::grip_of_plane:
          come_to_rest(next, false);
          break;
      }
    }
  }

  /// Has the processor load what this meeting asks for around its balls, and what the next one will of its
  /// own.
  void fetch_for(const Meeting& meeting) const {
    neighbours_.fetch_around(meeting.a);
    if (!meeting.with_plane()) neighbours_.fetch_around(meeting.b);
    if (meetings_to_come_.empty()) return;
    const Meeting& next = meetings_to_come_.top();
    neighbours_.fetch(next.a);
    if (!next.with_plane()) neighbours_.fetch(next.b);
  }

  // --- what is to come

  bool stale(const Meeting& meeting) const {
    return meeting.stamp_a != flights_.stamp(meeting.a) ||
           (!meeting.with_plane() && meeting.stamp_b != flights_.stamp(meeting.b));
  }

  void expect_pair(std::size_t i, std::size_t j) {
    if (world().inverse_mass[i] == 0.0 && world().inverse_mass[j] == 0.0) return;  // nothing can give way
    const double now = std::max(flights_.clock(i), flights_.clock(j));
    const Motion<kDim> a = flights_.motion_at(i, now);
    const Motion<kDim> b = flights_.motion_at(j, now);
    const Place d = b.x - a.x;
    const Place w = b.v - a.v;
    const double sigma = world().radius[i] + world().radius[j];
    const double rounding = velocity_rounding(a.v.norm() + b.v.norm() + flights_.field_speed());
    double wait = kNever;
    if constexpr (Traits::kAccelerates) {
      const Place relative = b.a - a.a;
      const double left_s = flights_.step_s() - now;
      // What moves them by less than rounding does is no relative acceleration.
      const bool uniform = 0.5 * left_s * left_s * relative.norm() <= kEpsilon * sigma;
      wait = uniform ? time_to_touch<kDim>(d, w, sigma, rounding)
                     : time_to_touch<kDim>(d, w, relative, sigma, rounding, left_s);
    } else {
      wait = time_to_touch<kDim>(d, w, sigma, rounding);
    }
    world().before(i, j) ? expect(now + wait, i, j, Kind::pair) : expect(now + wait, j, i, Kind::pair);
  }

  void expect_plane(std::size_t ball, std::size_t number) {
    if (world().inverse_mass[ball] == 0.0) return;
    const Plane<kDim>& plane = planes_[number];
    const Motion<kDim> now = flights_.motion(ball);
    if constexpr (Traits::kSheets) {
      if (!plane.faces(now.x)) return;
    }
    const double rounding = velocity_rounding(now.v.norm() + flights_.field_speed());
    const double wait = time_to_close(plane.gap(now.x, world().radius[ball]), plane.normal.dot(now.v),
                                      plane.normal.dot(now.a), rounding, flights_.left_s(ball));
    expect(flights_.clock(ball) + wait, ball, number, Kind::plane);
  }

  void expect(double time_s, std::size_t a, std::size_t b, Kind kind) {
    if (!(time_s <= flights_.step_s())) return;
    const bool plane = kind == Kind::plane;
    if (resting_.is_held(a, b, plane)) return;
    meetings_to_come_.push({time_s, static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), kind,
                            flights_.stamp(a), plane ? 0 : flights_.stamp(b)});
  }

  void expect_all(std::size_t ball) {
    neighbours_.widen(ball);
    for (std::size_t plane = 0; plane < planes_.size(); ++plane) expect_plane(ball, plane);
    neighbours_.find_near(ball, near_);
    for (const std::uint32_t other : near_) expect_pair(ball, other);
  }

  void expect_all_of(const std::vector<std::uint32_t>& balls) {
    for (const std::uint32_t ball : balls) expect_all(ball);
  }

  // --- impacts
  // A meeting is expected only where balls approach by more than rounding, and resolved whatever little
  // approach is left when its time comes: between the two thresholds nothing can be expected again and again.

  /// Whether the ball's last event was just before. Immovable ones have none of their own.
  bool is_rapid(const Meeting& meeting, std::uint32_t ball) const {
    return world().inverse_mass[ball] == 0.0 ||
           meeting.time - flights_.clock(ball) <= kRapidShare * flights_.step_s();
  }

  void resolve_pair(const Meeting& meeting) {
    const std::uint32_t a = meeting.a;
    const std::uint32_t b = meeting.b;
    const bool rapid = is_rapid(meeting, a) && is_rapid(meeting, b);
    flights_.fly_to(a, meeting.time);
    flights_.fly_to(b, meeting.time);
    const Place normal = normal_between<kDim>(world().position[a], world().position[b]);
    const double v_n = normal.dot(world().velocity[b] - world().velocity[a]);
    const double a_n = normal.dot(flights_.acceleration(b) - flights_.acceleration(a));
    const double speeds = world().velocity[a].norm() + world().velocity[b].norm();
    const bool chatters = (rapid && std::max(flights_.stamp(a), flights_.stamp(b)) >= most_flights_) ||
                          resting_.in_crowd(a) || resting_.in_crowd(b);
    const double place_m = world().position[a].cwiseAbs().maxCoeff();
    if (chatters || resting_.comes_to_rest(v_n, a_n, surface_.restitution, speeds, place_m)) {
      come_to_rest(meeting, chatters);
    } else if (v_n < 0.0 && cluster_law_) {
      resolve_touching(meeting);
    } else if (v_n < 0.0) {
      ++flights_.account().tally.impacts;
      const Place impulse = law_.template between<kDim>(flights_.world(), a, b, normal, surface_);
      flights_.account().template book_pair<Law::kFriction>(world(), a, b, normal, impulse);
      begin_flights({a, b});
    }
  }

  void resolve_plane(const Meeting& meeting) {
    const std::uint32_t ball = meeting.a;
    const Plane<kDim>& plane = planes_[meeting.b];
    const bool rapid = is_rapid(meeting, ball);
    flights_.fly_to(ball, meeting.time);
    const double v_n = plane.normal.dot(world().velocity[ball]);
    const double a_n = plane.normal.dot(flights_.acceleration(ball));
    const bool chatters = (rapid && flights_.stamp(ball) >= most_wall_flights_) || resting_.in_crowd(ball);
    const double speed = world().velocity[ball].norm();
    const double place_m = world().position[ball].cwiseAbs().maxCoeff();
    if constexpr (Traits::kSheets) {
      if (plane.barrier != kSolid) {
        const bool rests = resting_.in_crowd(ball) || resting_.comes_to_rest(v_n, a_n, 1.0, speed, place_m);
        return rests ? come_to_rest(meeting, false) : resolve_barrier(ball, plane);
      }
    }
    if (chatters || resting_.comes_to_rest(v_n, a_n, wall_surface_.restitution, speed, place_m)) {
      come_to_rest(meeting, chatters);
    } else if (v_n < 0.0 && cluster_law_) {
      resolve_touching(meeting);
    } else if (v_n < 0.0) {
      ++flights_.account().tally.impacts;
      ++flights_.account().tally.wall_impacts;
      const Place impulse = Law::template on_wall<kDim>(flights_.world(), ball, plane.normal, wall_surface_);
      flights_.account().template book_plane<Law::kFriction>(world(), ball, plane.normal, impulse);
      begin_flights({ball});
    }
  }

  void resolve_barrier(std::uint32_t ball, const Plane<kDim>& face) {
    if (face.normal.dot(world().velocity[ball]) >= 0.0) return;
    ++flights_.account().tally.impacts;
    const Place before = world().position[ball];
    barriers_.meet(flights_.world(), ball, face, flights_.account());
    neighbours_.jumped(ball, (world().position[ball] - before).norm());
    begin_flights({ball});
  }

  /// New flights for those that were hit and for all that lean on them.
  void begin_flights(std::initializer_list<std::uint32_t> hit) {
    resting_.begin_flights_around({hit.begin(), hit.size()});
    expect_all_of(resting_.members());
  }

  void come_to_rest(const Meeting& meeting, bool chatters) {
    const std::uint32_t b = meeting.with_plane() ? meeting.a : meeting.b;
    const bool lossy = most_flights_ < kEndless || most_wall_flights_ < kEndless;
    const bool restless = std::max(flights_.stamp(meeting.a), flights_.stamp(b)) >= Rest::kMostFlights;
    if (chatters || (lossy && restless)) {
      resting_.join_crowd(meeting.seed(), meeting.time);
    } else {
      resting_.settle(meeting.seed(), meeting.time);
    }
    expect_all_of(resting_.members());
    for (const auto& grip : resting_.grips()) {
      const auto& at = grip.contact;
      expect_grip(grip.time_s, at.a, at.b, at.wall);
    }
  }

  void expect_grip(double time_s, std::uint32_t a, std::uint32_t b, bool plane) {
    if (!(time_s <= flights_.step_s())) return;
    meetings_to_come_.push({time_s, a, b, plane ? Kind::grip_of_plane : Kind::grip_of_pair, flights_.stamp(a),
                            plane ? 0 : flights_.stamp(b)});
  }

  /// All contacts that are closed at this moment and hang together go through the scene's law at once.
  void resolve_touching(const Meeting& meeting) {
    resting_.gather_touching(meeting.seed(), meeting.time, touching_);
    for (ClosedContact<kDim>& contact : touching_) {
      contact.restitution = contact.wall ? wall_surface_.restitution : surface_.restitution;
    }
    ++flights_.account().tally.impacts;
    flights_.account().open_contacts(world(), touching_);
    cluster_law_->resolve(flights_.world(), touching_);
    flights_.account().book_contacts(world(), touching_);
    const std::vector<std::uint32_t> hit = resting_.members();
    resting_.begin_flights_around(hit);
    expect_all_of(resting_.members());
  }

  static constexpr std::uint32_t kEndless = std::numeric_limits<std::uint32_t>::max();

  Threads threads_;
  [[no_unique_address]] Law law_;
  Balls flights_;
  std::vector<Plane<kDim>> planes_;
  Neighbours<kDim, Balls> neighbours_;
  std::unique_ptr<ClusterLaw<kDim>> cluster_law_;
  Rest resting_;
  Barriers<kDim> barriers_;
  Contact surface_;
  Contact wall_surface_;
  std::uint32_t most_flights_;
  std::uint32_t most_wall_flights_;

  std::vector<BallPair> coming_near_;
  std::vector<std::uint32_t> near_;
  std::vector<ClosedContact<kDim>> touching_;
  std::priority_queue<Meeting, std::vector<Meeting>, Later> meetings_to_come_{Later{flights_.world()}};
};

}  // namespace carom
