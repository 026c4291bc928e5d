#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <unordered_map>
#include <vector>

#include "carom/broad_phase/broad_phase.h"
#include "carom/threads.h"
#include "core/large_pages.h"
#include "core/prefetch.h"

namespace carom {

/// Whom each ball is listed with: the pairs of a list ball by ball, in one place of memory each.
class ListedNeighbours {
 public:
  void note(std::size_t balls, std::span<const BallPair> pairs, const Threads& threads) {
    more_of_.clear();
    more_.clear();
    has_more_.assign(balls, false);
    start_.assign(balls + 1, 0);
    neighbour_.resize(2 * pairs.size());
    for_each_side(balls, pairs, threads, [this](std::uint32_t ball, std::uint32_t) { ++start_[ball]; });
    std::inclusive_scan(start_.begin(), start_.end(), start_.begin());
    for_each_side(balls, pairs, threads,
                  [this](std::uint32_t ball, std::uint32_t other) { neighbour_[--start_[ball]] = other; });
  }

  bool are_noted() const { return !start_.empty(); }

  /// Two that are listed since, unless they were.
  void add(std::uint32_t a, std::uint32_t b) {
    bool noted = false;
    for_each(a, [&](std::uint32_t other) { noted = noted || other == b; });
    if (noted) return;
    chain(a, b);
    chain(b, a);
  }

  /// Calls visit(other) for every other ball that this one is listed with, each once.
  template <class Visit>
  void for_each(std::uint32_t ball, const Visit& visit) const {
    for (std::uint32_t k = start_[ball]; k < start_[ball + 1]; ++k) visit(neighbour_[k]);
    if (!has_more_[ball]) return;
    for (std::uint32_t k = more_of_.at(ball); k != kNone; k = more_[k].next) visit(more_[k].other);
  }

  /// Has the processor load where the neighbours of a ball stand; and, once it has, which ones they are.
  void fetch(std::uint32_t ball) const { prefetch(&start_[ball]); }
  void fetch_all_of(std::uint32_t ball) const { prefetch(neighbour_.data() + start_[ball]); }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// One of those that a ball got later, and where in more_ the next stands.
  struct Link {
    std::uint32_t other;
    std::uint32_t next;
  };

  /// Calls at(ball, other) for either ball of each pair. Threads look at all pairs, each for its own balls.
  template <class At>
  static void for_each_side(std::size_t balls, std::span<const BallPair> pairs, const Threads& threads,
                            const At& at) {
    threads.in_parallel(balls, [&](std::size_t begin, std::size_t end) {
      for (const auto& [a, b] : pairs) {
        if (a - begin < end - begin) at(a, b);
        if (b - begin < end - begin) at(b, a);
      }
    });
  }

  void chain(std::uint32_t ball, std::uint32_t other) {
    std::uint32_t& first = more_of_.try_emplace(ball, kNone).first->second;
    more_.push_back({other, first});
    first = static_cast<std::uint32_t>(more_.size() - 1);
    has_more_[ball] = true;
  }

  Column<std::uint32_t> start_;  ///< of each ball, in neighbour_
  Column<std::uint32_t> neighbour_;
  // Few balls get more.
  std::vector<bool> has_more_;
  std::unordered_map<std::uint32_t, std::uint32_t> more_of_;  ///< where in more_ they begin
  std::vector<Link> more_;
};

}  // namespace carom
