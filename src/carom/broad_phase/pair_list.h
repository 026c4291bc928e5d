#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "carom/broad_phase/broad_phase.h"
#include "carom/plane.h"
#include "carom/world.h"

namespace carom {

/// Calls at(k) for every k from begin on, but without end, that passes the test. No branch hangs on what the
/// test says: of many that fail few pass, and which ones no processor can foresee.
template <class Test, class At>
void for_each_passing(std::size_t begin, std::size_t end, const Test& test, const At& at) {
  constexpr std::size_t kBlock = 256;
  std::array<std::size_t, kBlock> passing;
  for (std::size_t first = begin; first < end; first += kBlock) {
    const std::size_t block_end = std::min(first + kBlock, end);
    std::size_t found = 0;
    for (std::size_t k = first; k < block_end; ++k) {
      passing[found] = k;
      found += test(k) ? 1U : 0U;
    }
    for (std::size_t n = 0; n < found; ++n) at(passing[n]);
  }
}

enum class PairSkin { kChosen, kNone };

/// The pairs of balls, and of balls and planes, that may touch before long: a list that serves many steps.
///
/// The trick: a broad phase is asked for all pairs that come as near as the sum of their radii and a *skin*
/// s. Until some ball has moved by s/2 no other pair can touch, for two balls come nearer to each other by at
/// most s. So the list is made anew only when the longest way that a ball may have gone comes to s/2; and
/// that way is known from a speed, without a look at any ball. Source: L. Verlet, Phys. Rev. 159, 98 (1967).
///
/// Were it the speed of the fastest ball, lists would live the shorter the more balls there are, for the sake
/// of a few. So ways are counted at a *cruising speed* that few balls exceed; and each of these adds to the
/// list, when it is made or when an impact has made the ball fast, the pairs that it may get to until the
/// list ends.
///
/// The skin decides what is looked at, never what happens: whoever takes pairs from here tests them as if
/// they came from a broad phase that was built in this step. With the skin kNone they do: that is the slow
/// twin, and tests hold both to the same bits.
template <int Dim>
class PairList {
 public:
  PairList(std::unique_ptr<BroadPhase<Dim>> broad_phase, PairSkin skin, const Threads& threads)
      : broad_phase_(std::move(broad_phase)), skin_(skin), threads_(threads) {}

  /// Whether balls can touch only in pairs that the list has while those that cruise go this much farther, m.
  bool holds(double way_m = 0.0) const {
    return (travelled_m_ + way_m) * kRoundUp + farthest_jump_m_ <= enough_m_;
  }

  /// No ball that cruises has gone farther than this, m.
  void travelled(double way_m) { travelled_m_ += way_m * kRoundUp + rounding_m_; }

  /// A ball was put this far away, m, beside what it travels.
  void jumped(std::size_t ball, double way_m) {
    if (jumps_m_.empty()) jumps_m_.resize(bound_.size(), 0.0F);
    jumps_m_[ball] = static_cast<float>((static_cast<double>(jumps_m_[ball]) + way_m) * kRoundUp);
    farthest_jump_m_ = std::max(farthest_jump_m_, static_cast<double>(jumps_m_[ball]));
  }

  /// Whether balls have left the order in which they were sorted, or never were.
  bool is_out_of_order() const { return builds_in_this_order_ >= kBuildsInAnOrder; }

  /// Before build(): sorts the balls in memory if they are out of order, so that those that are looked at
  /// together are loaded together. The list holds no more then.
  void sort(World<Dim>& world) {
    if (!is_out_of_order() || world.size() == 0) return;
    if (bound_.empty()) find_first_skin(world);
    builds_in_this_order_ = 0;
    Column<std::uint32_t> order;
    broad_phase_->hand_over_order(order);
    if (order.empty()) return;
    world.reorder(order, threads_);
    enough_m_ = kNothingHolds;
  }

