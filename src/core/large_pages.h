#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace carom {

/// Takes memory as std::allocator does, and asks the system to back what is large with large pages. Where it
/// has none to give nothing is lost.
///
/// The trick: in columns of 10⁶ balls, what is looked at together lies in more pages of 4 KiB than the
/// processor remembers the places of; of pages of 2 MiB it remembers all.
template <class T>
struct LargePages {
  using value_type = T;

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>& /*other*/) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    void* block = nullptr;
    if constexpr (kOverAligned) {
      block = ::operator new (bytes, std::align_val_t{alignof(T)});
    } else {
      block = ::operator new(bytes);
    }
    if (bytes >= kLarge) ask_for_large_pages(block, bytes);
    return static_cast<T*>(block);
  }

  void deallocate(T* block, std::size_t /*count*/) {
    if constexpr (kOverAligned) {
      ::operator delete (block, std::align_val_t{alignof(T)});
    } else {
      ::operator delete(block);
    }
  }

  friend bool operator==(const LargePages& /*a*/, const LargePages& /*b*/) { return true; }

 private:
  static constexpr bool kOverAligned = alignof(T) > __STDCPP_DEFAULT_NEW_ALIGNMENT__;
  /// Smaller columns lie in few pages of any size. From here on neighbouring columns share large pages.
  static constexpr std::size_t kLarge = std::size_t{256} * 1024;

  /// Only advice: that it is not taken is no error.
  static void ask_for_large_pages(void* block, std::size_t bytes) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t before = reinterpret_cast<std::uintptr_t>(block) % page;
    madvise(static_cast<std::byte*>(block) - before, before + bytes, MADV_HUGEPAGE);
  }
};

/// One value of each ball, or of each of whatever there are about as many of.
template <class T>
using Column = std::vector<T, LargePages<T>>;

}  // namespace carom
