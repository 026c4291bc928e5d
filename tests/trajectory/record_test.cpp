#include "trajectory/record.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "engine/modules.h"
#include "scenario/parse.h"
#include "tests/engines/still.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

/// Flies straight on, and knows how many steps it was asked for.
class FreeFlight final : public StillSimulation {
 public:
  using StillSimulation::StillSimulation;
  void advance(double step_s, std::int64_t steps) override {
    for (BallState& state : states_) state.position += step_s * static_cast<double>(steps) * state.velocity;
    steps_ += steps;
  }
  Tally tally() const override { return {.impacts = steps_}; }
  Settings settings() const override { return {{"number", 0.1}, {"flag", true}, {"word", std::string("a")}}; }

 private:
  std::int64_t steps_ = 0;
};

EngineSource free_flight() {
  return {"free", []() -> const Engine& {
            static const TestEngine<FreeFlight> engine;
            return engine;
          }};
}

EngineSource broken(const std::string& name) {
  return {name, [name]() -> const Engine& {
            return open_engine_module(std::filesystem::path(CAROM_TEST_ENGINE_DIR) / (name + ".so"));
          }};
}

ScenarioPtr two_balls() {
  return scene_of(R"(
    title = "two"
    dimension = 2
    duration = 2.0
    step = 0.03
    frames = 20
    [[ball]]
    mass = 1
    radius = 0.1
    position = [0, 0]
    velocity = [1, 0.5]
    [[ball]]
    mass = 1
    radius = 0.1
    position = [5, 0]
  )");
}

TEST(Record, FramesAreEvenAndInterval_IsCutIntoTheFewestStepsNotLongerThanAsked) {
  const ScenarioPtr scene = two_balls();
  EXPECT_EQ(steps_per_frame(*scene), 4);  // 0.1 s by 0.03 s
  const carom::Run run = run_engines(*scene, {{free_flight()}}, {}, 1).front();
  ASSERT_EQ(run.status, RunStatus::ok) << run.reason;
  EXPECT_EQ(run.steps, 80);
  EXPECT_EQ(run.trajectory.frames(), 21U);
  for (std::size_t k = 0; k < 21; ++k) {
    EXPECT_EQ(run.trajectory.time(k), 2.0 * static_cast<double>(k) / 20.0);
    EXPECT_NEAR(run.trajectory.frame(k)[0].position.x(), run.trajectory.time(k), 1e-14);
    EXPECT_EQ(run.trajectory.tally(k).impacts, static_cast<std::int64_t>(4 * k));
  }
  EXPECT_EQ(std::get<double>(run.settings.at("number")), 0.1);
  EXPECT_EQ(std::get<bool>(run.settings.at("flag")), true);
  EXPECT_EQ(std::get<std::string>(run.settings.at("word")), "a");
}

TEST(Record, AStepThatDividesTheInterval_IsNotCutFurther_ByRounding) {
  Scenario scene = *two_balls();
  for (const auto& [duration, frames, step, expected] : {std::tuple{1.0, 10, 0.01, 10},
                                                         {0.3, 3, 0.1, 1},
                                                         {2.0, 120, 1.0 / 240.0, 4},
                                                         {30.0, 300, 0.001, 100}}) {
    scene.duration_s = duration;
    scene.frames = frames;
    scene.step_s = step;
    EXPECT_EQ(steps_per_frame(scene), expected) << duration << " s, " << frames << " frames, step " << step;
  }
}

struct BrokenCase {
  std::string engine;
  RunStatus status;
  std::string reason;
};

class BrokenEngine : public testing::TestWithParam<BrokenCase> {};

TEST_P(BrokenEngine, IsARow_AndTheOthersAreAsWithoutIt) {
  const ScenarioPtr scene = two_balls();
  const ProcessLimits limits{.wall_seconds = 3.0, .memory_mib = 512.0};
  const std::vector<carom::Run> alone = run_engines(*scene, {{free_flight()}}, limits, 2);
  const std::vector<carom::Run> runs =
      run_engines(*scene, {{free_flight()}, {broken(GetParam().engine)}, {free_flight()}}, limits, 2);
  EXPECT_EQ(runs[1].status, GetParam().status);
#if !defined(__SANITIZE_ADDRESS__)  // under the sanitizer a crash is told in its words
  EXPECT_NE(runs[1].reason.find(GetParam().reason), std::string::npos) << runs[1].reason;
#endif
  for (const std::size_t healthy : {std::size_t{0}, std::size_t{2}}) {
    ASSERT_EQ(runs[healthy].status, RunStatus::ok);
    for (std::size_t k = 0; k < alone[0].trajectory.frames(); ++k) {
      EXPECT_EQ(runs[healthy].trajectory.frame(k)[0].position, alone[0].trajectory.frame(k)[0].position);
    }
  }
}

std::vector<BrokenCase> broken_cases() {
  std::vector<BrokenCase> cases = {
      {"broken-crash", RunStatus::crashed, "signal 11"},
      {"broken-abort", RunStatus::crashed, "Assertion `mass > 0' failed"},
      {"broken-exit", RunStatus::crashed, "without a result"},
      {"broken-throw", RunStatus::crashed, "an unknown exception"},
      {"broken-hang", RunStatus::timeout, "stopped after 3 s"},
      {"broken-nan", RunStatus::invalid, "ball 1 is not finite at t = 0.1"},
      {"broken-silent", RunStatus::invalid, "ball 1 is not finite at t = 0"},
      {"no-such-module", RunStatus::crashed, "cannot load engine"},
  };
#if !defined( \
    __SANITIZE_ADDRESS__)  // which reserves all the address space there is, so that no limit can be set
  cases.push_back({"broken-memory", RunStatus::crashed, "out of memory (--memory 512 MiB)"});
#endif
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Kinds, BrokenEngine, testing::ValuesIn(broken_cases()), [](const auto& info) {
  std::string name = info.param.engine;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Record, WhatAnEngineCannotDo_IsUnsupported_WithTheReason) {
  class Picky final : public Engine {
   public:
    EngineInfo info() const override {
      EngineInfo info;
      info.cannot = {{Feature::gravity, "it floats"}};
      return info;
    }
    std::unique_ptr<Simulation> create(const Scenario& scene, std::string_view) const override {
      return std::make_unique<FreeFlight>(scene);
    }
  };
  static const Picky picky;
  Scenario scene = *two_balls();
  const EngineChoice choice{{"picky", []() -> const Engine& { return picky; }}};
  EXPECT_EQ(run_engines(scene, {choice}, {}, 1).front().status, RunStatus::ok);
  scene.effects.gravity = Vec3(0, -1, 0);
  const carom::Run run = run_engines(scene, {choice}, {}, 1).front();
  EXPECT_EQ(run.status, RunStatus::unsupported);
  EXPECT_EQ(run.reason, "gravity: it floats");
}

TEST(Describe, TellsWhatAnEngineSays_AndWhyOneCannotBeOpened) {
  const auto infos = describe_engines({free_flight(), broken("no-such-module")}, {}, 2);
  EXPECT_EQ(infos[0].about, "An engine that is broken on purpose");
  ASSERT_EQ(infos[0].profiles.size(), 1U);
  EXPECT_EQ(infos[0].profiles[0].name, "faithful");
  EXPECT_TRUE(infos[1].about.empty());
  EXPECT_NE(infos[1].version.find("cannot load"), std::string::npos);
}

}  // namespace
}  // namespace carom::test
