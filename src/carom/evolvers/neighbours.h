#pragma once

#include <cstdint>
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
/// from it as well, and noted ball by ball: one place in memory to look at. What is found is held against the
/// reaches in this step, so that nothing depends on what else is listed.
template <int Dim, class Balls>
class Neighbours {
 public:
  Neighbours(Balls& flights, std::unique_ptr<BroadPhase<Dim>> broad_phase, Listed listed,
             const std::vector<Plane<Dim>>& planes, const Threads& threads)
      : flights_(flights), planes_(planes), list_(std::move(broad_phase), listed, threads) {}

  /// Whether nothing has to be looked for anew before the next step, if that is as long as the last.
  bool hold_for_a_step() const { return list_.holds(longest_path()); }

  /// Between steps: sorts the balls in memory now and then, when a list is about to end.
  void sort() {
    if (!list_.is_out_of_order() || hold_for_a_step()) return;
    flights_.land();
    list_.sort(flights_.world());
  }

  /// @pre the flights of the step have begun
  void begin_step() {
    if (list_.holds(longest_path())) return;
    flights_.land();
    if constexpr (!Balls::kFieldsAct) list_.measure_speeds(world());
    if (list_.may_last(longest_path())) {
      list_.build(world(), planes_, flights_.step_s());
    } else {
      list_.build_for_a_step(world(), planes_, flights_.step_s(), [this](std::size_t ball) {
        return flights_.path_bound(ball, flights_.step_s());
      });
    }
    if constexpr (Balls::kFieldsAct) list_.note_neighbours(world());
  }

  /// @pre the flights of the step have ended, but for the balls' landing
  void end_step() { list_.travelled(longest_path(), flights_.step_s()); }

  /// Between steps: ends the list, or where it holds asks anew when those meet that were touched.
  void expect_anew(bool holds) requires(!Balls::kFieldsAct) {
    holds ? list_.expect_anew(world(), flights_.flown_s(), flights_.touched()) : list_.end();
  }

  /// A ball was put this far away, m.
  void jumped(std::size_t ball, double way_m) { list_.jumped(ball, way_m); }

  /// At the step's start: appends all pairs that may meet in it, some twice, if the cheap question
  /// come_near(a, b) does not say that they do not.
  template <class Question>
  void find_meeting(std::vector<BallPair>& meeting, const Question& come_near) {
    constexpr std::size_t kAhead = 32;
    list_.template for_each_due<kAhead>(
        world(), longest_path(), flights_.step_s(), meeting, come_near,
        [this](std::uint32_t a, std::uint32_t b, std::vector<BallPair>& found) {
          if (may_meet_in_step(a, b)) found.emplace_back(a, b);
        });
  }

  /// A ball and a plane that may; some stand here twice.
  std::span<const BallPair> besides() const { return list_.besides(); }

  bool may_meet_in_step(std::size_t a, std::size_t b) const {
    return may_meet(flights_.reach(a), flights_.reach(b));
  }

  /// Has the processor load what is soon asked about a ball, and about its neighbours.
  void fetch(std::size_t ball) const {
    flights_.fetch(ball);
    list_.neighbours().fetch(static_cast<std::uint32_t>(ball));
  }
  void fetch_around(std::size_t ball) const {
    list_.neighbours().for_each(static_cast<std::uint32_t>(ball),
                                [this](std::uint32_t other) { flights_.fetch(other); });
  }

  /// Every other ball that this one may meet in the step, in any order.
  void find_near(std::size_t ball, std::vector<std::uint32_t>& others) const {
    others.clear();
    list_.neighbours().for_each(static_cast<std::uint32_t>(ball), [&](std::uint32_t other) {
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
  const World<Dim>& world() const { return flights_.world(); }

  /// How far a ball that cruises may get in the step, m. Where fields act, that is any ball.
  double longest_path() const {
    if constexpr (Balls::kFieldsAct) return flights_.longest_path();
    return list_.cruise().mps() * flights_.step_s();
  }

  /// @param way_m  how far from where it began the step the ball may get in it
  void hurry(std::size_t ball, double way_m) {
    const double times = Balls::kFieldsAct ? 1.0 : list_.cruise().times(world(), ball);
    list_.hurry(world(), planes_, ball, {.way_m = way_m, .cruisers_way_m = longest_path(), .times = times},
                [this](std::size_t any) { return flights_.place(any); });
  }

  Balls& flights_;
  const std::vector<Plane<Dim>>& planes_;
  PairList<Dim, Balls::kFieldsAct> list_;
};

}  // namespace carom
