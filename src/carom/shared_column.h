#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "carom/permute.h"
#include "carom/threads.h"
#include "core/large_pages.h"

namespace carom {

/// One number of each ball, which is held once where it is the same of all.
///
/// The trick: a place is looked up through a mask, zero or all ones, so that no branch asks which it is.
class SharedColumn {
 public:
  /// @param of  the number of a ball, by its place
  template <class Of>
  SharedColumn(std::size_t count, const Of& of) : count_(count) {
    if (count > 0) values_.push_back(of(0));
    for (std::size_t i = 1; i < count; ++i) set(i, of(i));
  }

  std::size_t size() const { return count_; }
  double operator[](std::size_t ball) const { return values_[ball & mask_]; }

  void set(std::size_t ball, double value) {
    if ((*this)[ball] == value) return;
    values_.resize(count_, values_.front());
    mask_ = kEach;
    values_[ball] = value;
  }

  /// Place k takes what stood at order[k].
  void permute(std::span<const std::uint32_t> order, const Threads& threads) {
    if (mask_ == kEach) carom::permute(values_, order, threads);
  }

  /// The numbers of all balls, place by place.
  Column<double> each() const {
    Column<double> each = values_;
    if (count_ > 0) each.resize(count_, values_.front());
    return each;
  }

 private:
  static constexpr std::size_t kEach = static_cast<std::size_t>(-1);

  std::size_t count_;
  std::size_t mask_ = 0;
  Column<double> values_;
};

}  // namespace carom
