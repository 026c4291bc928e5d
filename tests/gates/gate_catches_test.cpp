#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "app/commands.h"
#include "core/files.h"
#include "tests/gates/catches.h"
#include "tests/support/folder.h"

// The gates are themselves tested: a right engine passes them, and every broken one is caught by the gate
// whose business it is.

namespace carom::gates {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A value that is caught is beyond its limit by more than rounding or chance would bring it.
constexpr double kClearly = 10.0;

const std::vector<Catch>& catches() {
  static const std::vector<Catch> all = run_catches(CAROM_TEST_ENGINE_DIR);
  return all;
}

TEST(Gates, EveryBrokenEngine_IsCaught_ByTheGateWhoseBusinessItIs) {
  EXPECT_GE(catches().size(), 14U);
  for (const Catch& row : catches()) {
    EXPECT_FALSE(row.scene.empty()) << row.engine << " has no gate that must catch it";
    EXPECT_TRUE(row.caught) << row.engine << " is not caught in " << row.scene << " by " << row.metric << ": "
                            << row.value << ", limit " << row.limit;
    EXPECT_GT(row.value, kClearly * row.limit) << row.engine << " is caught by accident";
  }
}

TEST(Gates, EveryRowOfTheTable_HasItsBrokenEngine) {
  std::set<std::string> broken;
  for (const Catch& row : catches()) broken.insert(row.engine);
  std::set<std::string> named;
  for (const Catcher& row : kCatchers) named.insert("plain@" + std::string(row.defect));
  EXPECT_EQ(named, broken);
}

/// Else the broken ones would be caught for what is wrong with all of them.
TEST(Gates, TheUnbrokenEngine_PassesAllThatItCanRun) {
  const test::TestFolder folder;
  const std::string file = (folder / "unbroken.json").string();
  Options options;
  options.command = "check";
  options.scenes = {"course/", "flight/", "friction/", "impact/", "line/", "wall/"};
  for (const Catcher& row : kCatchers) options.scenes.emplace_back(row.scene);
  options.engines = {"plain"};
  options.engines_from = {CAROM_TEST_ENGINE_DIR};
  options.json_file = file;
  options.parallel = 2;
  testing::internal::CaptureStdout();  // what it cannot run is told at length
  compare_command(options);
  testing::internal::GetCapturedStdout();
  std::set<std::string> passed;
  const json results = json::parse(read_file(file));
  for (const json& scene : results.at("scenes")) {
    const json& run = scene.at("runs").at(0);
    if (run.at("status") == "unsupported") continue;
    EXPECT_EQ(run.at("verdict"), "pass") << scene.at("id") << " " << run.at("reason") << run.at("gates");
    passed.insert(scene.at("id"));
  }
  for (const Catcher& row : kCatchers) EXPECT_TRUE(passed.contains(std::string(row.scene))) << row.scene;
}

/// The page shows what the engines do. tests/benchmarks/run writes the file anew.
TEST(Gates, WhatThePageShows_IsWhatTheEnginesDo) {
  const json written = json::parse(read_file(fs::path(CAROM_SOURCE_DIR) / "reports/measured/gates.json"));
  const json now = json::parse(catches_json(catches()));
  ASSERT_EQ(written.at("catches").size(), now.at("catches").size());
  for (std::size_t i = 0; i < now.at("catches").size(); ++i) {
    json was = written.at("catches")[i];
    json is = now.at("catches")[i];
    // Where it is rounding that is caught, another compiler may round otherwise.
    EXPECT_LT(was.at("value").get<double>(), 2.0 * is.at("value").get<double>());
    EXPECT_GT(was.at("value").get<double>(), 0.5 * is.at("value").get<double>());
    was.erase("value");
    is.erase("value");
    EXPECT_EQ(was, is);
  }
}

}  // namespace
}  // namespace carom::gates
