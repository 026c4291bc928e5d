#include "carom/evolvers/event_queue.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace carom {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kInHeap = std::numeric_limits<std::uint32_t>::max();

/// At the least: with fewer a bucket holds several balls, which have to be sorted; more only take room.
constexpr std::size_t kBucketsEach = 2;

/// Of the calendar's length to the median wait: half of the balls have their event in its first quarter, and
/// refilling it costs each ball one visit in about four events.
constexpr double kMedianWaits = 4.0;

/// Balls that are asked for the median wait; more would not change the width by much.
constexpr std::size_t kSample = 1024;

}  // namespace

EventQueue::EventQueue(std::size_t balls, Rank rank)
    : times_(balls, kInfinite),
      rank_(std::move(rank)),
      nobody_(static_cast<std::uint32_t>(balls)),
      links_(balls + 1),
      buckets_(static_cast<std::uint32_t>(std::bit_ceil(std::max<std::size_t>(kBucketsEach * balls, 2)))),
      current_(buckets_ - 1) {
  heads_.assign(std::size_t{buckets_} + 1, nobody_);
  end_ = -kInfinite;
  for (std::uint32_t ball = 0; ball < balls; ++ball) insert(ball);
}

void EventQueue::set(std::uint32_t ball, double time_s) {
  remove(ball);
  times_[ball] = time_s;
  insert(ball);
}

std::uint32_t EventQueue::first() {
  while (heap_.empty()) {
    if (current_ + 1 < buckets_) {
      ++current_;
    } else if (!reopen()) {
      return kNobody;
    }
    pull_bucket();
  }
  return heap_.front();
}

// --- the calendar

std::uint32_t EventQueue::bucket_of(double time_s) const {
  if (!(time_s < end_)) return buckets_;
  const double number = std::max(0.0, (time_s - begin_) * inverse_width_);
  return std::min(static_cast<std::uint32_t>(number), buckets_ - 1);
}

void EventQueue::insert(std::uint32_t ball) {
  const std::uint32_t bucket = bucket_of(times_[ball]);
  if (bucket <= current_) {
    links_[ball].bucket = kInHeap;
    heap_.push_back(ball);
    put(heap_.size() - 1, ball);
    rise(heap_.size() - 1);
    return;
  }
  const std::uint32_t head = heads_[bucket];
  links_[ball] = {head, nobody_, bucket};
  links_[head].previous = ball;
  heads_[bucket] = ball;
}

void EventQueue::remove(std::uint32_t ball) {
  const Link link = links_[ball];
  if (link.bucket == kInHeap) {
    const std::uint32_t last = heap_.back();
    heap_.pop_back();
    if (last == ball) return;
    put(link.previous, last);
    rise(link.previous);
    sink(links_[last].previous);
    return;
  }
  (link.previous == nobody_ ? heads_[link.bucket] : links_[link.previous].next) = link.next;
  links_[link.next].previous = link.previous;
}

bool EventQueue::reopen() {
  const bool any = choose_width();
  heap_.clear();
  std::fill(heads_.begin(), heads_.end(), nobody_);
  // Until its bucket is pulled, no ball is in the heap: the first bucket counts as one to come.
  current_ = kInHeap;
  for (std::uint32_t ball = 0; ball < times_.size(); ++ball) {
    const std::uint32_t bucket = bucket_of(times_[ball]);
    links_[ball] = {heads_[bucket], nobody_, bucket};
    links_[heads_[bucket]].previous = ball;
    heads_[bucket] = ball;
  }
  current_ = any ? 0 : buckets_ - 1;
  return any;
}

bool EventQueue::choose_width() {
  begin_ = kInfinite;
  for (const double time : times_) begin_ = std::min(begin_, time);
  end_ = -kInfinite;
  if (begin_ == kInfinite) return false;
  std::vector<double> waits;
  const std::size_t stride = 1 + times_.size() / kSample;
  for (std::size_t ball = 0; ball < times_.size(); ball += stride) {
    if (times_[ball] < kInfinite) waits.push_back(times_[ball] - begin_);
  }
  double median = 0.0;
  if (!waits.empty()) {
    const auto middle = waits.begin() + static_cast<std::ptrdiff_t>(waits.size() / 2);
    std::nth_element(waits.begin(), middle, waits.end());
    median = *middle;
  }
  const double length = kMedianWaits * median;
  const double inverse = static_cast<double>(buckets_) / length;
  // Where no width can be told apart from zero, all are sorted together.
  const bool one_bucket =
      !std::isfinite(inverse) || begin_ + length / static_cast<double>(buckets_) == begin_;
  end_ = one_bucket ? kInfinite : begin_ + length;
  inverse_width_ = one_bucket ? 0.0 : inverse;
  return true;
}

void EventQueue::pull_bucket() {
  std::uint32_t ball = heads_[current_];
  heads_[current_] = nobody_;
  while (ball != nobody_) {
    const std::uint32_t next = links_[ball].next;
    insert(ball);
    ball = next;
  }
}

// --- the heap

void EventQueue::put(std::size_t place, std::uint32_t ball) {
  heap_[place] = ball;
  links_[ball].previous = static_cast<std::uint32_t>(place);
}

void EventQueue::rise(std::size_t place) {
  const std::uint32_t ball = heap_[place];
  while (place > 0 && before(ball, heap_[(place - 1) / 2])) {
    put(place, heap_[(place - 1) / 2]);
    place = (place - 1) / 2;
  }
  put(place, ball);
}

void EventQueue::sink(std::size_t place) {
  const std::uint32_t ball = heap_[place];
  for (std::size_t child = 2 * place + 1; child < heap_.size(); child = 2 * place + 1) {
    if (child + 1 < heap_.size() && before(heap_[child + 1], heap_[child])) ++child;
    if (!before(heap_[child], ball)) break;
    put(place, heap_[child]);
    place = child;
  }
  put(place, ball);
}

}  // namespace carom
