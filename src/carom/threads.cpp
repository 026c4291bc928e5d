#include "carom/threads.h"

#include <barrier>
#include <exception>
#include <system_error>
#include <thread>

namespace carom {

/// The threads beside the one that calls. They wait for jobs between two barriers.
struct Threads::Crew {
  using Job = std::function<void(std::size_t)>;

  explicit Crew(std::size_t size)
      : count(size),
        begins(static_cast<std::ptrdiff_t>(size)),
        ends(static_cast<std::ptrdiff_t>(size)),
        thrown(size) {
    threads.reserve(size - 1);
    try {
      for (std::size_t k = 1; k < size; ++k) threads.emplace_back([this, k] { serve(k); });
    } catch (const std::system_error&) {
      dismiss();
      throw;
    }
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  ~Crew() { dismiss(); }

  void run(const Job& next) {
    job = &next;
    begins.arrive_and_wait();
    attempt(0);
    ends.arrive_and_wait();
    for (std::exception_ptr& each : thrown) {
      if (each) std::rethrow_exception(std::exchange(each, nullptr));
    }
  }

 private:
  void serve(std::size_t k) {
    for (;;) {
      begins.arrive_and_wait();
      if (job == nullptr) return;
      attempt(k);
      ends.arrive_and_wait();
    }
  }

  void attempt(std::size_t k) {
    try {
      (*job)(k);
    } catch (...) {
      thrown[k] = std::current_exception();
    }
  }

  /// Without a job they go home. Arrives for the one that calls, and for those that never came.
  void dismiss() {
    job = nullptr;
    static_cast<void>(begins.arrive(static_cast<std::ptrdiff_t>(count - threads.size())));
    threads.clear();
  }

  std::size_t count;
  std::barrier<> begins;
  std::barrier<> ends;
  const Job* job = nullptr;
  std::vector<std::exception_ptr> thrown;
  std::vector<std::jthread> threads;
};

Threads::Threads(std::size_t count)
    : count_(count), crew_(count > 1 ? std::make_unique<Crew>(count) : nullptr) {}

Threads::~Threads() = default;

void Threads::run_on_all(const std::function<void(std::size_t)>& job) const {
  crew_->run(job);
}

}  // namespace carom
