#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "carom/broad_phase/pair_list.h"
#include "carom/broad_phase/reach.h"
#include "carom/plane.h"

namespace carom {

/// Which balls may meet in a step, by how far each may get in it. `Balls` are Flights (flights.h).
///
/// Pairs come from a list that serves many steps (pair_list.h). Whom a ball may meet that was hit is asked of
/// the broad phase as it was built for the list: its bound there holds for all these steps, and grows when
/// the ball may get farther. What either finds is held against the reaches in this step, so that nothing
/// depends on how long a list lives.
template <int Dim, class Balls>
class Neighbours {
 public:
  Neighbours(Balls& flights, std::unique_ptr<BroadPhase<Dim>> broad_phase, PairSkin skin,
             const std::vector<Plane<Dim>>& planes, const Threads& threads)
      : flights_(flights),
        planes_(planes),
        list_(std::move(broad_phase), skin, threads),
        start_(flights.size()) {}

  /// Between steps: sorts the balls in memory now and then.
  void sort() { list_.sort(flights_.world()); }

  /// @pre the flights of the step have begun
  void begin_step() {
    if (!list_.holds(flights_.longest_path())) {
      start_ = flights_.world().position;
      list_.build(flights_.world(), start_, planes_,
                  [this](std::size_t ball) { return flights_.path_bound(ball, flights_.step_s()); });
      flights_.measure_fastest();
    }
    list_.travelled(flights_.longest_path());
  }

  /// Two balls that may meet in this step, or in a later one.
  std::span<const BallPair> pairs() const { return list_.pairs(); }
  /// A ball and a plane that may.
  std::span<const BallPair> besides() const { return list_.besides(); }

  bool may_meet_in_step(std::size_t a, std::size_t b) const {
    return may_meet(flights_.reach(a), flights_.reach(b));
  }

  /// Every other ball that this one may meet in the step, in any order.
  void find_near(std::size_t ball, std::vector<std::uint32_t>& others) const {
    list_.broad_phase().find_near(ball, others);
    std::erase_if(others, [&](std::uint32_t other) { return !may_meet_in_step(ball, other); });
  }

  /// After a new flight has begun: notes where it may lead. Returns whether the ball may meet more than
  /// before.
  bool widen(std::size_t ball) {
    if (!flights_.widen_reach(ball)) return false;
    const double moved = (flights_.world().position[ball] - start_[ball]).norm();
    list_.strays(ball, flights_.world().radius[ball],
                 moved + flights_.path_bound(ball, flights_.left_s(ball)));
    return true;
  }

  std::string_view name() const { return list_.name(); }

 private:
  Balls& flights_;
  const std::vector<Plane<Dim>>& planes_;
  PairList<Dim> list_;
  VectorColumn<Dim> start_;  ///< positions when the list was made
};

}  // namespace carom
