#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/options.h"
#include "core/error.h"
#include "core/files.h"
#include "study/study_json.h"
#include "tests/support/folder.h"
#include "tests/support/two_balls.h"

namespace carom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

class StudyCommand : public ::testing::Test {
 protected:
  StudyCommand() { write_file(file("pair.toml"), kTwoBalls); }

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
  TestFolder folder_;
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

TEST_F(StudyCommand, KeepsWhatItHasOfOtherScenes_WhenResumed) {
  study({"--repeats", "1", "--resume", file("kept.json")});
  Study other = parse_study(read_file(file("kept.json")), "kept.json");
  other.scenes[0].id = "impact/other";
  write_file(file("kept.json"), study_json(other));
  study({"--repeats", "1", "--resume", file("kept.json"), "--json", file("study.json")});
  const Study kept = parse_study(read_file(file("kept.json")), "kept.json");
  ASSERT_EQ(kept.scenes.size(), 2U);
  EXPECT_EQ(kept.scenes[1].id, "impact/other");
  EXPECT_EQ(kept.scenes[1].points[0].cpu_s, other.scenes[0].points[0].cpu_s);
  EXPECT_EQ(parse_study(read_file(file("study.json")), "study.json").scenes.size(), 1U);
}

/// The program on the scene, with far more to do than there is time, until this signal; its wait status.
int study_until(int signal, const std::string& scene, const std::string& kept, const std::string& json) {
  const pid_t program = fork();
  if (program == 0) {
    execl(CAROM_PROGRAM, CAROM_PROGRAM, "study", scene.c_str(), "--quiet", "--engine", "carom:step",
          "--repeats", "1000", "--budget", "1000", "--resume", kept.c_str(), "--json", json.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  // It is kept first when something is known.
  while (!fs::exists(kept) && waitpid(program, &status, WNOHANG) == 0) usleep(1000);
  kill(program, signal);
  waitpid(program, &status, 0);
  return status;
}

TEST_F(StudyCommand, LeavesWholeResults_WhenItIsStopped) {
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    const std::string kept = file(std::to_string(signal) + "-kept.json");
    const std::string json = file(std::to_string(signal) + "-study.json");
    const int status = study_until(signal, file("pair.toml"), kept, json);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), signal);
    const Study study = parse_study(read_file(kept), kept);
    ASSERT_EQ(study.scenes.size(), 1U);
    EXPECT_EQ(study.scenes[0].points.size(), 9U);
    EXPECT_EQ(study.scenes[0].points[0].status, RunStatus::ok);
    // One that is asked to stop writes what else was asked for; one that is killed cannot.
    EXPECT_EQ(fs::exists(json), signal != SIGKILL);
    if (fs::exists(json)) {
      EXPECT_EQ(study_json(parse_study(read_file(json), json)), read_file(kept));
    }
  }
}

TEST_F(StudyCommand, NamesWhatThereIsNot) {
  EXPECT_THAT(error_of({"--engine", "carom:warp"}), HasSubstr("carom:warp"));
  EXPECT_THROW(study_command(parsed({file("none.toml"), "--quiet"}).options), InputError);
}

TEST_F(StudyCommand, EndsWithTwo_OnBadUsage) {
  for (const Words& words : {Words{}, Words{"all", "--repeats", "0"}, Words{"all", "--budget", "0"},
                             Words{"all", "--timeout", "0"}, Words{"all", "--resume", ""},
                             Words{"all", "--step", "0.1"}, Words{"all", "--csv", ""}}) {
    EXPECT_EQ(parsed(words).exit_code, 2);
  }
}

}  // namespace
}  // namespace carom::test
