#pragma once

namespace carom {

/// Has the processor load what stands there, while the program goes on. Nothing happens where nothing stands.
inline void prefetch(const void* place) {
  __builtin_prefetch(place);
  // GCC 12 takes a function that does no more than this for one without effect, and drops calls of it.
  asm volatile("");
}

}  // namespace carom