  /// Before build(), where balls keep their speeds between impacts: chooses the cruising speed.
  void measure_speeds(const World<Dim>& world) {
    const double largest = largest_norm(world.velocity, threads_);
    cruise_mps_ = std::min(largest, std::max(largest / kMostTimes, kCruise * typical_speed(world)));
    fast_.clear();
    threads_.collect(world.size(), fast_,
                     [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& found) {
                       for_each_passing(
                           begin, end, [&](std::size_t ball) { return times_cruise(world, ball) > 1.0; },
                           [&](std::size_t ball) { found.push_back(static_cast<std::uint32_t>(ball)); });
                     });
    if (fast_.size() <= few(world)) return;
    cruise_mps_ = largest;
    fast_.clear();
  }

  /// Whether the next list will serve more than a step or two in which balls go this far, m.
  bool may_last(double way_m) const { return 2.0 * way_m <= next_half_skin_m_; }

  double cruise_mps() const { return cruise_mps_; }
  /// The speed of a ball by the cruising speed; 1 where it is not faster.
  double times_cruise(const World<Dim>& world, std::size_t ball) const {
    const double speed = world.velocity[ball].norm();
    return speed > cruise_mps_ ? speed / cruise_mps_ : 1.0;
  }
  /// Who was faster than that when the speeds were measured: each has to hurry() once the list is made.
  std::span<const std::uint32_t> fast() const { return fast_; }

  /// Makes the list for the balls where they are.
  /// @param way_m  of each ball, how far the list must hold at least, m
  template <class Way>
  void build(const World<Dim>& world, const std::vector<Plane<Dim>>& planes, const Way& way_m) {
    find_pairs(world, way_m);
    find_planes(world, planes);
    forget_ways(world);
    choose_skin(world);
    ++builds_in_this_order_;
  }

  /// How far a ball goes at most, m, while those that cruise go so far; and from then on, so many times as
  /// far as they.
  struct Haste {
    double way_m;
    double cruisers_way_m;
    double times;
  };

  /// The ball may be faster than the list allows for: adds what pairs it may get to until the list ends, or
  /// ends the list after the step at hand. What stands in the list already may be added again.
  /// @param is_new  whether the list has no pair of the ball and another yet, as far as the caller cares
  template <class IsNew>
  void hurry(const World<Dim>& world, const std::vector<Plane<Dim>>& planes, std::size_t ball,
             const Haste& haste, const IsNew& is_new) {
    if (haste.times <= 1.0 && holds(haste.cruisers_way_m)) return;
    if (haste.times > kMostTimes) enough_m_ = kNothingHolds;
    const double left_m = std::max(0.0, half_skin_m_ - travelled_m_ - haste.cruisers_way_m);
    const double later_m = enough_m_ == kNothingHolds ? 0.0 : haste.times * left_m;
    const double soon_m = gone(world, ball) + haste.way_m;
    const double bound = world.radius[ball] + (soon_m + later_m) * kRoundUp + 2.0 * rounding_m_;
    if (!(bound > bound_[ball])) return;
    bound_[ball] = bound;
    broad_phase_->bound_grew(ball);
    // Bounds are around where balls were when the list was made: this far away at most.
    const Reach<Dim> reach{world.position[ball], bound + soon_m};
    add_pairs(world, ball, reach, is_new);
    for (std::uint32_t plane = 0; plane < planes.size(); ++plane) {
      if (planes[plane].gap(reach.centre, reach.bound) > 0.0) continue;
      besides_.emplace_back(static_cast<std::uint32_t>(ball), plane);
    }
    if (++hurried_ > few(world)) enough_m_ = kNothingHolds;
  }

  /// Calls move(first, end) for stretches of the balls that make up all, and test(first, end, found) for
  /// stretches of the pairs that make up all, each after its balls were moved.
  ///
  /// The trick: pairs are tested right after the later of their balls was moved. It is near then, and so is
  /// the earlier one, as a rule: the memory is read once where it would be read for moving and again for
  /// testing. Threads that share the balls move all of them first.
  template <class Move, class Found, class Test>
  void sweep(const Move& move, Found& found, const Test& test) const {
    if (threads_.count() > 1 || end_of_pairs_.empty()) {
      threads_.in_parallel(bound_.size(), move);
      return threads_.collect(pairs_.size(), found, test);
    }
    std::size_t tested = 0;
    for (std::size_t k = 0; k < end_of_pairs_.size(); ++k) {
      move(k * kStretch, std::min((k + 1) * kStretch, bound_.size()));
      test(tested, end_of_pairs_[k], found);
      tested = end_of_pairs_[k];
    }
    test(tested, pairs_.size(), found);
  }

