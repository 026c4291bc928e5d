#pragma once

#include <cstdint>

namespace carom::benchmark {

/// The bytes that operator new has given out and that have not come back, as they were asked for. Blocks
/// that are aligned more strictly than all others (std::align_val_t) are not counted.
std::int64_t live_bytes();

}  // namespace carom::benchmark
