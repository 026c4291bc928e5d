#include "tests/benchmarks/speed/processes.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"

namespace carom::benchmark {

namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// As a child of this process that shares its memory until the program takes over. A copy by fork() would
/// have to be torn down again by the child, and cost it 15 ms of its time when a scene of a million balls is
/// loaded.
pid_t start(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t silent;
  posix_spawn_file_actions_init(&silent);
  posix_spawn_file_actions_addopen(&silent, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error = posix_spawn(&child, arguments.front(), &silent, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&silent);
  if (error != 0) throw MachineError("no process can be started");
  return child;
}

}  // namespace

Spent run_program(const std::vector<std::string>& words) {
  const pid_t child = start(words);
  int status = 0;
  rusage used{};
  if (wait4(child, &status, 0, &used) != child) throw MachineError("a process was lost");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw MachineError(words.front() + " failed");
  constexpr double kKibibyte = 1024.0;
  return {seconds(used.ru_utime) + seconds(used.ru_stime), kKibibyte * static_cast<double>(used.ru_maxrss)};
}

}  // namespace carom::benchmark