  /// Two balls that may touch.
  std::span<const BallPair> pairs() const { return pairs_; }
  /// A ball and a plane that may touch.
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
  /// The cruising speed by the root of the mean square, where the fastest ball is faster. Of the speeds in a
  /// gas (J. C. Maxwell, 1860) 0.2 % are larger in space and 0.8 % in the plane.
  static constexpr double kCruise = 2.2;
  /// A ball faster by more than this looks too far around: then the cruising speed is larger.
  static constexpr double kMostTimes = 4.0;
  /// Of the balls: if more than one in so many are fast, it is dearer to look around each than to make lists
  /// more often.
  static constexpr std::size_t kFewIsOneIn = 50;
  static constexpr std::size_t kSample = 1024;
  /// Balls that are moved before their pairs are tested: what they take is a part of the nearest caches.
  static constexpr std::size_t kStretch = 4096;
  static constexpr std::size_t kManyStretches = 8;
  /// Lists after which balls have left the order in which they were sorted.
  static constexpr int kBuildsInAnOrder = 16;
  /// For sums of ways, those of floats included: each addition is off by 2⁻²⁴ at most.
  static constexpr double kRoundUp = 1.0 + 0x1p-20;
  static constexpr double kNothingHolds = -1.0;

  /// Makes lists that nobody uses, until one has the skin that it should have had.
  void find_first_skin(const World<Dim>& world) {
    double radii = 0.0;
    for (std::size_t i = 0; i < world.size(); ++i) radii += world.radius[i];
    diameter_m_ = 2.0 * radii / static_cast<double>(world.size());
    next_half_skin_m_ = skin_ == PairSkin::kNone ? 0.0 : 0.5 * kFirstGuess * diameter_m_;
    for (int guess = 0; guess < kMostGuesses; ++guess) {
      find_pairs(world, [](std::size_t) { return 0.0; });
      choose_skin(world);
      if (next_half_skin_m_ <= kMuchLarger * half_skin_m_) return;
    }
  }

