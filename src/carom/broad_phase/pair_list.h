#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "carom/broad_phase/broad_phase.h"
#include "carom/broad_phase/cruise.h"
#include "carom/broad_phase/due_pairs.h"
#include "carom/broad_phase/flying_pairs.h"
#include "carom/broad_phase/for_each_passing.h"
#include "carom/broad_phase/listed_neighbours.h"
#include "carom/plane.h"
#include "carom/world.h"
#include "core/prefetch.h"

namespace carom {

/// What a list has: pairs that may touch while it lives, or just all.
enum class Listed { kNear, kAll };

/// The pairs of balls, and of balls and planes, that may touch before long: a list that serves many steps.
///
/// The trick: a broad phase is asked for all pairs that come as near as the sum of their radii and a *skin*
/// s. Until some ball has moved by s/2 no other pair can touch, for two balls come nearer to each other by at
/// most s. So the list is made anew only when the longest way that a ball may have gone comes to s/2; and
/// that way is known from a speed, without a look at any ball. Source: L. Verlet, Phys. Rev. 159, 98 (1967).
///
/// Which of the listed pairs are due in a step is known as well. Where fields act a pair with a gap g between
/// its balls is not due before balls may have gone g/2 (due_pairs.h). Where none do it is due when its balls
/// touch if neither is hit; and whom a ball that was hit is listed with is noted (flying_pairs.h).
///
/// Were ways counted at the speed of the fastest ball, lists would live the shorter the more balls there are,
/// for the sake of a few. So it is a cruising speed that few balls exceed. The list has, of each of these,
/// all the pairs that it may get to until the list ends; and one that an impact made fast adds its own.
///
/// What is listed decides what is looked at, never what happens: with kAll all pairs are, in every step. That
/// is the slow twin, and tests hold both to the same bits. How long a list lives does not depend on it, nor
/// on the broad phase, the order of the balls in memory, or the number of threads, for it decides in which
/// pieces balls that fly straight are moved.
template <int Dim, bool kFieldsAct>
class PairList {
 public:
  PairList(std::unique_ptr<BroadPhase<Dim>> broad_phase, Listed listed, const Threads& threads)
      : broad_phase_(std::move(broad_phase)), listed_(listed), threads_(threads) {}

  /// Whether balls can touch only in pairs that the list has while those that cruise go this much farther, m.
  bool holds(double way_m = 0.0) const { return gone_m(way_m) <= enough_m_; }

  /// No ball that cruises has gone farther than this, m, in so long.
  void travelled(double way_m, double duration_s) {
    travelled_m_ += way_m * kRoundUp + rounding_m_;
    time_s_ += duration_s;
  }

  /// Before threads say at once that balls jumped. @pre the list was made
  void expect_jumps() {
    if (jumps_m_.empty()) jumps_m_.resize(bound_.size(), 0.0F);
  }

  /// A ball was put this far away, m, beside what it travels. Once expect_jumps() was called threads may say
  /// so at once, each of other balls.
  void jumped(std::size_t ball, double way_m) {
    expect_jumps();
    jumps_m_[ball] = static_cast<float>((static_cast<double>(jumps_m_[ball]) + way_m) * kRoundUp);
    const double jump_m = jumps_m_[ball];
    double farthest_m = farthest_jump_m_;
    while (jump_m > farthest_m && !farthest_jump_m_.compare_exchange_weak(farthest_m, jump_m)) {
    }
  }

  /// Has the processor load what is asked when the ball has jumped.
  void fetch_jump(std::size_t ball) const {
    if (!jumps_m_.empty()) prefetch(&jumps_m_[ball]);
  }

  /// Nothing holds any more.
  void end() { enough_m_ = kNothingHolds; }

  /// Whether balls have left the order in which they were sorted, or never were.
  bool is_out_of_order() const { return builds_in_this_order_ >= kBuildsInAnOrder; }

  /// Before build(), and where they are out of order: ends the list and sorts the balls in memory, so that
  /// those that are looked at together are loaded together. @pre they stand in memory where they are
  void sort(World<Dim>& world) {
    if (!is_out_of_order() || world.size() == 0) return;
    if (bound_.empty()) find_first_skin(world);
    builds_in_this_order_ = 0;
    end();
    Column<std::uint32_t> order;
    broad_phase_->hand_over_order(order);
    if (order.empty()) return;
    pairs_ = {};
    neighbours_ = {};
    world.reorder(order, threads_);
  }

