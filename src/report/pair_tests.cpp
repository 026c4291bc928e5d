#include "report/pair_tests.h"

#include <map>

#include "carom/broad_phase/brute_force.h"
#include "carom/broad_phase/count.h"
#include "carom/broad_phase/tree.h"
#include "scenario/cast.h"

namespace carom {

namespace {

/// The balls of one frame as a broad phase takes them.
template <int Dim>
struct Standing {
  VectorColumn<Dim> position;  ///< m
  std::vector<float> bound;    ///< m
};

template <int Dim>
Standing<Dim> standing(const Cast& cast, std::span<const BallState> states) {
  std::vector<std::size_t> there;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (cast[i]) there.push_back(i);
  }
  Standing<Dim> balls{VectorColumn<Dim>(there.size()), {}};
  for (std::size_t k = 0; k < there.size(); ++k) {
    balls.position.set(k, states[there[k]].position.head<Dim>());
    balls.bound.push_back(rounded_up(cast[there[k]]->radius));
  }
  return balls;
}

template <class BroadPhase, int Dim>
std::int64_t pair_tests(const Standing<Dim>& balls) {
  BroadPhase broad_phase;
  broad_phase.build(balls.position, balls.bound);
  broad_phase.for_each_pair([](std::size_t, std::size_t) {});
  return broad_phase.count().pair_tests();
}

template <int Dim>
PairTests count_in(const Scenario& scenario, const Trajectory& trajectory,
                   std::span<const std::size_t> frames) {
  PairTests tests;
  // Looking at all pairs takes as many looks wherever the balls are: each number of balls is asked once.
  std::map<std::size_t, std::int64_t> brute_force;
  Cast cast(scenario);
  for (const std::size_t k : frames) {
    cast.to_frame(static_cast<std::int64_t>(k));
    const Standing<Dim> balls = standing<Dim>(cast, trajectory.frame(k));
    const auto [row, is_new] = brute_force.try_emplace(balls.bound.size());
    if (is_new) row->second = pair_tests<BruteForce<Dim, CountTests>>(balls);
    tests.brute_force.push_back(row->second);
    tests.tree.push_back(pair_tests<Tree<Dim, CountTests>>(balls));
  }
  return tests;
}

}  // namespace

PairTests count_pair_tests(const Scenario& scenario, const Trajectory& trajectory,
                           std::span<const std::size_t> frames) {
  return scenario.dimension == 2 ? count_in<2>(scenario, trajectory, frames)
                                 : count_in<3>(scenario, trajectory, frames);
}

}  // namespace carom
