#include "trajectory/isolate.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include "core/error.h"
#include "trajectory/descriptor.h"

namespace carom {

namespace {

using Clock = std::chrono::steady_clock;

// How a child says that its payload is whole, and that it ended by an exception. Any other end is a crash.
constexpr int kExitFinished = 0;
constexpr int kExitThrew = 70;
constexpr char kWhole = '\x06';  // last byte of a whole payload

struct Pipe {
  Descriptor read;
  Descriptor write;

  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
      throw MachineError(fmt::format("no pipe: {}", std::strerror(errno)));
    }
    read = Descriptor(ends[0]);
    write = Descriptor(ends[1]);
  }
};

void write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(kExitThrew);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void limit_memory(double memory_mib) {
#if defined(__SANITIZE_ADDRESS__)
  (void)memory_mib;  // the sanitizer reserves terabytes of address space for itself
#else
  std::ifstream statm("/proc/self/statm");
  double pages = 0.0;
  statm >> pages;
  const double bytes = pages * static_cast<double>(sysconf(_SC_PAGESIZE)) + memory_mib * 1024.0 * 1024.0;
  const rlimit limit{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
  setrlimit(RLIMIT_AS, &limit);
#endif
}

[[noreturn]] void be_the_child(const Job& job, const ProcessLimits& limits, Pipe& payload, Pipe& errors) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setpgid(0, 0);  // a hang is killed with all that it started
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(nothing, STDIN_FILENO);
  dup2(nothing, STDOUT_FILENO);
  dup2(errors.write.number(), STDERR_FILENO);
  // A signal shall end this process as itself, whatever handlers the parent has.
  for (const int fatal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(fatal, SIG_DFL);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  limit_memory(limits.memory_mib);
  try {
    write_all(payload.write.number(), job() + kWhole);
    _exit(kExitFinished);
  } catch (const std::bad_alloc&) {
    write_all(STDERR_FILENO, fmt::format("out of memory (--memory {:g} MiB)", limits.memory_mib));
  } catch (const std::exception& error) {
    write_all(STDERR_FILENO, error.what());
  } catch (...) {
    write_all(STDERR_FILENO, "an unknown exception");
  }
  _exit(kExitThrew);
}

/// A job under way, as the parent sees it.
class Child {
 public:
  Child(std::size_t job, const Job& body, const ProcessLimits& limits)
      : job_(job),
        deadline_(Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                     std::chrono::duration<double>(limits.wall_seconds))),
        wall_seconds_(limits.wall_seconds) {
    pid_ = fork();
    if (pid_ < 0) throw MachineError(fmt::format("no process can be started: {}", std::strerror(errno)));
    if (pid_ == 0) be_the_child(body, limits, payload_, errors_);
    setpgid(pid_, pid_);
    payload_.write.close();
    errors_.write.close();
    // Not pidfd_open(): glibc 2.36 declares it as a function of C++, which no library has.
    ended_ = Descriptor(static_cast<int>(syscall(SYS_pidfd_open, pid_, 0)));
    if (ended_.is_open()) return;
    const std::string reason = std::strerror(errno);
    stop();
    throw MachineError("no process can be watched: " + reason);
  }

  std::size_t job() const { return job_; }
  Clock::time_point deadline() const { return deadline_; }
  std::array<pollfd, 3> polls() const {
    return {{{payload_.read.number(), POLLIN, 0},
             {errors_.read.number(), POLLIN, 0},
             {ended_.number(), POLLIN, 0}}};
  }

  /// Takes in what there is to read. True once the process is done or out of time, and outcome() is set.
  bool progressed() {
    drain(payload_.read, payload_bytes_, kAll);
    drain(errors_.read, error_bytes_, kTail);
    if (Clock::now() >= deadline_) {
      stop();
      outcome_ = {ProcessEnd::timed_out, fmt::format("stopped after {:g} s", wall_seconds_), {}};
      return true;
    }
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
    drain(payload_.read, payload_bytes_, kAll);
    drain(errors_.read, error_bytes_, kTail);
    kill(-pid_, SIGKILL);  // whatever it left behind
    judge(status);
    return true;
  }

  ProcessOutcome outcome() const { return outcome_; }

 private:
  static constexpr std::size_t kAll = static_cast<std::size_t>(-1);
  static constexpr std::size_t kTail = 4096;

  void stop() const {
    kill(-pid_, SIGKILL);
    int ignored = 0;
    waitpid(pid_, &ignored, 0);
  }

  static void drain(Descriptor& file, std::string& into, std::size_t keep) {
    static std::array<char, 65536> buffer;  // what is in it is overwritten: not cleared again and again
    pollfd ready{file.number(), POLLIN, 0};
    while (file.is_open() && poll(&ready, 1, 0) > 0) {
      const ssize_t count = read(file.number(), buffer.data(), buffer.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) {
        file.close();
        return;
      }
      into.append(buffer.data(), static_cast<std::size_t>(count));
      if (into.size() > keep) into.erase(0, into.size() - keep);
    }
  }

  void judge(int status) {
    const bool whole = !payload_bytes_.empty() && payload_bytes_.back() == kWhole;
    if (WIFEXITED(status) && WEXITSTATUS(status) == kExitFinished && whole) {
      payload_bytes_.pop_back();
      outcome_ = {ProcessEnd::finished, {}, std::move(payload_bytes_)};
      return;
    }
    std::string how;
    if (WIFSIGNALED(status)) {
      how = fmt::format("killed by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    } else if (WEXITSTATUS(status) != kExitThrew) {
      how = fmt::format("ended with exit code {} and without a result", WEXITSTATUS(status));
    }
    const std::string said = last_line(error_bytes_);
    outcome_ = {ProcessEnd::crashed, how.empty() || said.empty() ? how + said : how + ": " + said, {}};
  }

  static std::string last_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    return text.substr(text.rfind('\n') + 1);
  }

  std::size_t job_;
  Clock::time_point deadline_;
  double wall_seconds_;
  Pipe payload_;
  Pipe errors_;
  pid_t pid_ = -1;
  Descriptor ended_;  ///< readable once the process has ended
  std::string payload_bytes_;
  std::string error_bytes_;
  ProcessOutcome outcome_;
};

