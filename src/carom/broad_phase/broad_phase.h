#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/broad_phase/reach.h"
#include "carom/world.h"

namespace carom {

/// Two balls that may meet, the lower number first.
using BallPair = std::pair<std::uint32_t, std::uint32_t>;

/// A broad phase finds the pairs of balls that may meet for a while, a step or the life of a list of pairs:
/// ball i stays within bound[i], m, of where it stood at build(), so i and j may meet only if |x_i - x_j| <=
/// bound[i] + bound[j]. Every broad phase reports exactly these pairs, in an order of its own; what follows
/// does not depend on the order.
///
/// This is how an evolver sees it: one call for a list of pairs, and one for each ball that gets farther than
/// the list allows for. Inside, each is a template that visits pairs without calls. One whose build() takes
/// threads, and whose for_each_pair() a stretch of its balls, is shared among threads.
template <int Dim>
class BroadPhase {
 public:
  BroadPhase() = default;
  BroadPhase(const BroadPhase&) = delete;
  BroadPhase& operator=(const BroadPhase&) = delete;
  virtual ~BroadPhase() = default;

  virtual std::string_view name() const = 0;

  /// Notes where the balls stand. Positions and bounds are columns of the caller's: the positions stay as
  /// they are until the pairs are found, the bounds may grow later.
  virtual void build(const VectorColumn<Dim>& position, Bounds bound, const Threads& threads) = 0;

  /// Replaces `pairs` by every pair that may meet, each once. @pre nothing has changed since build()
  virtual void find_pairs(Column<BallPair>& pairs, const Threads& threads) const = 0;

  /// Says that bound[ball] has grown.
  virtual void bound_grew(std::size_t ball) = 0;

  /// Replaces `others` by every ball that may meet something with this reach, from where it stood at build()
  /// and by its bound as it is; others may be among them, and the one that asks.
  virtual void find_near(const Reach<Dim>& reach, std::vector<std::uint32_t>& others) const = 0;

  /// Replaces `balls` by all balls in an order in which neighbours stand together; by none where the broad
  /// phase has no such order. What it was built from may go with it: it has to be built anew. @pre build()
  /// was called
  virtual void hand_over_order(Column<std::uint32_t>& balls) = 0;
};

/// A broad phase as an evolver takes it, made from one that visits.
template <int Dim, class Visitor>
class BroadPhaseOf final : public BroadPhase<Dim> {
 public:
  std::string_view name() const override { return Visitor::kName; }

  void build(const VectorColumn<Dim>& position, Bounds bound, const Threads& threads) override {
    if constexpr (requires { visitor_.build(position, bound, threads); }) {
      visitor_.build(position, bound, threads);
    } else {
      visitor_.build(position, bound);
    }
  }

  void find_pairs(Column<BallPair>& pairs, const Threads& threads) const override {
    const auto into = [](Column<BallPair>& found) {
      return [&found](std::size_t i, std::size_t j) {
        found.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
      };
    };
    pairs.clear();
    if constexpr (requires { visitor_.for_each_pair(0, 0, into(pairs)); }) {
      threads.collect(visitor_.size(), pairs,
                      [&](std::size_t first, std::size_t end, Column<BallPair>& found) {
                        visitor_.for_each_pair(first, end, into(found));
                      });
    } else {
      visitor_.for_each_pair(into(pairs));
    }
  }

  void bound_grew(std::size_t ball) override { visitor_.bound_grew(ball); }

  void find_near(const Reach<Dim>& reach, std::vector<std::uint32_t>& others) const override {
    others.clear();
    visitor_.for_each_near(
        reach, [&others](std::size_t other) { others.push_back(static_cast<std::uint32_t>(other)); });
  }

  void hand_over_order(Column<std::uint32_t>& balls) override {
    balls.clear();
    if constexpr (requires { visitor_.hand_over_order(balls); }) visitor_.hand_over_order(balls);
  }

 private:
  Visitor visitor_;
};

}  // namespace carom
