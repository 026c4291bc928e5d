#pragma once

#include <cstdint>

namespace carom {

/// A broad phase tells its Count what it does. This one does not listen, and leaves no instruction behind.
struct NoCount {
  static void pair_test() {}
  static void build_operations(std::size_t /*number*/) {}
  static void cell_visits(std::size_t /*number*/) {}
};

/// Counts in place of a clock: the same numbers on every machine. A broad phase counts while it only looks,
/// hence the mutable.
class CountTests {
 public:
  void pair_test() const { ++pair_tests_; }
  void build_operations(std::size_t number) const { build_operations_ += static_cast<std::int64_t>(number); }
  void cell_visits(std::size_t number) const { cell_visits_ += static_cast<std::int64_t>(number); }

  /// Distances between two balls that were looked at.
  std::int64_t pair_tests() const { return pair_tests_; }
  /// Balls put into a place, or compared while sorting.
  std::int64_t build_operations() const { return build_operations_; }
  /// Cells, or nodes of a tree, that were looked at for balls.
  std::int64_t cell_visits() const { return cell_visits_; }

  std::int64_t total() const { return pair_tests_ + build_operations_ + cell_visits_; }

 private:
  mutable std::int64_t pair_tests_ = 0;
  mutable std::int64_t build_operations_ = 0;
  mutable std::int64_t cell_visits_ = 0;
};

}  // namespace carom
