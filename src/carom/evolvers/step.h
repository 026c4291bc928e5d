#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "carom/broad_phase/pair_list.h"
#include "carom/broad_phase/reach.h"
#include "carom/effects/barrier.h"
#include "carom/effects/slab.h"
#include "carom/evolvers/parts.h"
#include "carom/evolvers/resting.h"
#include "carom/laws/frictionless.h"

namespace carom {

/// The evolver `step`: fixed steps and discrete detection, what a student would write, done properly.
///
/// In a step of h seconds: v += a h, x += v h (symplectic Euler, first order; with a of flight.h); whatever
/// overlaps then is in contact; contacts that approach get the impulse of the scene's law, in sweeps until
/// none approaches; last, balls that still overlap are moved apart, each in proportion to its inverse mass.
/// An approach slower than what the fields give in a step, |a| h, is no impact but rest, and is taken out
/// without a rebound.
///
/// A contact is found up to v h too late, so an impact is off by as much and turns by the angle of that
/// place: order 1 in h. A ball that is faster than its diameter a step can pass another, or a slab, unseen.
///
/// What the correction of positions does to the angular momentum is booked as a moment from outside: nothing
/// in the scene has done it. So is what friction does between balls that overlap, whose surfaces are not at
/// one point.
///
/// @tparam Traits  what the scene calls for, see traits.h
template <class Traits>
class StepEvolver final : public Simulation {
 public:
  static constexpr int kDim = Traits::kDim;
  using Law = typename Traits::Law;

  StepEvolver(const Scenario& scene, Parts<kDim> parts)
      : threads_(parts.threads),
        world_(scene.balls, scene.effects.spin),
        flight_(std::move(parts.flight)),
        cluster_law_(std::move(parts.cluster_law)),
        near_(std::move(parts.broad_phase), parts.listed, threads_),
        planes_(planes_of<kDim>(scene.walls)),
        barriers_(scene),
        surface_(scene.ball_contact),
        wall_surface_(scene.wall_contact),
        gravity_(flattened<kDim>(scene.effects.gravity.value_or(Vec3::Zero()))),
        acceleration_(Traits::kAccelerates ? world_.size() : 0),
        is_landed_(Traits::kAccelerates ? 0 : world_.size()) {
    if constexpr (Traits::kSheets) {
      add_slabs<kDim>(scene, planes_);
      add_barriers<kDim>(scene, planes_);
    }
  }

  void advance(double step_s, std::int64_t steps) override {
    for (std::int64_t k = 0; k < steps; ++k) {
      begin_step(step_s);
      find_contacts();
      land();
      resolve_impacts();
      separate();
      take_off();
    }
  }

  void snapshot(std::span<BallState> balls) const override { world_.snapshot(balls, flown_s_); }
  Tally tally() const override { return account_.tally; }

  Settings settings() const override {
    return {{"evolver", std::string("step")},
            {"law", std::string(Law::kName)},
            {"touching_law", std::string(cluster_law_ ? cluster_law_->name() : "sequential")},
            {"broad_phase", std::string(near_.name())},
            {"threads", static_cast<double>(threads_.count())},
            {"most_sweeps", static_cast<double>(kMostSweeps)}};
  }

 private:
  using Place = Vec<kDim>;

  /// Sweeps over the contacts of a step: a chain of as many balls passes an impact on in one of them. What is
  /// left approaching goes on in the next step.
  static constexpr int kMostSweeps = 64;

  struct Touch {
    std::uint32_t a;
    std::uint32_t b;
    bool plane;
    std::uint64_t rank;  ///< among those of pairs, or of planes

    /// Pairs by their balls' numbers, then planes, each with its balls.
    bool operator<(const Touch& other) const {
      return plane != other.plane ? other.plane : rank < other.rank;
    }
    bool operator==(const Touch& other) const { return plane == other.plane && rank == other.rank; }
  };

  void begin_step(double step_s) {
    field_speed_ = 0.0;
    if constexpr (Traits::kAccelerates) {
      threads_.in_parallel(world_.size(), [&](std::size_t begin, std::size_t end) {
        flight_->accelerations(world_, begin, end, step_s, acceleration_);
        for (std::size_t i = begin; i < end; ++i) {
          world_.velocity.set(i, world_.velocity[i] + step_s * acceleration_[i]);
        }
      });
      field_speed_ = step_s * largest_norm(acceleration_, threads_);
      fastest_ = largest_norm(world_.velocity, threads_);
    }
    flown_s_ += step_s;
    near_.travelled(step_s * (Traits::kAccelerates ? fastest_ : near_.cruise().mps()), step_s);
    const bool looks_around = !near_.holds();
    if (Traits::kAccelerates || looks_around) {
      world_.fly(flown_s_, threads_);
      flown_s_ = 0.0;
    }
    if (looks_around) look_around(step_s);
  }