  /// Before build(), where balls keep their speeds between impacts: chooses the cruising speed.
  void measure_speeds(const World<Dim>& world) { cruise_.measure(world, threads_); }

  /// Those that an impact makes faster have to hurry().
  const Cruise<Dim>& cruise() const { return cruise_; }

  /// Whether the next list will serve more than a step or two in which balls go this far, m.
  bool may_last(double way_m) const { return 2.0 * way_m <= next_half_skin_m_; }

  /// Makes the list. @pre balls stand in memory where they are, and the speeds are as they were measured
  /// @param step_s  how long steps will be
  void build(const World<Dim>& world, const std::vector<Plane<Dim>>& planes, double step_s) {
    build_for_a_step(world, planes, step_s, [](std::size_t) { return 0.0; });
    if constexpr (kFieldsAct) {
      if (listed_ == Listed::kNear) sort_by_stages(world);
    }
  }

  /// The same for a step in which balls may go farther than for the list to last.
  /// @param way_m  of each ball, how far the list must hold at least, m
  template <class Way>
  void build_for_a_step(const World<Dim>& world, const std::vector<Plane<Dim>>& planes, double step_s,
                        const Way& way_m) {
    find_pairs(world, way_m);
    forget_ways();
    choose_skin(world);
    if constexpr (!kFieldsAct) add_pairs_of_faster(world, way_m);
    find_planes(world, planes);
    if (listed_ == Listed::kAll) list_all(world.size());
    if constexpr (!kFieldsAct) {
      if (listed_ == Listed::kNear) {
        pairs_.begin(world, step_s, std::max(step_s, half_skin_m_ / cruise_.mps()), rounding_m_, threads_);
      }
      note_neighbours(world);
    }
    ++builds_in_this_order_;
  }

  /// After build(): notes whom each ball is listed with. Where no fields act that is done already.
  void note_neighbours(const World<Dim>& world) { neighbours_.note(world.size(), pairs_.all(), threads_); }

  /// Whom a ball may touch while the list lives. @pre they are noted
  const ListedNeighbours& neighbours() const { return neighbours_; }

  /// How far a ball goes at most, m, while those that cruise go so far; and from then on, so many times as
  /// far as they.
  struct Haste {
    double way_m;
    double cruisers_way_m;
    double times;
  };

  /// The ball may be faster than the list allows for: adds what pairs it may get to until the list ends, or
  /// ends the list after the step at hand. Where fields act pairs that the list has are added again: they may
  /// not be due. Where none do its pairs are due once they are asked for, by expect_anew().
  /// @param place_of  where a ball is, or was since the list was made
  template <class PlaceOf>
  void hurry(const World<Dim>& world, const std::vector<Plane<Dim>>& planes, std::size_t ball,
             const Haste& haste, const PlaceOf& place_of) {
    if (haste.times <= 1.0 && holds(haste.cruisers_way_m)) return;
    if (haste.times > Cruise<Dim>::kMostTimes) end();
    const double left_m = std::max(0.0, half_skin_m_ - travelled_m_ - haste.cruisers_way_m);
    const double later_m = enough_m_ == kNothingHolds ? 0.0 : haste.times * left_m;
    const double soon_m = gone(world, ball) + haste.way_m;
    const float bound = rounded_up(world.radius[ball] + (soon_m + later_m) * kRoundUp + 2.0 * rounding_m_);
    if (!(bound > bound_[ball])) return;
    bound_[ball] = bound;
    if (++hurried_ > Cruise<Dim>::few(world.size())) end();
    if (listed_ == Listed::kAll) return;
    broad_phase_->bound_grew(ball);
    // Bounds are around where balls were when the list was made: this far away at most.
    add_pairs(world, ball, {place_of(ball), bound + soon_m}, place_of);
    for (std::uint32_t plane = 0; plane < planes.size(); ++plane) {
      if (planes[plane].gap(place_of(ball), bound + soon_m) > 0.0) continue;
      besides_.emplace_back(static_cast<std::uint32_t>(ball), plane);
    }
  }

