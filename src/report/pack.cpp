#include "report/pack.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

#include "core/error.h"

namespace carom {

namespace {

/// The bytes of words, all lowest bytes first.
template <class Word>
std::string shuffled(std::span<const Word> words) {
  std::string bytes(words.size() * sizeof(Word), '\0');
  for (std::size_t byte = 0; byte < sizeof(Word); ++byte) {
    for (std::size_t i = 0; i < words.size(); ++i) {
      bytes[byte * words.size() + i] = static_cast<char>((words[i] >> (8U * byte)) & 0xFFU);
    }
  }
  return bytes;
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  const int status =
      compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), Z_DEFAULT_COMPRESSION);
  if (status != Z_OK) throw MachineError("zlib could not compress: no memory");
  packed.resize(size);
  return packed;
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto byte = i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U;
      group = group << 8U | byte;
    }
    const std::size_t digits = std::min<std::size_t>(bytes.size() - i, 3) + 1;
    for (std::size_t k = 0; k < 4; ++k) {
      text += k < digits ? kDigits[(group >> (18U - 6U * k)) & 63U] : '=';
    }
  }
  return text;
}

std::string pack_integers(std::span<const std::int32_t> integers) {
  std::vector<std::uint32_t> words;
  words.reserve(integers.size());
  for (const std::int32_t n : integers) {
    const auto bits = static_cast<std::uint32_t>(n);
    words.push_back((bits << 1U) ^ (n < 0 ? ~0U : 0U));
  }
  return base64(deflated(shuffled<std::uint32_t>(words)));
}

std::string pack_doubles(std::span<const double> numbers) {
  std::vector<std::uint64_t> words;
  words.reserve(numbers.size());
  for (const double number : numbers) words.push_back(std::bit_cast<std::uint64_t>(number));
  return base64(deflated(shuffled<std::uint64_t>(words)));
}

}  // namespace carom
