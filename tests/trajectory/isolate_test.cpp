#include "trajectory/isolate.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>

namespace carom::test {
namespace {

ProcessOutcome run_one(const Job& job, const ProcessLimits& limits = {}) {
  return run_isolated({job}, limits, 1).front();
}

TEST(Isolation, HandsBackThePayloadWhole) {
  std::string megabytes(5'000'000, 'x');
  const ProcessOutcome outcome = run_one([&] { return megabytes; });
  EXPECT_EQ(outcome.end, ProcessEnd::finished);
  EXPECT_TRUE(outcome.payload == megabytes);
}

TEST(Isolation, KeepsBytesAsTheyAre) {
  std::string bytes("a\0b\x06\n\x06", 6);
  EXPECT_EQ(run_one([&] { return bytes; }).payload, bytes);
}

TEST(Isolation, Signal_IsACrash_WithTheSignalAndTheLastWords) {
  const ProcessOutcome outcome = run_one([]() -> std::string {
    std::fputs("first line\nlast words\n", stderr);
    std::raise(SIGSEGV);
    return "";
  });
  EXPECT_EQ(outcome.end, ProcessEnd::crashed);
#if !defined( \
    __SANITIZE_ADDRESS__)  // the sanitizer turns the signal into a report and an exit code of its own
  EXPECT_NE(outcome.reason.find("signal 11"), std::string::npos) << outcome.reason;
  EXPECT_NE(outcome.reason.find("last words"), std::string::npos) << outcome.reason;
#endif
}

TEST(Isolation, Exception_IsACrash_WithItsMessage) {
  const ProcessOutcome outcome =
      run_one([]() -> std::string { throw std::runtime_error("the matrix is singular"); });
  EXPECT_EQ(outcome.end, ProcessEnd::crashed);
  EXPECT_EQ(outcome.reason, "the matrix is singular");
}

TEST(Isolation, ExitWithZero_IsACrash_BecauseNothingWasHandedBack) {
  const ProcessOutcome outcome = run_one([]() -> std::string { _exit(0); });
  EXPECT_EQ(outcome.end, ProcessEnd::crashed);
  EXPECT_NE(outcome.reason.find("without a result"), std::string::npos) << outcome.reason;
}

TEST(Isolation, Hang_IsStopped_WithWhatItStarted) {
  const ProcessOutcome outcome = run_one(
      []() -> std::string {
        if (fork() == 0) std::this_thread::sleep_for(std::chrono::hours(1));
        std::this_thread::sleep_for(std::chrono::hours(1));
        return "";
      },
      {.wall_seconds = 0.2});
  EXPECT_EQ(outcome.end, ProcessEnd::timed_out);
}

TEST(Isolation, AGrandchildThatHoldsThePipe_DoesNotHoldUpTheResult) {
  const ProcessOutcome outcome = run_one([]() -> std::string {
    if (fork() == 0) {
      std::this_thread::sleep_for(std::chrono::hours(1));
      _exit(0);
    }
    return "done";
  });
  EXPECT_EQ(outcome.end, ProcessEnd::finished);
  EXPECT_EQ(outcome.payload, "done");
}

TEST(Isolation, WhoClosesAllFiles_IsWaitedFor_AndItsEndIsSeenAtOnce) {
  // Else it would be found at the deadline, and taken for a hang.
  const ProcessOutcome outcome = run_one(
      []() -> std::string {
        for (int file = 0; file < 64; ++file) close(file);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        std::raise(SIGKILL);
        return "";
      },
      {.wall_seconds = 20.0});
  EXPECT_EQ(outcome.end, ProcessEnd::crashed);
  EXPECT_NE(outcome.reason.find("signal 9"), std::string::npos) << outcome.reason;
}

TEST(Isolation, OutputOnStdout_GoesNowhere) {
  testing::internal::CaptureStdout();
  run_one([]() -> std::string {
    std::puts("noise of a library");
    std::fflush(stdout);
    return "";
  });
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(Isolation, OneThatFails_LeavesTheOthersAlone) {
  std::vector<Job> jobs;
  jobs.reserve(20);
  for (int i = 0; i < 20; ++i) {
    jobs.emplace_back([i]() -> std::string {
      if (i % 3 == 1) std::abort();
      return std::to_string(i);
    });
  }
  std::vector<std::size_t> done;
  const auto outcomes = run_isolated(jobs, {}, 4, [&](std::size_t job) { done.push_back(job); });
  EXPECT_EQ(done.size(), jobs.size());
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const bool aborted = i % 3 == 1;
    EXPECT_EQ(outcomes[i].end, aborted ? ProcessEnd::crashed : ProcessEnd::finished);
    EXPECT_EQ(outcomes[i].payload, aborted ? "" : std::to_string(i));
  }
}

}  // namespace
}  // namespace carom::test