  /// Calls at(a, b, found) for pairs that pass the test, by may_touch(a, b), of those that may touch while
  /// balls that cruise go this much farther, in so long. Some come twice.
  /// @tparam kAhead  so many pairs before one is tested its balls are fetched from memory, if that pays
  template <std::size_t kAhead, class Found, class Test, class At>
  void for_each_due(const World<Dim>& world, double way_m, double duration_s, Found& found,
                    const Test& may_touch, const At& at) {
    std::span<const BallPair> pairs = pairs_.all();
    const auto test = [&](std::size_t begin, std::size_t end, Found& own) {
      for_each_passing(
          begin, end,
          [&](std::size_t k) {
            if constexpr (kAhead > 0) fetch(world, pairs[std::min(k + kAhead, pairs.size() - 1)]);
            return may_touch(pairs[k].first, pairs[k].second);
          },
          [&](std::size_t k) { at(pairs[k].first, pairs[k].second, own); });
    };
    if constexpr (kFieldsAct) {
      pairs_.test(stage_at(gone_m(way_m) + 2.0 * rounding_m_), threads_, found, test);
    } else {
      if (listed_ == Listed::kNear) pairs = pairs_.take(time_s_ + duration_s);
      // Those asked last stand at the end, and their balls nowhere near each other in memory.
      threads_.collect_dealt(pairs.size(), found, test);
    }
  }

  /// After a step at whose end the list holds: when pairs are due that were due in it, and those of balls
  /// that have been hit.
  /// @param flown_s  how long balls have flown from where they stand in memory
  void expect_anew(const World<Dim>& world, double flown_s,
                   std::span<const std::uint32_t> hit) requires(!kFieldsAct) {
    if (listed_ == Listed::kAll) return;
    pairs_.expect_anew(world, time_s_, flown_s, hit, neighbours_, threads_);
  }

  /// A ball and a plane that may touch; some stand here twice.
  std::span<const BallPair> besides() const { return besides_; }

  std::string_view name() const { return broad_phase_->name(); }

 private:
  /// Pairs that the skin adds for each ball: more of them make every step dearer, fewer make lists shorter
  /// lived. Measured, SPEED.md.
  static constexpr double kMorePairs = 0.75;
  /// The first guess of half the skin, by the balls' mean radius; and by how much a better one is larger that
  /// is tried as well.
  static constexpr double kFirstGuess = 0.2;
  static constexpr double kMuchLarger = 1.25;
  static constexpr int kMostGuesses = 8;
  /// Lists after which balls have left the order in which they were sorted.
  static constexpr int kBuildsInAnOrder = 16;
  /// For sums of ways, those of floats included: each addition is off by 2⁻²⁴ at most.
  static constexpr double kRoundUp = 1.0 + 0x1p-20;
  static constexpr double kNothingHolds = -1.0;

  /// How far balls that cruise, or jumped, have gone at most once they have gone this much farther, m.
  double gone_m(double way_m) const { return (travelled_m_ + way_m) * kRoundUp + farthest_jump_m_; }

  /// The stage of the list's life at which they have gone this far.
  std::size_t stage_at(double gone_m) const {
    const double last = static_cast<double>(DuePairs::kStages) - 1.0;
    return gone_m < half_skin_m_
               ? static_cast<std::size_t>(std::min(last, gone_m / half_skin_m_ * (last + 1.0)))
               : DuePairs::kStages - 1;
  }

  /// Has the processor load what is asked about two balls when they are due. Where no fields act, they touch
  /// as a rule.
  static void fetch(const World<Dim>& world, const BallPair& pair) {
    for (const std::uint32_t ball : {pair.first, pair.second}) {
      world.fetch(ball);
      if constexpr (!kFieldsAct) world.fetch_number(ball);
    }
  }

  /// Makes lists that nobody uses, until one has the skin that it should have had.
  void find_first_skin(const World<Dim>& world) {
    double radii = 0.0;
    for (std::size_t i = 0; i < world.size(); ++i) radii += world.radius[i];
    diameter_m_ = 2.0 * radii / static_cast<double>(world.size());
    next_half_skin_m_ = 0.5 * kFirstGuess * diameter_m_;
    for (int guess = 0; guess < kMostGuesses; ++guess) {
      find_pairs(world, [](std::size_t) { return 0.0; });
      choose_skin(world);
      if (next_half_skin_m_ <= kMuchLarger * half_skin_m_) return;
    }
  }

  float bound_for(const World<Dim>& world, std::size_t ball, double way_m) const {
    return rounded_up(world.radius[ball] + std::max(half_skin_m_, way_m));
  }

