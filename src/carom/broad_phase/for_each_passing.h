#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace carom {

/// Calls at(k) for every k from begin on, but without end, that passes the test. No branch hangs on what the
/// test says: of many that fail few pass, and which ones no processor can foresee.
template <class Test, class At>
void for_each_passing(std::size_t begin, std::size_t end, const Test& test, const At& at) {
  constexpr std::size_t kBlock = 256;
  std::array<std::size_t, kBlock> passing;
  for (std::size_t first = begin; first < end; first += kBlock) {
    const std::size_t block_end = std::min(first + kBlock, end);
    std::size_t found = 0;
    for (std::size_t k = first; k < block_end; ++k) {
      passing[found] = k;
      found += test(k) ? 1U : 0U;
    }
    for (std::size_t n = 0; n < found; ++n) at(passing[n]);
  }
}

}  // namespace carom
