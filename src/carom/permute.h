#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "carom/threads.h"

namespace carom {

/// Puts what stands at `order[k]` in place k. @pre the order is a permutation of all places
template <class T, class Allocator>
void permute(std::vector<T, Allocator>& values, std::span<const std::uint32_t> order,
             const Threads& threads = Threads()) {
  std::vector<T, Allocator> permuted(values.size());
  threads.in_parallel(order.size(), [&](std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k) permuted[k] = values[order[k]];
  });
  values.swap(permuted);
}

}  // namespace carom
