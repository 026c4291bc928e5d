#include "carom/threads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "carom/compose.h"
#include "core/random.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

// Threads share the balls of a scene, and no bit depends on how many there are.

namespace carom::test {
namespace {

class ThreadsOf : public testing::TestWithParam<std::size_t> {};

TEST_P(ThreadsOf, ReachEveryNumberOnce_AnySize) {
  const Threads threads(GetParam());
  for (const std::size_t size : {0U, 1U, 2U, 7U, 1000U}) {
    std::vector<int> reached(size, 0);
    threads.in_parallel(size, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++reached[i];
    });
    EXPECT_EQ(reached, std::vector<int>(size, 1));
  }
}

TEST_P(ThreadsOf, CollectInOrder_BehindWhatIsThere) {
  const Threads threads(GetParam());
  std::vector<std::size_t> found = {1000};
  threads.collect(100, found, [](std::size_t begin, std::size_t end, std::vector<std::size_t>& more) {
    for (std::size_t i = begin; i < end; ++i) more.push_back(i);
  });
  std::vector<std::size_t> expected(101, 1000);
  std::iota(expected.begin() + 1, expected.end(), std::size_t{0});
  EXPECT_EQ(found, expected);
}

TEST_P(ThreadsOf, CollectWhatIsDealtOut_EachOnce) {
  const Threads threads(GetParam());
  for (const std::size_t size : {0U, 1U, 128U, 129U, 5000U}) {
    std::vector<std::size_t> found = {size};
    threads.collect_dealt(size, found,
                          [](std::size_t begin, std::size_t end, std::vector<std::size_t>& more) {
                            for (std::size_t i = begin; i < end; ++i) more.push_back(i);
                          });
    std::sort(found.begin(), found.end());
    std::vector<std::size_t> expected(size + 1);
    std::iota(expected.begin(), expected.end(), std::size_t{0});
    EXPECT_EQ(found, expected) << size;
  }
}

TEST_P(ThreadsOf, Sort) {
  const Threads threads(GetParam());
  Random random(7);
  for (const std::size_t size : {0U, 1U, 2U, 9U, 1000U}) {
    std::vector<double> values(size);
    for (double& each : values) each = random.uniform();
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    threads.sort(values);
    EXPECT_EQ(values, sorted) << size;
  }
}

TEST_P(ThreadsOf, FindTheLargest_NotANumberCountsForNothing) {
  const Threads threads(GetParam());
  std::vector<double> values(101);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = std::sin(static_cast<double>(k));
  for (const std::size_t largest : {0U, 50U, 100U}) {
    std::vector<double> some = values;
    some[largest] = 2.0;
    some[51] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(threads.largest(some.size(), [&](std::size_t k) { return some[k]; }), 2.0);
  }
}

TEST_P(ThreadsOf, PassOnWhatOneThrows_AndWorkAgain) {
  const Threads threads(GetParam());
  const auto fail_at_end = [](std::size_t /*begin*/, std::size_t end) {
    if (end == 100) throw std::runtime_error("at the end");
  };
  EXPECT_THROW(threads.in_parallel(100, fail_at_end), std::runtime_error);
  std::atomic<std::size_t> reached = 0;
  threads.in_parallel(100, [&](std::size_t begin, std::size_t end) { reached += end - begin; });
  EXPECT_EQ(reached, 100U);
}

TEST_P(ThreadsOf, WorkAtOnce_AndAfterTheyFellAsleep) {
  const Threads threads(GetParam());
  std::atomic<std::size_t> reached = 0;
  for (int job = 0; job < 100; ++job) {
    // Far longer than they wait awake.
    if (job % 50 == 25) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    threads.in_parallel(100, [&](std::size_t begin, std::size_t end) { reached += end - begin; });
    ASSERT_EQ(reached, 100U * (static_cast<std::size_t>(job) + 1));
  }
}

INSTANTIATE_TEST_SUITE_P(Counts, ThreadsOf, testing::Values(1, 2, 3, 8));

// --- evolvers

constexpr std::int64_t kSteps = 60 / kPart;
constexpr double kStep_s = 0.02;

/// Few balls are enough: each thread's stretch of the balls begins and ends among balls that touch. Of listed
/// pairs threads take more at once, and the last scene has balls for many such pieces.
std::vector<std::pair<std::string, ScenarioPtr>> shared_scenes(int dimension) {
  const std::string down = dimension == 2 ? "[0.5, -9.81]" : "[0.5, -9.81, 0.25]";
  const auto dense = [&](std::uint64_t seed, const std::string& more) {
    return gas(dimension, 150, 0.25, dimension == 2 ? 22.0 : 9.0, seed, more);
  };
  std::vector<std::pair<std::string, ScenarioPtr>> scenes;
  scenes.emplace_back("gas", dense(1, ""));
  scenes.emplace_back("pile", dense(2, "[effects]\ngravity = " + down +
                                           "\nspin = true\ndrag = { linear = 0.1 }\n[contact]\n"
                                           "restitution = 0.6\nfriction = 0.3\n"));
  auto mixed = std::make_shared<Scenario>(*scenes.front().second);
  for (std::size_t i = 0; i < mixed->balls.size(); ++i) mixed->balls[i].radius *= i % 3 == 0 ? 1.0 : 0.05;
  mixed->balls[7].velocity *= 40.0;
  scenes.emplace_back("sizes and speeds", mixed);
  scenes.emplace_back("many", gas(dimension, 2'000, 0.25, dimension == 2 ? 80.0 : 21.0, 3));
  return scenes;
}

struct Outcome {
  std::vector<BallState> balls;
  Tally tally;
};

Outcome run_with(const Scenario& scene, const Variant& variant) {
  const auto simulation = compose(scene, variant);
  simulation->advance(kStep_s, kSteps);
  return {states_of(*simulation, scene.balls.size()), simulation->tally()};
}

void expect_same(const Outcome& one, const Outcome& other) {
  EXPECT_EQ(one.tally.impacts, other.tally.impacts);
  EXPECT_EQ(one.tally.wall_push_Ns, other.tally.wall_push_Ns);
  EXPECT_EQ(one.tally.external_impulse, other.tally.external_impulse);
  EXPECT_EQ(one.tally.external_angular_impulse, other.tally.external_angular_impulse);
  EXPECT_EQ(one.tally.energy.ball_impacts_J, other.tally.energy.ball_impacts_J);
  EXPECT_EQ(one.tally.energy.wall_impacts_J, other.tally.energy.wall_impacts_J);
  EXPECT_EQ(one.tally.energy.friction_J, other.tally.energy.friction_J);
  EXPECT_EQ(one.tally.energy.correction_J, other.tally.energy.correction_J);
  for (std::size_t i = 0; i < one.balls.size(); ++i) {
    ASSERT_EQ(one.balls[i].position, other.balls[i].position) << "ball " << i;
    ASSERT_EQ(one.balls[i].velocity, other.balls[i].velocity) << "ball " << i;
    ASSERT_EQ(one.balls[i].spin, other.balls[i].spin) << "ball " << i;
  }
}

/// As many as there are cores, an odd number, and more than there is work for.
const std::vector<std::size_t> kThreads =
    kPart == 1 ? std::vector<std::size_t>{2, 3, 8} : std::vector<std::size_t>{3};

class SharedEvolver : public testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(SharedEvolver, SameBits_WhateverTheNumberOfThreads) {
  const auto& [evolver, dimension] = GetParam();
  const std::string tree = dimension == 2 ? "quadtree" : "octree";
  for (const auto& [name, scene] : shared_scenes(dimension)) {
    for (const std::string& broad_phase : {std::string("wrapped-grid"), tree}) {
      SCOPED_TRACE(testing::Message() << name << ", " << broad_phase);
      const Outcome alone = run_with(*scene, {evolver, broad_phase});
      EXPECT_GT(alone.tally.impacts, 0);
      for (const std::size_t threads : kThreads) {
        SCOPED_TRACE(testing::Message() << threads << " threads");
        expect_same(alone, run_with(*scene, {evolver, broad_phase, Listed::kNear, threads}));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Evolvers, SharedEvolver,
                         testing::Combine(testing::Values("step", "toi"), testing::Values(2, 3)),
                         [](const auto& info) {
                           return std::get<0>(info.param) + std::to_string(std::get<1>(info.param)) + "D";
                         });

}  // namespace
}  // namespace carom::test
