#include "carom/threads.h"

#include <atomic>
#include <exception>
#include <system_error>
#include <thread>

namespace carom {

namespace {

/// Waits until the value is another. It comes within a fraction of a millisecond as a rule, and to be put to
/// sleep and woken takes a tenth of one: so the core is offered to others some times first, each of which is
/// less than a microsecond where nobody wants it.
std::size_t await_change(const std::atomic<std::size_t>& value, std::size_t old, int offers) {
  for (int offer = 0; offer < offers; ++offer) {
    if (const std::size_t now = value.load(); now != old) return now;
    std::this_thread::yield();
  }
  value.wait(old);
  return value.load();
}

/// With more threads than cores there is always one that has to sleep.
int offers_before_sleep(std::size_t threads) {
  constexpr int kOffers = 1000;
  return threads <= std::thread::hardware_concurrency() ? kOffers : 0;
}

}  // namespace

/// The threads beside the one that calls. They wait for jobs.
struct Threads::Crew {
  using Job = std::function<void(std::size_t)>;

  explicit Crew(std::size_t size) : offers_(offers_before_sleep(size)), thrown_(size) {
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
    at_work_ = threads_.size();
    call();
    attempt(0);
    for (std::size_t left = at_work_; left > 0;) left = await_change(at_work_, left, offers_);
    for (std::exception_ptr& each : thrown_) {
      if (each) std::rethrow_exception(std::exchange(each, nullptr));
    }
  }

 private:
  void serve(std::size_t k) {
    for (std::size_t call = 0;;) {
      call = await_change(calls_, call, offers_);
      if (job_ == nullptr) return;
      attempt(k);
      if (--at_work_ == 0) at_work_.notify_one();
    }
  }

  void call() {
    ++calls_;
    calls_.notify_all();
  }

  void attempt(std::size_t k) {
    try {
      (*job_)(k);
    } catch (...) {
      thrown_[k] = std::current_exception();
    }
  }

  /// Without a job they go home.
  void dismiss() {
    job_ = nullptr;
    call();
    threads_.clear();
  }

  int offers_;
  const Job* job_ = nullptr;
  std::atomic<std::size_t> calls_ = 0;    ///< to take the job
  std::atomic<std::size_t> at_work_ = 0;  ///< who have not done it yet
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