  template <class Way>
  void find_pairs(const World<Dim>& world, const Way& way_m) {
    half_skin_m_ = next_half_skin_m_;
    bound_.resize(world.size());
    threads_.in_parallel(world.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        bound_[i] = world.radius[i] + std::max(half_skin_m_, way_m(i));
      }
    });
    broad_phase_->build(world.position, bound_, threads_);
    broad_phase_->find_pairs(pairs_, threads_);
    sort_pairs(world.size());
  }

  /// For the next list: half the skin that would have added kMorePairs for each ball to the pairs that touch,
  /// had this list been made with it: with n balls in a unit of space around each, ½ n C R^Dim pairs are
  /// nearer than R.
  void choose_skin(const World<Dim>& world) {
    if (skin_ == PairSkin::kNone || world.size() == 0) return;
    const double volume = std::pow(diameter_m_ + 2.0 * half_skin_m_, Dim);
    const double pairs_per_ball = static_cast<double>(pairs_.size() + 1) / static_cast<double>(world.size());
    const double wanted = std::pow(diameter_m_, Dim) + kMorePairs / pairs_per_ball * volume;
    const double half_skin_m = 0.5 * (std::pow(wanted, 1.0 / Dim) - diameter_m_);
    next_half_skin_m_ = std::clamp(half_skin_m, 0.5 * half_skin_m_, 2.0 * half_skin_m_);
  }

  /// The root of the speeds' mean square, m/s, of a sample.
  static double typical_speed(const World<Dim>& world) {
    const std::size_t stride = 1 + world.size() / kSample;
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < world.size(); i += stride, ++count)
      squares += world.velocity[i].squaredNorm();
    return std::sqrt(squares / std::max(1.0, count));
  }

  static std::size_t few(const World<Dim>& world) { return world.size() / kFewIsOneIn; }

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
  template <class IsNew>
  void add_pairs(const World<Dim>& world, std::size_t ball, const Reach<Dim>& reach, const IsNew& is_new) {
    broad_phase_->find_near(reach, near_);
    for (const std::uint32_t other : near_) {
      if (other == ball) continue;
      const double allowed_m = bound_[other] - world.radius[other];  // and no farther from where it was
      if (!may_meet(reach, {world.position[other], bound_[other] + allowed_m}) || !is_new(other)) continue;
      const auto self = static_cast<std::uint32_t>(ball);
      pairs_.emplace_back(std::min(self, other), std::max(self, other));
    }
  }

  /// Puts pairs in the order of the stretches that their later balls stand in. Few balls are near anyway;
  /// then all is left as it is.
  void sort_pairs(std::size_t balls) {
    end_of_pairs_.clear();
    if (balls < kManyStretches * kStretch) return;
    const auto stretch_of = [](const BallPair& pair) { return pair.second / kStretch; };
    end_of_pairs_.resize((balls - 1) / kStretch + 1, 0);
    for (const BallPair& pair : pairs_) ++end_of_pairs_[stretch_of(pair)];
    std::exclusive_scan(end_of_pairs_.begin(), end_of_pairs_.end(), end_of_pairs_.begin(), 0U);
    Column<BallPair> sorted(pairs_.size());
    for (const BallPair& pair : pairs_) sorted[end_of_pairs_[stretch_of(pair)]++] = pair;
    pairs_.swap(sorted);
  }

  void find_planes(const World<Dim>& world, const std::vector<Plane<Dim>>& planes) {
    besides_.clear();
    for (std::uint32_t plane = 0; plane < planes.size(); ++plane) {
      const auto is_beside = [&](std::size_t ball) {
        return planes[plane].gap(world.position[ball], bound_[ball]) <= 0.0;
      };
      threads_.collect(world.size(), besides_,
                       [&](std::size_t begin, std::size_t end, std::vector<BallPair>& found) {
                         for_each_passing(begin, end, is_beside, [&](std::size_t ball) {
                           found.emplace_back(static_cast<std::uint32_t>(ball), plane);
                         });
                       });
    }
  }

  /// Ways are counted from here. What is rounded, a few u = ε/2 each: the coordinates in every step; and the
  /// tests of distances, here and where balls touch, which may differ by 8 u of the coordinates and bounds.
  void forget_ways(const World<Dim>& world) {
    const std::span<const double> places = world.position.components(0, world.size());
    const double farthest =
        threads_.largest(places.size(), [&](std::size_t k) { return std::abs(places[k]); });
    const double widest = threads_.largest(bound_.size(), [&](std::size_t i) { return bound_[i]; });
    rounding_m_ = 4.0 * kEpsilon * (farthest + widest + kMostTimes * half_skin_m_);
    enough_m_ = skin_ == PairSkin::kNone ? kNothingHolds : half_skin_m_ - 2.0 * rounding_m_;
    travelled_m_ = 0.0;
    hurried_ = 0;
    farthest_jump_m_ = 0.0;
    std::fill(jumps_m_.begin(), jumps_m_.end(), 0.0F);
  }

  std::unique_ptr<BroadPhase<Dim>> broad_phase_;
  PairSkin skin_;
  const Threads& threads_;
  double diameter_m_ = 0.0;  ///< mean
  double half_skin_m_ = 0.0;
  double next_half_skin_m_ = 0.0;
  double cruise_mps_ = 0.0;
  double enough_m_ = kNothingHolds;  ///< how far a ball that cruises may go until the list is worth nothing
  double travelled_m_ = 0.0;
  double rounding_m_ = 0.0;  ///< of coordinates, in a step
  std::size_t hurried_ = 0;  ///< times that a ball added pairs
  double farthest_jump_m_ = 0.0;
  Column<float> jumps_m_;  ///< of each ball; empty before the first
  Column<double> bound_;   ///< m, radius and how far the ball may get from where it was
  Column<BallPair> pairs_;
  std::vector<std::uint32_t> end_of_pairs_;  ///< of each stretch, in pairs_; empty where balls are few
  std::vector<BallPair> besides_;
  std::vector<std::uint32_t> fast_;
  std::vector<std::uint32_t> near_;
  int builds_in_this_order_ = kBuildsInAnOrder;
};

}  // namespace carom
