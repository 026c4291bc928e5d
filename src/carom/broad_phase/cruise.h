#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "carom/broad_phase/for_each_passing.h"
#include "carom/threads.h"
#include "carom/world.h"

namespace carom {

/// The speed that few balls exceed, and who these few are. Neither depends on the order of the balls in
/// memory, to the bit.
template <int Dim>
class Cruise {
 public:
  /// A ball that is faster by more than this has so far to look around that lists are made more often for its
  /// sake: with a larger cruising speed, or, where an impact made it so fast, at once.
  static constexpr double kMostTimes = 4.0;

  /// How many of so many balls are few: to look around each of more is dearer than to make lists more often.
  static std::size_t few(std::size_t balls) { return balls / kFewIsOneIn; }

  void measure(const World<Dim>& world, const Threads& threads) {
    const double largest = largest_norm(world.velocity, threads);
    mps_ = std::min(largest, std::max(largest / kMostTimes,
                                      kRootMeanSquares * root_mean_square(world, largest, threads)));
    faster_.clear();
    threads.collect(world.size(), faster_,
                    [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& found) {
                      for_each_passing(
                          begin, end, [&](std::size_t ball) { return times(world, ball) > 1.0; },
                          [&](std::size_t ball) { found.push_back(static_cast<std::uint32_t>(ball)); });
                    });
    if (faster_.size() <= few(world.size())) return;
    mps_ = largest;
    faster_.clear();
  }

  double mps() const { return mps_; }
  /// The speed of a ball by this; 1 where it is not faster.
  double times(const World<Dim>& world, std::size_t ball) const {
    const double speed = world.velocity[ball].norm();
    return speed > mps_ ? speed / mps_ : 1.0;
  }
  /// Who was faster when the speeds were measured.
  std::span<const std::uint32_t> faster() const { return faster_; }

 private:
  /// Of the speeds in a gas (J. C. Maxwell, 1860) 0.2 % are larger than this times the root of their mean
  /// square in space, and 0.8 % in the plane.
  static constexpr double kRootMeanSquares = 2.2;
  static constexpr std::size_t kFewIsOneIn = 50;

  /// The root of the speeds' mean square, m/s. The squares are added up as whole numbers, whose sum does not
  /// depend on their order: each of them, by the largest, takes 32 bits, and the numbers of balls as many.
  /// What is not a number counts for nothing.
  static double root_mean_square(const World<Dim>& world, double largest, const Threads& threads) {
    if (!(largest > 0.0) || !std::isfinite(largest)) return largest;
    constexpr double kOne = 0x1p31;
    const double scale = kOne / (largest * largest);
    std::vector<std::uint64_t> sums;
    threads.collect(world.size(), sums,
                    [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& found) {
                      std::uint64_t sum = 0;
                      for (std::size_t i = begin; i < end; ++i) {
                        const double share = world.velocity[i].squaredNorm() * scale;
                        if (share <= 2.0 * kOne) sum += static_cast<std::uint64_t>(share);
                      }
                      found.push_back(sum);
                    });
    const std::uint64_t sum = std::accumulate(sums.begin(), sums.end(), std::uint64_t{0});
    return largest * std::sqrt(static_cast<double>(sum) / kOne / static_cast<double>(world.size()));
  }

  double mps_ = 0.0;
  std::vector<std::uint32_t> faster_;
};

}  // namespace carom
