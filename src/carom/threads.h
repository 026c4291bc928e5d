#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace carom {

/// The largest of value(i), first <= i < end, and 0; what is not a number counts for nothing. Each of the
/// lanes waits for itself alone.
template <class Value>
double largest_in(std::size_t first, std::size_t end, const Value& value) {
  constexpr std::size_t kLanes = 8;
  std::array<double, kLanes> largest{};
  std::size_t i = first;
  for (; i + kLanes <= end; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      largest[lane] = std::max(largest[lane], value(i + lane));
    }
  }
  for (; i < end; ++i) largest[0] = std::max(largest[0], value(i));
  return *std::max_element(largest.begin(), largest.end());
}

/// Threads that share what is to be done for many balls, where that for one does not depend on what is done
/// for the others. Each takes a stretch of them, and what they find is put together in the order of the
/// stretches: the result is the same to the bit however many there are.
class Threads {
 public:
  /// @param count  how many, the one that calls included; one starts nothing and does all in its place.
  explicit Threads(std::size_t count = 1);
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  ~Threads();

  std::size_t count() const { return count_; }

  /// Calls part(first, end) for stretches that make up [0, size), all at once, and waits for them.
  template <class Part>
  void in_parallel(std::size_t size, const Part& part) const {
    run([&](std::size_t thread) { part(begin_of(thread, size), begin_of(thread + 1, size)); });
  }

  /// The same with part(first, end, found), which appends to `found`.
  template <class Found, class Part>
  void collect(std::size_t size, Found& found, const Part& part) const {
    std::vector<const Found*> more(count_ - 1);
    run([&](std::size_t thread) {
      if (thread == 0) return part(std::size_t{0}, begin_of(1, size), found);
      // Each thread keeps its own: memory from the system comes page by page, and cleared.
      thread_local Found own;
      own.clear();
      part(begin_of(thread, size), begin_of(thread + 1, size), own);
      more[thread - 1] = &own;
    });
    for (const Found* each : more) found.insert(found.end(), each->begin(), each->end());
  }

  /// The same of what takes longer in some places than in others, dealt out in pieces. What is found is in an
  /// order that depends on the number of threads.
  template <class Found, class Part>
  void collect_dealt(std::size_t size, Found& found, const Part& part) const {
    constexpr std::size_t kPiece = 128;
    collect(count_, found, [&](std::size_t begin, std::size_t end, Found& own) {
      for (std::size_t hand = begin; hand < end; ++hand) {
        for (std::size_t first = hand * kPiece; first < size; first += count_ * kPiece) {
          part(first, std::min(first + kPiece, size), own);
        }
      }
    });
  }

  /// Sorts them. @pre of two that are equal it does not matter which comes first
  template <class Value>
  void sort(std::vector<Value>& values) const {
    in_parallel(values.size(), [&](std::size_t begin, std::size_t end) {
      std::sort(values.data() + begin, values.data() + end);
    });
    for (std::size_t thread = 1; thread < count_; ++thread) {
      const std::size_t sorted = begin_of(thread, values.size());
      const std::size_t end = begin_of(thread + 1, values.size());
      std::inplace_merge(values.data(), values.data() + sorted, values.data() + end);
    }
  }

  /// The largest of value(i), i < size, as largest_in().
  template <class Value>
  double largest(std::size_t size, const Value& value) const {
    std::vector<double> of_each(count_);
    run([&](std::size_t thread) {
      of_each[thread] = largest_in(begin_of(thread, size), begin_of(thread + 1, size), value);
    });
    return *std::max_element(of_each.begin(), of_each.end());
  }

 private:
  struct Crew;

  std::size_t begin_of(std::size_t thread, std::size_t size) const { return size * thread / count_; }

  /// Calls job(thread) on each thread; what one of them throws is thrown here.
  template <class Job>
  void run(const Job& job) const {
    if (count_ == 1) return job(std::size_t{0});
    run_on_all(job);
  }
  void run_on_all(const std::function<void(std::size_t)>& job) const;

  std::size_t count_;
  std::unique_ptr<Crew> crew_;  ///< none where the one that calls is alone
};

}  // namespace carom
