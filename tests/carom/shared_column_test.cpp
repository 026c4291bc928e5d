#include "carom/shared_column.h"

#include <gtest/gtest.h>

#include <vector>

namespace carom {
namespace {

/// Beside a plain array: numbers are set and put in another order, the first different one early or late.
TEST(SharedColumn, HoldsWhatAnArrayHolds_AlikeAndNot) {
  const std::vector<std::uint32_t> order = {3, 0, 2, 1};
  for (const std::size_t different : {0U, 2U, 3U, 4U}) {
    std::vector<double> array(4, 0.5);
    if (different < array.size()) array[different] = 0.25;
    SharedColumn column(array.size(), [&](std::size_t i) { return array[i]; });
    column.permute(order, Threads());
    column.set(1, 0.5);
    const std::vector<double> expected = {array[order[0]], 0.5, array[order[2]], array[order[3]]};
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(column[i], expected[i]) << different;
    const Column<double> each = column.each();
    EXPECT_EQ(std::vector<double>(each.begin(), each.end()), expected) << different;
  }
}

TEST(SharedColumn, OfNoBalls_IsEmpty) {
  const SharedColumn column(0, [](std::size_t) { return 1.0; });
  EXPECT_EQ(column.size(), 0U);
  EXPECT_TRUE(column.each().empty());
}

}  // namespace
}  // namespace carom