  void find_contacts() {
    touches_.clear();
    near_.template for_each_due<Traits::kAccelerates ? 0 : 32>(
        world_, 0.0, 0.0, touches_, [this](std::uint32_t a, std::uint32_t b) { return overlap(a, b); },
        [this](std::uint32_t a, std::uint32_t b, std::vector<Touch>& found) { touch(a, b, found); });
    for (const auto& [ball, plane] : near_.besides()) touch_plane(ball, plane);
    // The list is in an order of its own; the order of the contacts decides what happens.
    std::sort(touches_.begin(), touches_.end());
    touches_.erase(std::unique(touches_.begin(), touches_.end()), touches_.end());
  }

  void look_around(double step_s) {
    near_.sort(world_);
    if constexpr (!Traits::kAccelerates) near_.measure_speeds(world_);
    near_.build(world_, planes_, step_s);
  }

  /// Where a ball in flight is.
  Place place(std::size_t ball) const {
    if constexpr (Traits::kAccelerates) return world_.position[ball];
    return world_.place_after(flown_s_, ball);
  }

  bool overlap(std::uint32_t a, std::uint32_t b) const {
    return may_meet<kDim>({place(a), world_.radius[a]}, {place(b), world_.radius[b]});
  }

  void touch(std::uint32_t a, std::uint32_t b, std::vector<Touch>& found) const {
    if (!world_.before(a, b)) std::swap(a, b);
    if (world_.inverse_mass[a] + world_.inverse_mass[b] == 0.0) return;
    found.push_back({a, b, false, rank(world_.number_of(a), world_.number_of(b))});
  }

  void touch_plane(std::uint32_t ball, std::uint32_t plane) {
    if (planes_[plane].gap(place(ball), world_.radius[ball]) > 0.0) return;
    if constexpr (Traits::kSheets) {
      if (!planes_[plane].faces(place(ball))) return;
    }
    if (world_.inverse_mass[ball] == 0.0) return;
    touches_.push_back({ball, plane, true, rank(plane, world_.number_of(ball))});
  }

  static std::uint64_t rank(std::uint32_t first, std::uint32_t second) {
    return std::uint64_t{first} << 32U | second;
  }

  // --- impacts
  // Where balls fly straight they stand in memory where they were when the list of pairs was made, or would
  // have been: one that is hit lands, and takes off from where its new flight would have begun.

  void land() {
    if constexpr (Traits::kAccelerates) return;
    landed_.clear();
    for (const Touch& touch : touches_) {
      land(touch.a);
      if (!touch.plane) land(touch.b);
    }
    for (const std::uint32_t ball : landed_) is_landed_[ball] = false;
  }

  void land(std::uint32_t ball) {
    if (is_landed_[ball]) return;
    is_landed_[ball] = true;
    landed_.push_back(ball);
    world_.position.set(ball, place(ball));
  }

  void take_off() {
    if constexpr (Traits::kAccelerates) return;
    for (const std::uint32_t ball : landed_) {
      // So far back that its place would be rounded too much.
      if (near_.cruise().times(world_, ball) > Cruise<kDim>::kMostTimes) return land_all();
    }
    for (const std::uint32_t ball : landed_) world_.position.set(ball, world_.place_after(-flown_s_, ball));
    for (const std::uint32_t ball : landed_) {
      if (near_.cruise().times(world_, ball) > 1.0) hurry(ball);
    }
    if constexpr (!Traits::kAccelerates) {
      if (near_.holds()) near_.expect_anew(world_, flown_s_, landed_);
    }
  }

  /// Ends the list of pairs where balls have landed already that are hit.
  void land_all() {
    landed_at_.clear();
    for (const std::uint32_t ball : landed_) landed_at_.push_back(world_.position[ball]);
    world_.fly(flown_s_, threads_);
    flown_s_ = 0.0;
    for (std::size_t k = 0; k < landed_.size(); ++k) world_.position.set(landed_[k], landed_at_[k]);
    near_.end();
  }

