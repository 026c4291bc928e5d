#pragma once

#include <functional>
#include <string>
#include <vector>

namespace carom {

/// What one isolated process may use.
struct ProcessLimits {
  double wall_seconds = 120.0;
  double memory_mib = 4096.0;  ///< on top of what the program has when the process starts
};

enum class ProcessEnd { finished, crashed, timed_out };

struct ProcessOutcome {
  ProcessEnd end = ProcessEnd::finished;
  std::string reason;   ///< why it did not finish: the signal, and the last line it wrote to stderr
  std::string payload;  ///< what the job returned
};

/// A job runs in a process of its own, forked from this one, and returns a string. An exception in it counts
/// as a crash, with its message for the reason. What it writes into memory shared with this process is seen
/// here.
using Job = std::function<std::string()>;

/// Runs the jobs, `parallel` at a time, each in its own process; `done` is called with the index of each as
/// it ends. A crash, an abort, an exit, a hang or exhausted memory ends that job alone.
/// @pre this process has a single thread. @throws MachineError where no process can be started.
std::vector<ProcessOutcome> run_isolated(const std::vector<Job>& jobs, const ProcessLimits& limits,
                                         int parallel, const std::function<void(std::size_t)>& done = {});

}  // namespace carom
