#pragma once

#include <string>
#include <vector>

namespace carom::benchmark {

/// What a program took, with all that it started and waited for.
struct Spent {
  double cpu_s = 0.0;
  double peak_bytes = 0.0;  ///< of memory in use at one time by the largest of its processes
};

/// Runs a program with these words and waits for it; what it prints is dropped.
/// @throws MachineError where it cannot be started or does not end with 0
Spent run_program(const std::vector<std::string>& words);

}  // namespace carom::benchmark
