#pragma once

#include <cstdint>

namespace carom::benchmark {

/// The bytes that operator new has given out and that have not come back, as they were asked for.
std::int64_t live_bytes();

}  // namespace carom::benchmark
