#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace carom {

// Numbers as text that JSON can hold, small: bytes shuffled (all lowest bytes first, then all second ones,
// …), so that those which hardly ever change stand together; then deflated (RFC 1950), then base64 (RFC
// 4648). A browser unpacks it with atob() and DecompressionStream("deflate").

/// Signed integers, each as 2|n| or 2|n| - 1 for a negative one, so that small ones have three empty bytes.
std::string pack_integers(std::span<const std::int32_t> integers);

/// Doubles, to the bit, their bytes from the lowest on.
std::string pack_doubles(std::span<const double> numbers);

/// Bytes as base64 with padding.
std::string base64(std::string_view bytes);

}  // namespace carom
