#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/broad_phase/pair_list.h"
#include "carom/broad_phase/reach.h"
#include "carom/plane.h"

namespace carom {

/// Which balls may meet in a step, by how far each may get in it. `Balls` are Flights (flights.h).
///
/// Pairs come from a list that serves many steps (pair_list.h). Whom a ball may meet that was hit is read
/// from it as well: the pairs of a ball are a chain, from the last in the list to the first. What is found is
/// held against the reaches in this step, so that nothing depends on how long a list lives.
template <int Dim, class Balls>
class Neighbours {
 public:
  Neighbours(Balls& flights, std::unique_ptr<BroadPhase<Dim>> broad_phase, PairSkin skin,
             const std::vector<Plane<Dim>>& planes, const Threads& threads)
      : flights_(flights), planes_(planes), list_(std::move(broad_phase), skin, threads) {}

  /// Between steps: sorts the balls in memory now and then.
  void sort() {
    if (!list_.is_out_of_order()) return;
    flights_.land();
    list_.sort(flights_.world());
  }

  /// @pre the flights of the step have begun
  void begin_step() {
    if (list_.holds(longest_path())) return;
    flights_.land();
    if constexpr (!Balls::kFieldsAct) list_.measure_speeds(world());
    const bool lasts = list_.may_last(longest_path());
    list_.build(world(), planes_,
                [&](std::size_t ball) { return lasts ? 0.0 : flights_.path_bound(ball, flights_.step_s()); });
    last_of_.assign(world().size(), kNone);
    before_.clear();
    chain_new_pairs();
    for (const std::uint32_t ball : list_.fast()) hurry(ball, flights_.path_bound(ball, flights_.step_s()));
  }

  void end_step() { list_.travelled(longest_path()); }

  /// A ball was put this far away, m.
  void jumped(std::size_t ball, double way_m) { list_.jumped(ball, way_m); }

  /// All balls land, and test(first, end, found) gets the pairs, stretch by stretch.
  template <class Found, class Test>
  void land_and_test(Found& found, const Test& test) {
    list_.sweep([this](std::size_t begin, std::size_t end) { flights_.land(begin, end); }, found, test);
    flights_.all_have_landed();
  }

  /// Two balls that may meet in this step, or in a later one.
  std::span<const BallPair> pairs() const { return list_.pairs(); }
  /// A ball and a plane that may; some stand here twice.
  std::span<const BallPair> besides() const { return list_.besides(); }

  bool may_meet_in_step(std::size_t a, std::size_t b) const {
    return may_meet(flights_.reach(a), flights_.reach(b));
  }

  /// Every other ball that this one may meet in the step, in any order.
  void find_near(std::size_t ball, std::vector<std::uint32_t>& others) const {
    others.clear();
    for_each_listed(ball, [&](std::uint32_t other) {
      if (may_meet_in_step(ball, other)) others.push_back(other);
    });
  }

  /// After a new flight has begun: notes where it may lead. Returns whether the ball may meet more than
  /// before.
  bool widen(std::size_t ball) {
    const bool farther = flights_.widen_reach(ball);
    const double way_m = flights_.way_in_step(ball);
    if constexpr (Balls::kFieldsAct) {
      // What presses it may be stronger than the fields.
      if (way_m > longest_path()) list_.jumped(ball, way_m - longest_path());
    }
    hurry(ball, way_m);
    return farther;
  }

  std::string_view name() const { return list_.name(); }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  const World<Dim>& world() const { return flights_.world(); }

  /// How far a ball that cruises may get in the step, m. Where fields act, that is any ball.
  double longest_path() const {
    if constexpr (Balls::kFieldsAct) return flights_.longest_path();
    return list_.cruise_mps() * flights_.step_s();
  }

  /// @param way_m  how far from where it began the step the ball may get in it
  void hurry(std::size_t ball, double way_m) {
    const double times = Balls::kFieldsAct ? 1.0 : list_.times_cruise(world(), ball);
    list_.hurry(world(), planes_, ball, {.way_m = way_m, .cruisers_way_m = longest_path(), .times = times},
                [&](std::uint32_t other) { return !is_listed(ball, other); });
    chain_new_pairs();
  }

  template <class Visit>
  void for_each_listed(std::size_t ball, const Visit& visit) const {
    const std::span<const BallPair> pairs = list_.pairs();
    for (std::uint32_t k = last_of_[ball]; k != kNone;) {
      const bool is_second = pairs[k].second == ball;
      visit(is_second ? pairs[k].first : pairs[k].second);
      k = is_second ? before_[k].second : before_[k].first;
    }
  }

  bool is_listed(std::size_t ball, std::uint32_t other) const {
    bool listed = false;
    for_each_listed(ball, [&](std::uint32_t each) { listed = listed || each == other; });
    return listed;
  }

  void chain_new_pairs() {
    const std::span<const BallPair> pairs = list_.pairs();
    for (auto k = static_cast<std::uint32_t>(before_.size()); k < pairs.size(); ++k) {
      const auto [first, second] = pairs[k];
      before_.emplace_back(last_of_[first], last_of_[second]);
      last_of_[first] = last_of_[second] = k;
    }
  }

  Balls& flights_;
  const std::vector<Plane<Dim>>& planes_;
  PairList<Dim> list_;
  Column<std::uint32_t> last_of_;  ///< of each ball, its last pair in the list
  /// Of each pair, the pairs before it that its first and its second ball are in.
  Column<std::pair<std::uint32_t, std::uint32_t>> before_;
};

}  // namespace carom
