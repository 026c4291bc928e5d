#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/options.h"
#include "core/error.h"
#include "core/files.h"
#include "study/study_json.h"

namespace carom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

constexpr const char* kPair = R"(title = "Two balls"
dimension = 2
duration = 1.0
step = 0.1
frames = 4
[[ball]]
mass = 1
radius = 0.1
position = [0, 0]
velocity = [1, 0]
[[ball]]
mass = 1
radius = 0.1
position = [0.5, 0.05]
)";

class StudyCommand : public ::testing::Test {
 protected:
  StudyCommand() : folder_(fs::temp_directory_path() / ("carom-study-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "pair.toml") << kPair;
  }
  ~StudyCommand() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  static Parsed parsed(Words words) {
    words.insert(words.begin(), {"carom", "study"});
    std::vector<char*> pointers;
    pointers.reserve(words.size());
    for (std::string& word : words) pointers.push_back(word.data());
    return parse_options(static_cast<int>(pointers.size()), pointers.data());
  }

  /// The command with these words after the scene.
  ExitCode study(const Words& more) const {
    Words words = {file("pair.toml"), "--quiet", "--engine", "carom:step", "--engine", "carom:event"};
    words.insert(words.end(), more.begin(), more.end());
    return study_command(parsed(words).options);
  }

  std::string error_of(const Words& words) const {
    try {
      study(words);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

  static void forget_times(Study& study) {
    for (StudyScene& scene : study.scenes) {
      for (StudyPoint& point : scene.points) {
        point.recorded_cpu_s = 0.0;
        for (double& each : point.cpu_s) each = 0.0;
      }
    }
  }

 private:
  fs::path folder_;
};

TEST_F(StudyCommand, WritesJsonAndCsv_OfEveryPoint) {
  EXPECT_EQ(study({"--repeats", "1", "--json", file("study.json"), "--csv", file("study.csv")}),
            ExitCode::holds);
  const Study read = parse_study(read_file(file("study.json")), "study.json");
  ASSERT_EQ(read.scenes.size(), 1U);
  EXPECT_EQ(read.scenes[0].truth, "closed-form");
  // Nine steps of one evolver, and the other, which has none.
  EXPECT_EQ(read.scenes[0].points.size(), 10U);
  for (const StudyPoint& point : read.scenes[0].points) {
    EXPECT_EQ(point.status, RunStatus::ok);
    EXPECT_EQ(point.cpu_s.size(), 1U);
    EXPECT_TRUE(point.errors.position_m);
  }
  EXPECT_FALSE(read.machine.compiler.empty());
  EXPECT_THAT(read_file(file("study.csv")), HasSubstr("carom:event"));
}

TEST_F(StudyCommand, GivesTheSameRows_WhenResumed) {
  study({"--repeats", "1", "--resume", file("kept.json")});
  Study whole = parse_study(read_file(file("kept.json")), "kept.json");
  // As if it had been stopped before the last three points.
  Study stopped = whole;
  stopped.scenes[0].points.resize(whole.scenes[0].points.size() - 3);
  write_file(file("kept.json"), study_json(stopped));
  study({"--repeats", "1", "--resume", file("kept.json"), "--json", file("study.json")});
  Study resumed = parse_study(read_file(file("study.json")), "study.json");
  EXPECT_EQ(resumed.scenes[0].points[0].cpu_s, whole.scenes[0].points[0].cpu_s) << "not timed again";
  forget_times(whole);
  forget_times(resumed);
  EXPECT_EQ(study_json(resumed), study_json(whole));
}

TEST_F(StudyCommand, RefusesToResume_WhatIsOfOtherLimitsOrNoStudy) {
  study({"--repeats", "1", "--resume", file("kept.json")});
  EXPECT_THAT(error_of({"--repeats", "2", "--resume", file("kept.json")}), HasSubstr("--repeats 1"));
  Study other = parse_study(read_file(file("kept.json")), "kept.json");
  other.machine.cpu = "another machine";
  write_file(file("kept.json"), study_json(other));
  EXPECT_THAT(error_of({"--repeats", "1", "--resume", file("kept.json")}), HasSubstr("another machine"));
  EXPECT_THAT(error_of({"--resume", file("pair.toml")}), HasSubstr("pair.toml: not a study"));
}

TEST_F(StudyCommand, StudiesALaw_BesideTheOthers) {
  EXPECT_EQ(study({"--law", "right", "--json", file("law.json"), "--repeats", "1"}), ExitCode::holds);
  const Study made = parse_study(read_file(file("law.json")), "law.json");
  ASSERT_EQ(made.scenes.size(), 1U);
  EXPECT_THAT(made.scenes[0].engines,
              ::testing::ElementsAre(::testing::Field(&StudyEngine::label, "carom:step"),
                                     ::testing::Field(&StudyEngine::label, "carom:event"),
                                     ::testing::Field(&StudyEngine::label, "carom:law@right")));
}

TEST_F(StudyCommand, NamesWhatThereIsNot) {
  EXPECT_THAT(error_of({"--engine", "carom:warp"}), HasSubstr("carom:warp"));
  EXPECT_THROW(study_command(parsed({file("none.toml"), "--quiet"}).options), InputError);
}

TEST_F(StudyCommand, EndsWithTwo_OnBadUsage) {
  for (const Words& words :
       {Words{}, Words{"all", "--repeats", "0"}, Words{"all", "--timeout", "0"}, Words{"all", "--resume", ""},
        Words{"all", "--step", "0.1"}, Words{"all", "--csv", ""}}) {
    EXPECT_EQ(parsed(words).exit_code, 2);
  }
}

}  // namespace
}  // namespace carom::test
