#include "trajectory/shared_memory.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"

namespace carom::test {
namespace {

constexpr std::size_t kCount = 100'000;  // of many pages, and not of whole ones

std::span<std::uint64_t> numbers(const std::shared_ptr<std::uint64_t[]>& memory) {
  return {memory.get(), kCount};
}

/// What a job in a process of its own leaves behind is seen after it has ended.
template <class Work>
void in_another_process(const Work& work) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    work();
    _exit(0);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
}

TEST(SharedMemory, BeginsAsZeros) {
  const std::shared_ptr<std::uint64_t[]> memory = SharedMemory(kCount * 8).mapped<std::uint64_t>();
  for (const std::uint64_t value : numbers(memory)) ASSERT_EQ(value, 0U);
}

TEST(SharedMemory, WhatAnotherProcessWrites_AndStores_IsSeen_InItsPlace_AndNothingElseChanges) {
  const SharedMemory memory(kCount * 8);
  const std::shared_ptr<std::uint64_t[]> mapped = memory.mapped<std::uint64_t>();
  const std::span<std::uint64_t> values = numbers(mapped);
  constexpr std::size_t kFirst = 777;  // not at the start of a page
  const std::vector<std::uint64_t> written(50'000, 42);
  in_another_process([&] {
    values[3] = 7;
    memory.write(kFirst * 8, std::as_bytes(std::span(written)));
    values[kFirst + 1] = 43;
  });
  for (std::size_t i = 0; i < kCount; ++i) {
    const bool is_written = i >= kFirst && i < kFirst + written.size();
    const std::uint64_t expected = i == 3 ? 7 : i == kFirst + 1 ? 43 : is_written ? 42 : 0;
    ASSERT_EQ(values[i], expected) << i;
  }
}

TEST(SharedMemory, WhatIsMapped_StaysAfterTheMemoryIsClosed) {
  std::optional<SharedMemory> memory(kCount * 8);
  const std::shared_ptr<std::uint64_t[]> mapped = memory->mapped<std::uint64_t>();
  const std::span<std::uint64_t> values = numbers(mapped);
  const std::vector<std::uint64_t> fives(kCount, 5);
  memory->write(0, std::as_bytes(std::span(fives)));
  memory.reset();
  in_another_process([&] { values[1] = 6; });
  EXPECT_EQ(values[0], 5U);
  EXPECT_EQ(values[1], 6U);
  EXPECT_EQ(values[kCount - 1], 5U);
}

TEST(SharedMemory, MoreThanThereIs_IsAnError_WithTheReason) {
  try {
    SharedMemory(std::numeric_limits<std::size_t>::max() / 4).mapped<std::uint64_t>();
    FAIL() << "memory without end";
  } catch (const MachineError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("no memory for 4398046511103 MiB of trajectory: ", 0), 0U)
        << error.what();
  }
}

}  // namespace
}  // namespace carom::test
