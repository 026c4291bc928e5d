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
      : count_(size),
        begins_(static_cast<std::ptrdiff_t>(size)),
        ends_(static_cast<std::ptrdiff_t>(size)),
        thrown_(size) {
    threads_.reserve(size - 1);
    try {
      for (std::size_t k = 1; k < size; ++k) threads_.emplace_back([this, k] { serve(k); });
    } catch (const std::system_error&) {
      dismiss();
      throw;
    }
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  ~Crew() { dismiss(); }

  void run(const Job& next) {
    job_ = &next;
    begins_.arrive_and_wait();
    attempt(0);
    ends_.arrive_and_wait();
    for (std::exception_ptr& each : thrown_) {
      if (each) std::rethrow_exception(std::exchange(each, nullptr));
    }
  }

 private:
  void serve(std::size_t k) {
    for (;;) {
      begins_.arrive_and_wait();
      if (job_ == nullptr) return;
      attempt(k);
      ends_.arrive_and_wait();
    }
  }

  void attempt(std::size_t k) {
    try {
      (*job_)(k);
    } catch (...) {
      thrown_[k] = std::current_exception();
    }
  }

  /// Without a job they go home. Arrives for the one that calls, and for those that never came.
  void dismiss() {
    job_ = nullptr;
    static_cast<void>(begins_.arrive(static_cast<std::ptrdiff_t>(count_ - threads_.size())));
    threads_.clear();
  }

  std::size_t count_;
  std::barrier<> begins_;
  std::barrier<> ends_;
  const Job* job_ = nullptr;
  std::vector<std::exception_ptr> thrown_;
  std::vector<std::jthread> threads_;
};

Threads::Threads(std::size_t count)
    : count_(count), crew_(count > 1 ? std::make_unique<Crew>(count) : nullptr) {}

Threads::~Threads() = default;

void Threads::run_on_all(const std::function<void(std::size_t)>& job) const {
  crew_->run(job);
}

}  // namespace carom
