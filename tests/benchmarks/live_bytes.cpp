#include "tests/benchmarks/live_bytes.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::int64_t> live = 0;

/// Before each block stands its size; as wide as the strictest alignment, so that the block keeps its own.
constexpr std::size_t kHeader = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

}  // namespace

void* operator new(std::size_t size) {
  auto* const header = static_cast<std::size_t*>(std::malloc(size + kHeader));
  if (header == nullptr) throw std::bad_alloc();
  *header = size;
  live += static_cast<std::int64_t>(size);
  return reinterpret_cast<std::byte*>(header) + kHeader;
}

void operator delete(void* block) noexcept {
  if (block == nullptr) return;
  auto* const header = reinterpret_cast<std::size_t*>(static_cast<std::byte*>(block) - kHeader);
  live -= static_cast<std::int64_t>(*header);
  std::free(header);
}

void operator delete(void* block, std::size_t /*size*/) noexcept {
  operator delete(block);
}

namespace carom::benchmark {

std::int64_t live_bytes() {
  return live;
}

}  // namespace carom::benchmark
