#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
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
/// most s. So the list is made anew only when the longest way that any ball may have gone comes to s/2; and
/// that way is known from the largest speed, without a look at any ball. Source: L. Verlet, Phys. Rev. 159,
/// 98 (1967).
///
/// The skin decides what is looked at, never what happens: whoever takes pairs from here tests them as if
/// they came from a broad phase that was built in this step. With the skin kNone they do: that is the slow
/// twin, and tests hold both to the same bits.
template <int Dim>
class PairList {
 public:
  PairList(std::unique_ptr<BroadPhase<Dim>> broad_phase, PairSkin skin, const Threads& threads)
      : broad_phase_(std::move(broad_phase)), skin_(skin), threads_(threads) {}

  /// Whether balls that go at most this much farther, m, can touch only in pairs that the list has.
  bool holds(double way_m = 0.0) const {
    return (travelled_m_ + way_m) * kRoundUp + farthest_jump_m_ <= enough_m_;
  }

  /// Every ball has gone at most this far, m.
  void travelled(double way_m) { travelled_m_ += way_m * kRoundUp + rounding_m_; }

  /// A ball may get this far from where it was when the list was made, m, whatever the others do.
  void strays(std::size_t ball, double radius, double way_m) {
    travelled_m_ = std::max(travelled_m_, way_m);
    if (radius + way_m <= bound_[ball]) return;
    bound_[ball] = radius + way_m;
    broad_phase_->bound_grew(ball);
  }

  /// A ball was put this far away, m, beside what it travels.
  void jumped(std::size_t ball, double way_m) {
    if (jumps_m_.empty()) jumps_m_.resize(bound_.size(), 0.0F);
    jumps_m_[ball] = static_cast<float>((static_cast<double>(jumps_m_[ball]) + way_m) * kRoundUp);
    farthest_jump_m_ = std::max(farthest_jump_m_, static_cast<double>(jumps_m_[ball]));
  }

  /// Before the first build(), and now and then later: sorts the balls in memory, so that those that are looked
  /// at together are loaded together. Returns whether it did; then the list holds no more.
  bool sort(World<Dim>& world) {
    if (builds_in_this_order_ < kBuildsInAnOrder || world.size() == 0) return false;
    if (bound_.empty()) find_first_skin(world);
    builds_in_this_order_ = 0;
    Column<std::uint32_t> order;
    broad_phase_->hand_over_order(order);
    if (order.empty()) return false;
    world.reorder(order, threads_);
    enough_m_ = kNothingHolds;
    return true;
  }

  /// Makes the list for the balls where they are.
  /// @param position  where that is; what stays as it is can be asked of the broad phase later
  /// @param way_m     of each ball, how far the list must hold at least, m
  template <class Way>
  void build(const World<Dim>& world, const VectorColumn<Dim>& position,
             const std::vector<Plane<Dim>>& planes, const Way& way_m) {
    find_pairs(world, position, way_m);
    find_planes(world, planes);
    forget_ways(world);
    choose_skin(world);
    ++builds_in_this_order_;
  }

  /// Two balls that may touch.
  std::span<const BallPair> pairs() const { return pairs_; }
  /// A ball and a plane that may touch.
  std::span<const BallPair> besides() const { return besides_; }

  std::string_view name() const { return broad_phase_->name(); }
  const BroadPhase<Dim>& broad_phase() const { return *broad_phase_; }

 private:
  /// Pairs that the skin adds for each ball: more of them make every step dearer, fewer make lists shorter
  /// lived. Measured, SPEED.md.
  static constexpr double kMorePairs = 0.75;
  /// The first guess of half the skin, by the balls' mean radius; and by how much a better one is larger that is
  /// tried as well.
  static constexpr double kFirstGuess = 0.2;
  static constexpr double kMuchLarger = 1.25;
  static constexpr int kMostGuesses = 8;
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
    half_skin_m_ = skin_ == PairSkin::kNone ? 0.0 : 0.5 * kFirstGuess * diameter_m_;
    for (int guess = 0; guess < kMostGuesses; ++guess) {
      const double guess_m = half_skin_m_;
      find_pairs(world, world.position, [](std::size_t) { return 0.0; });
      choose_skin(world);
      if (half_skin_m_ <= kMuchLarger * guess_m) return;
    }
  }

  template <class Way>
  void find_pairs(const World<Dim>& world, const VectorColumn<Dim>& position, const Way& way_m) {
    bound_.resize(world.size());
    threads_.in_parallel(world.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        bound_[i] = world.radius[i] + std::max(half_skin_m_, way_m(i));
      }
    });
    broad_phase_->build(position, bound_, threads_);
    broad_phase_->find_pairs(pairs_, threads_);
  }

  /// For the next list: half the skin that would have added kMorePairs for each ball to the pairs that touch, had
  /// this list been made with it: with n balls in a unit of space around each, ½ n C R^Dim pairs are nearer than R.
  void choose_skin(const World<Dim>& world) {
    if (skin_ == PairSkin::kNone || world.size() == 0) return;
    const double volume = std::pow(diameter_m_ + 2.0 * half_skin_m_, Dim);
    const double pairs_per_ball = static_cast<double>(pairs_.size() + 1) / static_cast<double>(world.size());
    const double wanted = std::pow(diameter_m_, Dim) + kMorePairs / pairs_per_ball * volume;
    const double half_skin_m = 0.5 * (std::pow(wanted, 1.0 / Dim) - diameter_m_);
    half_skin_m_ = std::clamp(half_skin_m, 0.5 * half_skin_m_, 2.0 * half_skin_m_);
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
    double farthest = 0.0;
    for (int axis = 0; axis < Dim; ++axis) {
      const std::span<const double> places = world.position.axis(axis);
      farthest = std::max(
          farthest, threads_.largest(places.size(), [&](std::size_t i) { return std::abs(places[i]); }));
    }
    const double widest = threads_.largest(bound_.size(), [&](std::size_t i) { return bound_[i]; });
    rounding_m_ = 4.0 * kEpsilon * (farthest + widest);
    enough_m_ = skin_ == PairSkin::kNone ? kNothingHolds : half_skin_m_ - 2.0 * rounding_m_;
    travelled_m_ = 0.0;
    farthest_jump_m_ = 0.0;
    std::fill(jumps_m_.begin(), jumps_m_.end(), 0.0F);
  }

  std::unique_ptr<BroadPhase<Dim>> broad_phase_;
  PairSkin skin_;
  const Threads& threads_;
  double diameter_m_ = 0.0;  ///< mean
  double half_skin_m_ = 0.0;  ///< of the next list
  double enough_m_ = kNothingHolds;  ///< how far a ball may go until the list is worth nothing
  double travelled_m_ = 0.0;
  double rounding_m_ = 0.0;  ///< of coordinates, in a step
  double farthest_jump_m_ = 0.0;
  Column<float> jumps_m_;  ///< of each ball; empty before the first
  Column<double> bound_;   ///< m, radius and how far the ball may get from where it was
  Column<BallPair> pairs_;
  std::vector<BallPair> besides_;
  int builds_in_this_order_ = kBuildsInAnOrder;
};

}  // namespace carom
