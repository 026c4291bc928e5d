#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenario/scenario.h"
#include "trajectory/trajectory.h"

namespace carom {

/// How often two balls were looked at to find those that touch, frame by frame.
struct PairTests {
  std::vector<std::int64_t> brute_force;
  std::vector<std::int64_t> tree;  ///< the quadtree, in space the octree
};

/// What Carom's own broad phases (carom/broad_phase) look at in these frames of a run: they are given the
/// balls as they stand, each with its radius as its bound, and count. In a step they look at no other pairs,
/// but give each ball room to move, and use what they find for several steps.
/// @param frames  ascending
PairTests count_pair_tests(const Scenario& scenario, const Trajectory& trajectory,
                           std::span<const std::size_t> frames);

}  // namespace carom
