#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "carom/broad_phase/pair_list.h"
#include "carom/broad_phase/reach.h"
#include "carom/effects/barrier.h"
#include "carom/effects/slab.h"
#include "carom/evolvers/parts.h"
#include "carom/evolvers/resting.h"
#include "carom/evolvers/touch.h"
#include "carom/evolvers/touch_clusters.h"
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
        touched_(world_.size()) {
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
      settle_isolated();
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

  /// So many contacts before one is looked at its balls are fetched from memory.
  static constexpr std::size_t kAhead = 8;

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
    const std::span<const BallPair> besides = near_.besides();
    threads_.collect(besides.size(), touches_,
                     [&](std::size_t begin, std::size_t end, std::vector<Touch>& found) {
                       for (const auto& [ball, plane] : besides.subspan(begin, end - begin)) {
                         touch_plane(ball, plane, found);
                       }
                     });
    // The list is in an order of its own; the order of the contacts decides what happens.
    threads_.sort(touches_);
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
    found.push_back(Touch::of_balls(a, b, world_.number_of(a), world_.number_of(b)));
  }

  void touch_plane(std::uint32_t ball, std::uint32_t plane, std::vector<Touch>& found) const {
    if (planes_[plane].gap(place(ball), world_.radius[ball]) > 0.0) return;
    if constexpr (Traits::kSheets) {
      if (!planes_[plane].faces(place(ball))) return;
    }
    if (world_.inverse_mass[ball] == 0.0) return;
    found.push_back(Touch::of_plane(ball, plane, world_.number_of(ball)));
  }

  // --- balls in contact
  // Where balls fly straight they stand in memory where they were when the list of pairs was made, or would
  // have been: one that is hit lands, and takes off from where its new flight would have begun.

  void land() {
    touched_.note(touches_);
    if constexpr (Traits::kAccelerates) return;
    for_each_touched([this](std::uint32_t ball) { world_.position.set(ball, place(ball)); });
  }

  void take_off() {
    if constexpr (!Traits::kAccelerates) {
      find_faster();
      for (const std::uint32_t ball : faster_) {
        // So far back that its place would be rounded too much.
        if (near_.cruise().times(world_, ball) > Cruise<kDim>::kMostTimes) return land_all();
      }
      for_each_touched(
          [this](std::uint32_t ball) { world_.position.set(ball, world_.place_after(-flown_s_, ball)); });
      for (const std::uint32_t ball : faster_) hurry(ball);
      if (near_.holds()) near_.expect_anew(world_, flown_s_, touched_.balls());
    }
  }

  /// Which balls in contact are faster than cruising.
  void find_faster() {
    const std::span<const std::uint32_t> balls = touched_.balls();
    faster_.clear();
    threads_.collect(balls.size(), faster_,
                     [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& found) {
                       for (const std::uint32_t ball : balls.subspan(begin, end - begin)) {
                         if (near_.cruise().times(world_, ball) > 1.0) found.push_back(ball);
                       }
                     });
  }

  template <class At>
  void for_each_touched(const At& at) {
    const std::span<const std::uint32_t> balls = touched_.balls();
    threads_.in_parallel(balls.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        world_.fetch(balls[std::min(k + kAhead, end - 1)]);
        at(balls[k]);
      }
    });
  }

  /// Ends the list of pairs where balls have landed already that are hit.
  void land_all() {
    const std::span<const std::uint32_t> balls = touched_.balls();
    landed_at_.clear();
    for (const std::uint32_t ball : balls) landed_at_.push_back(world_.position[ball]);
    world_.fly(flown_s_, threads_);
    flown_s_ = 0.0;
    for (std::size_t k = 0; k < balls.size(); ++k) world_.position.set(balls[k], landed_at_[k]);
    near_.end();
  }

  /// Where fields act the speeds of all are measured in every step.
  void hurry(std::uint32_t ball) {
    near_.hurry(world_, planes_, ball,
                {.way_m = 0.0, .cruisers_way_m = 0.0, .times = near_.cruise().times(world_, ball)},
                [this](std::size_t any) { return place(any); });
  }

  // --- impacts

  /// An isolated contact, whose balls are in no other, neither changes anything for another one nor is
  /// changed by it. In a gas almost all are isolated: threads share them, and each is done with while its
  /// balls are at hand. What is left has more than one contact to a ball, and an order.
  void settle_isolated() {
    if (cluster_law_) return;  // which has a solution of its own for one contact, too
    near_.expect_jumps();
    isolated_.clear();
    const auto is_isolated = [this](const Touch& touch) { return touched_.is_isolated(touch); };
    std::copy_if(touches_.begin(), touches_.end(), std::back_inserter(isolated_), is_isolated);
    std::erase_if(touches_, is_isolated);
    // Accounts are of so many contacts however many threads there are: the sum is the same to the bit.
    constexpr std::size_t kOfAnAccount = 64;
    const std::size_t count = (isolated_.size() + kOfAnAccount - 1) / kOfAnAccount;
    accounts_.clear();
    threads_.collect(count, accounts_,
                     [&](std::size_t begin, std::size_t end, std::vector<Account<kDim>>& found) {
                       for (std::size_t k = begin; k < end; ++k) {
                         const std::size_t first = k * kOfAnAccount;
                         found.push_back(settle(first, std::min(first + kOfAnAccount, isolated_.size())));
                       }
                     });
    for (const Account<kDim>& each : accounts_) account_.add(each);
  }

  /// Of isolated contacts from one up to, but without, another.
  Account<kDim> settle(std::size_t begin, std::size_t end) {
    Account<kDim> account;
    for (std::size_t k = begin; k < end; ++k) {
      fetch(isolated_[std::min(k + kAhead, isolated_.size() - 1)]);
      int sweep = 0;
      while (sweep < kMostSweeps && hit(isolated_[k], sweep, account)) ++sweep;
      separate(isolated_[k], account);
    }
    return account;
  }

  void resolve_impacts() {
    if (cluster_law_) {
      clusters_.for_each(world_, touches_,
                         [this](std::span<const Touch> together) { resolve_cluster(together); });
      return;
    }
    bool approaching = !touches_.empty();
    for (int sweep = 0; sweep < kMostSweeps && approaching; ++sweep) {
      approaching = false;
      for (const Touch& touch : touches_) {
        approaching = hit(touch, sweep, account_) || approaching;
      }
    }
  }

  /// Returns whether they approached.
  bool hit(const Touch& touch, int sweep, Account<kDim>& account) {
    return touch.plane() ? hit_plane(touch, sweep, account) : hit_ball(touch, sweep, account);
  }

  bool hit_ball(const Touch& touch, int sweep, Account<kDim>& account) {
    const Place normal = normal_between<kDim>(world_.position[touch.a], world_.position[touch.b]);
    const double v_n = normal.dot(world_.velocity[touch.b] - world_.velocity[touch.a]);
    const double speeds = world_.velocity[touch.a].norm() + world_.velocity[touch.b].norm();
    if (v_n >= -velocity_rounding(speeds)) return false;
    count(v_n, sweep, account);
    const Place impulse =
        Law::template between<kDim>(world_, touch.a, touch.b, normal, rebounding(surface_, v_n));
    account.template book_pair<Law::kFriction>(world_, touch.a, touch.b, normal, impulse);
    if constexpr (Law::kFriction) {
      if (!is_fixed(touch.a) && !is_fixed(touch.b)) {
        account.book_moment(gap_between(touch.a, touch.b) * normal, impulse);
      }
    }
    return true;
  }

  bool hit_plane(const Touch& touch, int sweep, Account<kDim>& account) {
    const Plane<kDim>& plane = planes_[touch.b];
    if constexpr (Traits::kSheets) {
      if (!plane.faces(world_.position[touch.a])) return false;  // it has passed in an earlier sweep
    }
    const double v_n = plane.normal.dot(world_.velocity[touch.a]);
    if (v_n >= -velocity_rounding(world_.velocity[touch.a].norm())) return false;
    count(v_n, sweep, account);
    if constexpr (Traits::kSheets) {
      if (plane.barrier != kSolid) {
        const Place before = world_.position[touch.a];
        barriers_.meet(world_, touch.a, plane, account);
        near_.jumped(touch.a, (world_.position[touch.a] - before).norm());
        return true;
      }
    }
    const Place impulse =
        Law::template on_wall<kDim>(world_, touch.a, plane.normal, rebounding(wall_surface_, v_n));
    if (is_impact(v_n, sweep)) ++account.tally.wall_impacts;
    account.template book_plane<Law::kFriction>(world_, touch.a, plane.normal, impulse);
    return true;
  }

  /// Rest has no rebound.
  Contact rebounding(Contact surface, double v_n) const {
    if (-v_n <= field_speed_ && surface.restitution < 1.0) surface.restitution = 0.0;
    return surface;
  }

  void count(double v_n, int sweep, Account<kDim>& account) const {
    if (is_impact(v_n, sweep)) ++account.tally.impacts;
  }

  bool is_impact(double v_n, int sweep) const { return sweep == 0 && -v_n > field_speed_; }

  /// By a law for several contacts at once. @pre they hang together
  void resolve_cluster(std::span<const Touch> touches) {
    contacts_.clear();
    bool approaching = false;
    for (const Touch& touch : touches) {
      const Place normal = touch.plane()
                               ? planes_[touch.b].normal
                               : normal_between<kDim>(world_.position[touch.a], world_.position[touch.b]);
      const Place v = touch.plane() ? world_.velocity[touch.a]
                                    : Place(world_.velocity[touch.b] - world_.velocity[touch.a]);
      const double v_n = normal.dot(v);
      approaching = approaching || v_n < 0.0;
      const Contact surface = rebounding(touch.plane() ? wall_surface_ : surface_, v_n);
      contacts_.push_back({touch.a, touch.b, touch.plane(), normal, surface.restitution});
      if (v_n < 0.0) count(v_n, 0, account_);
    }
    if (!approaching) return;
    account_.open_contacts(world_, contacts_);
    cluster_law_->resolve(world_, contacts_);
    account_.book_contacts(world_, contacts_);
  }

  // --- position correction

  /// Moves apart what overlaps, contact by contact.
  void separate() {
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      fetch(touches_[std::min(k + kAhead, touches_.size() - 1)]);
      separate(touches_[k], account_);
    }
  }

  /// Has the processor load what is asked about the balls of a contact.
  void fetch(const Touch& touch) const {
    world_.fetch(touch.a);
    near_.fetch_jump(touch.a);
    if (touch.plane()) return;
    world_.fetch(touch.b);
    near_.fetch_jump(touch.b);
  }

  void separate(const Touch& touch, Account<kDim>& account) {
    if (!touch.plane()) return separate_balls(touch.a, touch.b, account);
    const Plane<kDim>& plane = planes_[touch.b];
    const double gap = plane.gap(world_.position[touch.a], world_.radius[touch.a]);
    if (gap >= 0.0 || !plane.faces(world_.position[touch.a])) return;
    shift(touch.a, -gap * plane.normal, account);
  }

  void separate_balls(std::uint32_t a, std::uint32_t b, Account<kDim>& account) {
    const double gap = gap_between(a, b);
    if (gap >= 0.0) return;
    const Place normal = normal_between<kDim>(world_.position[a], world_.position[b]);
    const double share = gap / (world_.inverse_mass[a] + world_.inverse_mass[b]);
    if (!is_fixed(a)) shift(a, (share * world_.inverse_mass[a]) * normal, account);
    if (!is_fixed(b)) shift(b, -(share * world_.inverse_mass[b]) * normal, account);
  }

  /// Puts a movable ball somewhere else, with the velocity that it has; under gravity that changes its
  /// energy.
  void shift(std::uint32_t ball, const Place& way, Account<kDim>& account) {
    world_.position.set(ball, world_.position[ball] + way);
    near_.jumped(ball, way.norm());
    account.book_moment(way, world_.velocity[ball] / world_.inverse_mass[ball]);
    if constexpr (Traits::kAccelerates) {
      account.tally.energy.correction_J -= gravity_.dot(way) / world_.inverse_mass[ball];
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
  std::vector<Touch> isolated_;
  std::vector<Account<kDim>> accounts_;  ///< of isolated contacts
  TouchedBalls touched_;
  std::vector<std::uint32_t> faster_;
  std::vector<Place> landed_at_;
  TouchClusters<kDim> clusters_;
  std::vector<ClosedContact<kDim>> contacts_;
};

}  // namespace carom
