#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "carom/broad_phase/broad_phase.h"
#include "carom/threads.h"
#include "core/large_pages.h"

namespace carom {

/// Pairs of balls, each of which needs no look until it is due.
///
/// They stand in the order of the stretches of memory that their later balls stand in, so that what is tested
/// together is loaded together; and within a stretch in the order of the stages at which they are due, so
/// that what is due is one piece of each stretch, and no branch asks for it.
class DuePairs {
 public:
  /// Stages of a list's life. With more of them fewer pairs are tested early, and stretches have shorter
  /// pieces.
  static constexpr std::size_t kStages = 8;

  std::span<const BallPair> all() const { return pairs_; }

  /// To be filled anew. All are due at all stages until they are sorted.
  Column<BallPair>& find() {
    end_.clear();
    sorted_ = 0;
    return pairs_;
  }

  /// Sorts the pairs. @param stage_of  the stage at which a pair is due, below kStages
  template <class StageOf>
  void sort(std::size_t balls, const StageOf& stage_of) {
    Column<std::uint8_t> stage(pairs_.size());
    const auto place_of = [&](std::size_t k) { return pairs_[k].second / kStretch * kStages + stage[k]; };
    end_.assign((balls / kStretch + 1) * kStages, 0);
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      stage[k] = static_cast<std::uint8_t>(stage_of(pairs_[k]));
      ++end_[place_of(k)];
    }
    std::exclusive_scan(end_.begin(), end_.end(), end_.begin(), 0U);
    Column<BallPair> sorted(pairs_.size());
    for (std::size_t k = 0; k < pairs_.size(); ++k) sorted[end_[place_of(k)]++] = pairs_[k];
    pairs_.swap(sorted);
    sorted_ = pairs_.size();
  }

  /// A pair that is due at all stages.
  void add(std::uint32_t a, std::uint32_t b) { pairs_.emplace_back(std::min(a, b), std::max(a, b)); }

  /// Calls test(first, end, found) for pieces of the pairs that make up all which are due at the stage.
  template <class Found, class Test>
  void test(std::size_t stage, const Threads& threads, Found& found, const Test& test) const {
    threads.collect(end_.size() / kStages, found, [&](std::size_t first, std::size_t end, Found& own) {
      for (std::size_t stretch = first; stretch < end; ++stretch) {
        const std::size_t begin = stretch == 0 ? 0 : end_[stretch * kStages - 1];
        test(begin, std::size_t{end_[stretch * kStages + stage]}, own);
      }
    });
    if (sorted_ == pairs_.size()) return;
    threads.collect(pairs_.size() - sorted_, found, [&](std::size_t first, std::size_t end, Found& own) {
      test(sorted_ + first, sorted_ + end, own);
    });
  }

 private:
  /// Balls whose places and velocities lie in the nearest cache while pairs of theirs are tested.
  static constexpr std::size_t kStretch = 256;

  Column<BallPair> pairs_;
  std::vector<std::uint32_t> end_;  ///< in pairs_, of each stage of each stretch
  std::size_t sorted_ = 0;
};

}  // namespace carom
