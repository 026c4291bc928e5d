#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace carom {

/// The next event of every ball, ordered: one entry a ball, whatever the number of events that it might have.
///
/// A calendar: the near future is cut into buckets of equal width, a few for each ball, and only the bucket
/// at hand is sorted (a binary heap). An entry costs O(1) where the calendar's width suits the density of
/// events, and O(log n) where everything falls into one bucket. The width changes only how fast this is:
/// entries leave in the order of their times, and at one time of their ranks.
/// Source: G. Paul, "A complexity O(1) priority queue for event driven molecular dynamics simulations",
/// J. Comput. Phys. 221, 615 (2007). Deviation: the width is measured anew whenever the calendar is used up.
class EventQueue {
 public:
  static constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

  /// Orders balls whose events are at one time, by something that does not depend on memory. Asked only then,
  /// which is seldom; it must speak of the event that the ball has at that moment.
  using Rank = std::function<std::uint64_t(std::uint32_t ball)>;

  EventQueue(std::size_t balls, Rank rank);

  /// Infinite where there is no event.
  void set(std::uint32_t ball, double time_s);

  /// The ball whose event is the first; kNobody where all times are infinite.
  std::uint32_t first();

  double time(std::uint32_t ball) const { return times_[ball]; }

 private:
  /// A ball stands in a bucket's list, or in the heap: then `previous` is its place there.
  struct Link {
    std::uint32_t next;
    std::uint32_t previous;
    std::uint32_t bucket;
  };

  std::uint32_t bucket_of(double time_s) const;
  void insert(std::uint32_t ball);
  void remove(std::uint32_t ball);

  /// Opens the calendar at the earliest event; false where there is none.
  bool reopen();
  bool choose_width();
  void pull_bucket();

  bool before(std::uint32_t a, std::uint32_t b) const {
    if (times_[a] == times_[b]) [[unlikely]]
      return rank_(a) < rank_(b);
    return times_[a] < times_[b];
  }
  void put(std::size_t place, std::uint32_t ball);
  void rise(std::size_t place);
  void sink(std::size_t place);

  std::vector<double> times_;  ///< s
  Rank rank_;
  /// Where a list ends: a link that is written like all, so that none is asked for it.
  std::uint32_t nobody_;
  std::vector<Link> links_;
  std::vector<std::uint32_t> heads_;  ///< of the buckets; the last one holds what is beyond the calendar
  std::vector<std::uint32_t> heap_;   ///< all balls of the current bucket, and before
  std::uint32_t buckets_;
  std::uint32_t current_;
  double begin_ = 0.0;          ///< s, of the calendar
  double end_ = 0.0;            ///< s, of the calendar
  double inverse_width_ = 0.0;  ///< 1/s, of a bucket
};

}  // namespace carom
