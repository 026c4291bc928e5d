#pragma once

#include <cstdint>
#include <vector>

namespace carom {

/// Puts what stands at `order[k]` in place k. @pre the order is a permutation of all places
template <class T, class Allocator>
void permute(std::vector<T, Allocator>& values, const std::vector<std::uint32_t>& order) {
  std::vector<T, Allocator> permuted;
  permuted.reserve(values.size());
  for (const std::uint32_t place : order) permuted.push_back(values[place]);
  values.swap(permuted);
}

}  // namespace carom