  template <class Way>
  void find_pairs(const World<Dim>& world, const Way& way_m) {
    half_skin_m_ = next_half_skin_m_;
    const std::span<const double> places = world.position.components(0, world.size());
    farthest_m_ = threads_.largest(places.size(), [&](std::size_t k) { return std::abs(places[k]); });
    bound_.resize(world.size());
    threads_.in_parallel(world.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) bound_[i] = bound_for(world, i, way_m(i));
    });
    broad_phase_->build(world.position, bound_, threads_);
    broad_phase_->find_pairs(pairs_.find(), threads_);
  }

  /// Lists what those add that are faster than cruising. The broad phase did not know of it: for the sake of
  /// a few its cells would be wider.
  template <class Way>
  void add_pairs_of_faster(const World<Dim>& world, const Way& way_m) {
    const std::span<const std::uint32_t> faster = cruise_.faster();
    for (const std::uint32_t ball : faster) widen_for_speed(world, ball);
    if (listed_ == Listed::kAll) return;
    threads_.collect(faster.size(), pairs_.find(),
                     [&](std::size_t begin, std::size_t end, Column<BallPair>& found) {
                       std::vector<std::uint32_t> near;
                       for (const std::uint32_t ball : faster.subspan(begin, end - begin)) {
                         broad_phase_->find_near({world.position[ball], bound_[ball]}, near);
                         add_new_pairs(world, way_m, ball, near, found);
                       }
                     });
  }

  /// Gives a ball the bound that it needs at its speed until the list ends.
  void widen_for_speed(const World<Dim>& world, std::uint32_t ball) {
    const double all_the_way_m = cruise_.times(world, ball) * half_skin_m_;
    const float bound = rounded_up(world.radius[ball] + all_the_way_m * kRoundUp + 2.0 * rounding_m_);
    if (!(bound > bound_[ball])) return;
    bound_[ball] = bound;
    ++hurried_;
    broad_phase_->bound_grew(ball);
  }

  /// The pairs of a ball with these others that may meet by bounds as they are, and by bound_for() did not;
  /// of two balls whose bounds grew, the first has the pair.
  template <class Way>
  void add_new_pairs(const World<Dim>& world, const Way& way_m, std::uint32_t ball,
                     std::span<const std::uint32_t> others, Column<BallPair>& found) const {
    const auto now = [&](std::uint32_t i) { return Reach<Dim>{world.position[i], bound_[i]}; };
    const auto before = [&](std::uint32_t i) {
      return Reach<Dim>{world.position[i], bound_for(world, i, way_m(i))};
    };
    for (const std::uint32_t other : others) {
      const bool listed = may_meet(before(ball), before(other));
      const bool lists_it = other < ball && bound_[other] > before(other).bound;
      if (listed || lists_it || !may_meet(now(ball), now(other))) continue;
      found.emplace_back(std::min(ball, other), std::max(ball, other));
    }
  }

  void sort_by_stages(const World<Dim>& world) {
    pairs_.sort(world.size(), [&](const BallPair& pair) {
      const auto [a, b] = pair;
      const double gap = (world.position[a] - world.position[b]).norm() - world.radius[a] - world.radius[b];
      return stage_at(0.5 * std::max(0.0, gap));
    });
  }

  void list_all(std::size_t balls) {
    Column<BallPair>& pairs = pairs_.find();
    pairs.clear();
    for (std::uint32_t b = 1; b < balls; ++b) {
      for (std::uint32_t a = 0; a < b; ++a) pairs.emplace_back(a, b);
    }
  }

  /// For the next list: half the skin that would have added kMorePairs for each ball to the pairs that touch,
  /// had this list been made with it: with n balls in a unit of space around each, ½ n C R^Dim pairs are
  /// nearer than R.
  void choose_skin(const World<Dim>& world) {
    if (world.size() == 0) return;
    const double volume = std::pow(diameter_m_ + 2.0 * half_skin_m_, Dim);
    const double pairs_per_ball =
        static_cast<double>(pairs_.all().size() + 1) / static_cast<double>(world.size());
    const double wanted = std::pow(diameter_m_, Dim) + kMorePairs / pairs_per_ball * volume;
    const double half_skin_m = 0.5 * (std::pow(wanted, 1.0 / Dim) - diameter_m_);
    // Where hardly any pairs are found it would grow without end.
    const double most_m = std::min(2.0 * half_skin_m_, diameter_m_ + farthest_m_);
    next_half_skin_m_ = std::min(std::max(half_skin_m, 0.5 * half_skin_m_), most_m);
  }

  /// How far a ball has gone at most since the list was made, m. In the share of the list's life that is over
  /// it has gone no more than that share of what it is allowed: one that became fast later had gone less
  /// before.
  double gone(const World<Dim>& world, std::size_t ball) const {
    const double jump_m = jumps_m_.empty() ? 0.0 : static_cast<double>(jumps_m_[ball]);
    if (travelled_m_ == 0.0) return jump_m;
    const double over = travelled_m_ < half_skin_m_ ? travelled_m_ / half_skin_m_ : 1.0;
    return over * (bound_[ball] - world.radius[ball]) + jump_m;
  }

  /// The pairs of a ball with all others whose bounds come into this reach.
  template <class PlaceOf>
  void add_pairs(const World<Dim>& world, std::size_t ball, const Reach<Dim>& reach,
                 const PlaceOf& place_of) {
    broad_phase_->find_near(reach, near_);
    for (const std::uint32_t other : near_) {
      if (other == ball) continue;
      const double allowed_m = bound_[other] - world.radius[other];  // and no farther from where it was
      if (!may_meet(reach, {place_of(other), bound_[other] + allowed_m})) continue;
      if constexpr (kFieldsAct) pairs_.add(static_cast<std::uint32_t>(ball), other);
      if (neighbours_.are_noted()) neighbours_.add(static_cast<std::uint32_t>(ball), other);
    }
  }

  void find_planes(const World<Dim>& world, const std::vector<Plane<Dim>>& planes) {
    constexpr std::size_t kAtOnce = 256;  // balls that stay in the nearest cache from plane to plane
    besides_.clear();
    threads_.collect(
        world.size(), besides_, [&](std::size_t begin, std::size_t end, std::vector<BallPair>& found) {
          for (std::size_t first = begin; first < end; first += kAtOnce) {
            for (std::uint32_t plane = 0; plane < planes.size(); ++plane) {
              for_each_passing(
                  first, std::min(first + kAtOnce, end),
                  [&](std::size_t ball) {
                    return listed_ == Listed::kAll ||
                           planes[plane].gap(world.position[ball], bound_[ball]) <= 0.0;
                  },
                  [&](std::size_t ball) { found.emplace_back(static_cast<std::uint32_t>(ball), plane); });
            }
          }
        });
  }

  /// Ways are counted from here. What is rounded, a few u = ε/2 each: the coordinates in every step; and the
  /// tests of distances, here and where balls touch, which may differ by 8 u of the coordinates and bounds.
  void forget_ways() {
    const double widest = threads_.largest(bound_.size(), [&](std::size_t i) { return double{bound_[i]}; });
    rounding_m_ = 4.0 * kEpsilon * (farthest_m_ + widest + Cruise<Dim>::kMostTimes * half_skin_m_);
    enough_m_ = half_skin_m_ - 2.0 * rounding_m_;
    travelled_m_ = 0.0;
    time_s_ = 0.0;
    hurried_ = 0;
    farthest_jump_m_ = 0.0;
    std::fill(jumps_m_.begin(), jumps_m_.end(), 0.0F);
  }

  std::unique_ptr<BroadPhase<Dim>> broad_phase_;
  Listed listed_;
  const Threads& threads_;
  double diameter_m_ = 0.0;  ///< mean
  double half_skin_m_ = 0.0;
  double next_half_skin_m_ = 0.0;
  Cruise<Dim> cruise_;
  double enough_m_ = kNothingHolds;  ///< how far a ball that cruises may go until the list is worth nothing
  double travelled_m_ = 0.0;
  double time_s_ = 0.0;      ///< since the list was made
  double rounding_m_ = 0.0;  ///< of coordinates, in a step
  double farthest_m_ = 0.0;  ///< no coordinate is larger
  std::size_t hurried_ = 0;  ///< times that a ball added pairs
  std::atomic<double> farthest_jump_m_ = 0.0;
  Column<float> jumps_m_;  ///< of each ball; empty before the first
  Column<float> bound_;    ///< m, radius and how far the ball may get from where it was
  std::conditional_t<kFieldsAct, DuePairs, FlyingPairs<Dim>> pairs_;
  ListedNeighbours neighbours_;
  std::vector<BallPair> besides_;
  std::vector<std::uint32_t> near_;
  int builds_in_this_order_ = kBuildsInAnOrder;
};

}  // namespace carom