/// Sleeps until a child has something to say or a deadline is reached.
void wait_for_any(const std::vector<std::unique_ptr<Child>>& children) {
  std::vector<pollfd> polls;
  double wait_ms = std::numeric_limits<int>::max();
  for (const auto& child : children) {
    for (const pollfd& each : child->polls()) polls.push_back(each);
    const std::chrono::duration<double, std::milli> left = child->deadline() - Clock::now();
    wait_ms = std::clamp(left.count(), 0.0, wait_ms);
  }
  poll(polls.data(), polls.size(), static_cast<int>(std::ceil(wait_ms)));
}

}  // namespace

std::vector<ProcessOutcome> run_isolated(const std::vector<Job>& jobs, const ProcessLimits& limits,
                                         int parallel, const std::function<void(std::size_t)>& done) {
  std::vector<ProcessOutcome> outcomes(jobs.size());
  std::vector<std::unique_ptr<Child>> children;
  std::size_t next = 0;
  while (next < jobs.size() || !children.empty()) {
    while (next < jobs.size() && children.size() < static_cast<std::size_t>(std::max(parallel, 1))) {
      children.push_back(std::make_unique<Child>(next, jobs[next], limits));
      ++next;
    }
    wait_for_any(children);
    std::erase_if(children, [&](const std::unique_ptr<Child>& child) {
      if (!child->progressed()) return false;
      outcomes[child->job()] = child->outcome();
      if (done) done(child->job());
      return true;
    });
  }
  return outcomes;
}

}  // namespace carom