  /// Where fields act the speeds of all are measured in every step.
  void hurry(std::uint32_t ball) {
    near_.hurry(world_, planes_, ball,
                {.way_m = 0.0, .cruisers_way_m = 0.0, .times = near_.cruise().times(world_, ball)},
                [this](std::size_t any) { return place(any); });
  }

  void resolve_impacts() {
    if (cluster_law_) {
      resolve_clusters();
      return;
    }
    bool approaching = !touches_.empty();
    for (int sweep = 0; sweep < kMostSweeps && approaching; ++sweep) {
      approaching = false;
      for (const Touch& touch : touches_) {
        approaching = (touch.plane ? hit_plane(touch, sweep) : hit_ball(touch, sweep)) || approaching;
      }
    }
  }

  /// Returns whether the balls approached.
  bool hit_ball(const Touch& touch, int sweep) {
    const Place normal = normal_between<kDim>(world_.position[touch.a], world_.position[touch.b]);
    const double v_n = normal.dot(world_.velocity[touch.b] - world_.velocity[touch.a]);
    const double speeds = world_.velocity[touch.a].norm() + world_.velocity[touch.b].norm();
    if (v_n >= -velocity_rounding(speeds)) return false;
    count(v_n, sweep);
    const Place impulse =
        Law::template between<kDim>(world_, touch.a, touch.b, normal, rebounding(surface_, v_n));
    account_.template book_pair<Law::kFriction>(world_, touch.a, touch.b, normal, impulse);
    if constexpr (Law::kFriction) {
      if (!is_fixed(touch.a) && !is_fixed(touch.b)) {
        account_.book_moment(gap_between(touch.a, touch.b) * normal, impulse);
      }
    }
    return true;
  }

  bool hit_plane(const Touch& touch, int sweep) {
    const Plane<kDim>& plane = planes_[touch.b];
    if constexpr (Traits::kSheets) {
      if (!plane.faces(world_.position[touch.a])) return false;  // it has passed in an earlier sweep
    }
    const double v_n = plane.normal.dot(world_.velocity[touch.a]);
    if (v_n >= -velocity_rounding(world_.velocity[touch.a].norm())) return false;
    count(v_n, sweep);
    if constexpr (Traits::kSheets) {
      if (plane.barrier != kSolid) {
        const Place before = world_.position[touch.a];
        barriers_.meet(world_, touch.a, plane, account_);
        near_.jumped(touch.a, (world_.position[touch.a] - before).norm());
        return true;
      }
    }
    const Place impulse =
        Law::template on_wall<kDim>(world_, touch.a, plane.normal, rebounding(wall_surface_, v_n));
    if (is_impact(v_n, sweep)) ++account_.tally.wall_impacts;
    account_.template book_plane<Law::kFriction>(world_, touch.a, plane.normal, impulse);
    return true;
  }

  /// Rest has no rebound.
  Contact rebounding(Contact surface, double v_n) const {
    if (-v_n <= field_speed_ && surface.restitution < 1.0) surface.restitution = 0.0;
    return surface;
  }

  void count(double v_n, int sweep) {
    if (is_impact(v_n, sweep)) ++account_.tally.impacts;
  }

  bool is_impact(double v_n, int sweep) const { return sweep == 0 && -v_n > field_speed_; }

  // --- contacts that hang together, under a law for several at once

  void resolve_clusters() {
    root_.resize(world_.size());
    std::iota(root_.begin(), root_.end(), 0U);
    for (const Touch& touch : touches_) {
      // Immovable balls and planes pass nothing on.
      if (touch.plane || world_.inverse_mass[touch.a] * world_.inverse_mass[touch.b] == 0.0) continue;
      const std::uint32_t one = root_of(touch.a);
      const std::uint32_t other = root_of(touch.b);
      world_.before(one, other) ? root_[other] = one : root_[one] = other;
    }
    const auto cluster_of = [this](const Touch& touch) {
      return world_.number_of(root_of(touch.plane || world_.inverse_mass[touch.a] > 0.0 ? touch.a : touch.b));
    };
    std::stable_sort(touches_.begin(), touches_.end(),
                     [&](const Touch& x, const Touch& y) { return cluster_of(x) < cluster_of(y); });
    for (std::size_t begin = 0; begin < touches_.size();) {
      std::size_t end = begin;
      while (end < touches_.size() && cluster_of(touches_[end]) == cluster_of(touches_[begin])) ++end;
      resolve_cluster(begin, end);
      begin = end;
    }
  }

