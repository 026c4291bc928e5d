#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "trajectory/descriptor.h"

namespace carom {

/// Memory that stays shared across fork(): a file without a name that lies in memory, and is mapped. Its
/// pages are taken when they are first written.
///
/// The trick: what is written as to a file, and not stored into the mapping, takes half the time, as a page
/// that is written whole need be neither cleared nor mapped before. Both see the same bytes at once.
class SharedMemory {
 public:
  /// Of zeros. @throws MachineError where there is none to have.
  explicit SharedMemory(std::size_t bytes);

  /// All of it, as an array; it stays after this object is gone. @throws MachineError
  /// @pre all bytes zero are a T
  template <class T>
  std::shared_ptr<T[]> mapped() const {
    const std::shared_ptr<void> memory = mapping();
    return {memory, static_cast<T*>(memory.get())};
  }

  /// Puts bytes at a place. @throws MachineError
  void write(std::size_t place, std::span<const std::byte> bytes) const;

 private:
  std::shared_ptr<void> mapping() const;

  std::size_t bytes_;
  Descriptor file_;
};

}  // namespace carom
