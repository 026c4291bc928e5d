#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "carom/broad_phase/broad_phase.h"
#include "carom/broad_phase/calendar.h"
#include "carom/broad_phase/for_each_passing.h"
#include "carom/broad_phase/listed_neighbours.h"
#include "carom/threads.h"
#include "carom/time_of_impact.h"
#include "carom/world.h"
#include "core/large_pages.h"

namespace carom {

/// Pairs of balls that fly straight on between their impacts.
///
/// The trick: when two of them may touch is known as long as neither is hit, so a pair is looked at in the
/// one step in which it is due, by a calendar; and asked anew when one of its balls was hit, or when it was
/// looked at. Almost all are never looked at before the list ends.
template <int Dim>
class FlyingPairs {
 public:
  std::span<const BallPair> all() const { return pairs_; }

  /// To be filled anew.
  Column<BallPair>& find() { return pairs_; }

  /// Time begins, and each pair is put to when it is due.
  /// @param step_s       how long steps will be
  /// @param end_s        what is due later will not be asked for
  /// @param rounding_m   by how much places of balls may be off
  void begin(const World<Dim>& world, double step_s, double end_s, double rounding_m,
             const Threads& threads) {
    end_s_ = end_s;
    rounding_m_ = rounding_m;
    due_.clear();
    is_hit_.assign(world.size(), false);
    calendar_.begin(step_s, end_s);
    const std::span<const BallPair> all = pairs_;
    threads.collect(all.size(), coming_, [&](std::size_t begin, std::size_t end, std::vector<Coming>& found) {
      find_coming(world, 0.0, 0.0, all.subspan(begin, end - begin), found);
    });
    put_coming();
    coming_ = {};  // was many at once
  }

  /// Those that are due until then; some stand here more than once, for a pair that is asked anew stays where
  /// it was put before. @pre begin() was called
  std::span<const BallPair> take(double until_s) {
    calendar_.take(until_s, due_);
    if (due_.size() > pairs_.size()) {  // of a ball that is hit again and again
      std::sort(due_.begin(), due_.end());
      due_.erase(std::unique(due_.begin(), due_.end()), due_.end());
    }
    return due_;
  }

  /// Puts those that were taken, and all pairs of balls that have been hit, to when they are due from now on.
  /// @param flown_s  how long balls have flown from where they stand in memory
  void expect_anew(const World<Dim>& world, double now_s, double flown_s, std::span<const std::uint32_t> hit,
                   const ListedNeighbours& neighbours, const Threads& threads) {
    for (const std::uint32_t ball : hit) is_hit_[ball] = true;
    std::erase_if(due_, [&](const BallPair& pair) { return is_hit_[pair.first] || is_hit_[pair.second]; });
    find_coming(world, now_s, flown_s, due_, coming_);
    due_.clear();
    threads.collect(hit.size(), coming_, [&](std::size_t begin, std::size_t end, std::vector<Coming>& found) {
      std::vector<BallPair> asked;
      for (std::size_t k = begin; k < end; ++k) {
        neighbours.fetch(hit[std::min(k + 2 * kAhead, end - 1)]);
        neighbours.fetch_all_of(hit[std::min(k + kAhead, end - 1)]);
        add_pairs_of(hit[k], neighbours, asked);
      }
      find_coming(world, now_s, flown_s, asked, found);
    });
    for (const std::uint32_t ball : hit) is_hit_[ball] = false;
    put_coming();
  }

 private:
  struct Coming {
    BallPair pair;
    double due_s;
  };

  /// Those of two balls that were hit once.
  void add_pairs_of(std::uint32_t ball, const ListedNeighbours& neighbours,
                    std::vector<BallPair>& pairs) const {
    neighbours.for_each(ball, [&](std::uint32_t other) {
      if (is_hit_[other] && other < ball) return;
      pairs.emplace_back(std::min(ball, other), std::max(ball, other));
    });
  }

  /// Of these pairs, those that may touch before the end, each with when it is due.
  void find_coming(const World<Dim>& world, double now_s, double flown_s, std::span<const BallPair> pairs,
                   std::vector<Coming>& coming) const {
    const auto approach = [&](std::size_t k) {
      const auto [a, b] = pairs[k];
      return Approach<Dim>(world.place_after(flown_s, b) - world.place_after(flown_s, a),
                           world.velocity[b] - world.velocity[a],
                           world.radius[a] + world.radius[b] + 2.0 * rounding_m_);
    };
    const auto is_fixed = [&](std::uint32_t ball) { return world.inverse_mass[ball] == 0.0; };
    const double left_s = std::max(0.0, end_s_ - now_s);
    for_each_passing(
        0, pairs.size(),
        [&](std::size_t k) {
          world.fetch_pair(pairs[std::min(k + kAhead, pairs.size() - 1)]);
          return approach(k).may_touch_within(left_s);
        },
        [&](std::size_t k) {
          const double wait_s = approach(k).first_touch_s();
          if (wait_s == kNever || wait_s > left_s) return;
          if (is_fixed(pairs[k].first) && is_fixed(pairs[k].second)) return;
          coming.push_back({pairs[k], now_s + wait_s});
        });
  }

  void put_coming() {
    for (const auto& [pair, due_s] : coming_) calendar_.put(pair, due_s);
    coming_.clear();
  }

  /// So many before a pair, or a ball, is looked at it is fetched from memory.
  static constexpr std::size_t kAhead = 32;

  double end_s_ = 0.0;
  double rounding_m_ = 0.0;
  Column<BallPair> pairs_;
  Calendar calendar_;
  std::vector<BallPair> due_;   ///< taken from the calendar
  std::vector<bool> is_hit_;    ///< of each ball, while pairs are asked anew
  std::vector<Coming> coming_;  ///< to be put
};

}  // namespace carom