  std::uint32_t root_of(std::uint32_t ball) const {
    while (root_[ball] != ball) ball = root_[ball];
    return ball;
  }

  void resolve_cluster(std::size_t begin, std::size_t end) {
    contacts_.clear();
    bool approaching = false;
    for (std::size_t k = begin; k < end; ++k) {
      const Touch& touch = touches_[k];
      const Place normal = touch.plane
                               ? planes_[touch.b].normal
                               : normal_between<kDim>(world_.position[touch.a], world_.position[touch.b]);
      const Place v =
          touch.plane ? world_.velocity[touch.a] : Place(world_.velocity[touch.b] - world_.velocity[touch.a]);
      const double v_n = normal.dot(v);
      approaching = approaching || v_n < 0.0;
      const Contact surface = rebounding(touch.plane ? wall_surface_ : surface_, v_n);
      contacts_.push_back({touch.a, touch.b, touch.plane, normal, surface.restitution});
      if (v_n < 0.0) count(v_n, 0);
    }
    if (!approaching) return;
    account_.open_contacts(world_, contacts_);
    cluster_law_->resolve(world_, contacts_);
    account_.book_contacts(world_, contacts_);
  }

  // --- position correction

  /// Moves apart what overlaps, contact by contact.
  void separate() {
    constexpr std::size_t kAhead = 8;
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      const Touch& touch = touches_[k];
      const Touch& soon = touches_[std::min(k + kAhead, touches_.size() - 1)];
      near_.fetch_jump(soon.a);
      if (!soon.plane) near_.fetch_jump(soon.b);
      if (touch.plane) {
        const Plane<kDim>& plane = planes_[touch.b];
        const double gap = plane.gap(world_.position[touch.a], world_.radius[touch.a]);
        if (gap >= 0.0 || !plane.faces(world_.position[touch.a])) continue;
        shift(touch.a, -gap * plane.normal);
      } else {
        separate_balls(touch.a, touch.b);
      }
    }
  }

  void separate_balls(std::uint32_t a, std::uint32_t b) {
    const double gap = gap_between(a, b);
    if (gap >= 0.0) return;
    const Place normal = normal_between<kDim>(world_.position[a], world_.position[b]);
    const double share = gap / (world_.inverse_mass[a] + world_.inverse_mass[b]);
    if (!is_fixed(a)) shift(a, (share * world_.inverse_mass[a]) * normal);
    if (!is_fixed(b)) shift(b, -(share * world_.inverse_mass[b]) * normal);
  }

  /// Puts a movable ball somewhere else, with the velocity that it has; under gravity that changes its
  /// energy.
  void shift(std::uint32_t ball, const Place& way) {
    world_.position.set(ball, world_.position[ball] + way);
    near_.jumped(ball, way.norm());
    account_.book_moment(way, world_.velocity[ball] / world_.inverse_mass[ball]);
    if constexpr (Traits::kAccelerates) {
      account_.tally.energy.correction_J -= gravity_.dot(way) / world_.inverse_mass[ball];
    }
  }

  bool is_fixed(std::uint32_t ball) const { return world_.inverse_mass[ball] == 0.0; }

  double gap_between(std::uint32_t a, std::uint32_t b) const {
    return (world_.position[b] - world_.position[a]).norm() - world_.radius[a] - world_.radius[b];
  }

  Threads threads_;
  World<kDim> world_;
  std::unique_ptr<Flight<kDim>> flight_;
  std::unique_ptr<ClusterLaw<kDim>> cluster_law_;
  PairList<kDim, Traits::kAccelerates> near_;
  std::vector<Plane<kDim>> planes_;
  Barriers<kDim> barriers_;
  Contact surface_;
  Contact wall_surface_;
  Place gravity_;  ///< m/s²
  VectorColumn<kDim> acceleration_;
  double flown_s_ = 0.0;      ///< for how long balls have flown from where they stand in memory
  double field_speed_ = 0.0;  ///< m/s, what the strongest acceleration gives in a step
  double fastest_ = 0.0;      ///< m/s, no ball is faster; where fields act
  Account<kDim> account_;

  std::vector<Touch> touches_;
  std::vector<std::uint32_t> landed_;
  std::vector<bool> is_landed_;  ///< of each ball, while balls land
  std::vector<Place> landed_at_;
  std::vector<std::uint32_t> root_;
  std::vector<ClosedContact<kDim>> contacts_;
};

}  // namespace carom
