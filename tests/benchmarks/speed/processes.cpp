#include "tests/benchmarks/speed/processes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"

namespace carom::benchmark {

namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

[[noreturn]] void become(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDOUT_FILENO);
  execv(arguments.front(), arguments.data());
  _exit(EXIT_FAILURE);
}

}  // namespace

Spent run_program(const std::vector<std::string>& words) {
  const pid_t child = fork();
  if (child < 0) throw MachineError("no process can be started");
  if (child == 0) become(words);
  int status = 0;
  rusage used{};
  if (wait4(child, &status, 0, &used) != child) throw MachineError("a process was lost");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw MachineError(words.front() + " failed");
  constexpr double kKibibyte = 1024.0;
  return {seconds(used.ru_utime) + seconds(used.ru_stime), kKibibyte * static_cast<double>(used.ru_maxrss)};
}

}  // namespace carom::benchmark
