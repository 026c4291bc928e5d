#pragma once

#include <malloc.h>

namespace carom {

/// For a program to call when it starts: has each large block of memory taken from the system alone, and
/// given back as soon as it is free. Left to itself the C library takes such blocks from its heap, once a
/// larger one has been freed, and between columns of a million balls that come and go it keeps holes: 15
/// bytes a ball.
inline void give_large_blocks_back() {
  constexpr int kLarge = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, kLarge);
}

}  // namespace carom
