#include "app/machine.h"

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <thread>

namespace carom {

namespace {

std::string cpu_model() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

Machine this_machine() {
  Machine machine;
  machine.cpu = cpu_model();
  machine.cores = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U));
#if defined(__clang__)
  machine.compiler = fmt::format("Clang {}", __clang_version__);
#else
  machine.compiler = fmt::format("GCC {}", __VERSION__);
#endif
  machine.build = CAROM_BUILD_TYPE;
  machine.flags = CAROM_BUILD_FLAGS;
  return machine;
}

}  // namespace carom
