#include "trajectory/shared_memory.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace carom {

namespace {

[[noreturn]] void fail(std::size_t bytes) {
  throw MachineError(
      fmt::format("no memory for {} MiB of trajectory: {}", bytes >> 20U, std::strerror(errno)));
}

}  // namespace

SharedMemory::SharedMemory(std::size_t bytes)
    : bytes_(bytes), file_(memfd_create("trajectory", MFD_CLOEXEC)) {
  if (!file_.is_open() || ftruncate(file_.number(), static_cast<off_t>(bytes_)) != 0) fail(bytes_);
}

std::shared_ptr<void> SharedMemory::mapping() const {
  void* memory = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_NORESERVE, file_.number(), 0);
  if (memory == MAP_FAILED) fail(bytes_);
  return {memory, [bytes = bytes_](void* start) { munmap(start, bytes); }};
}

void SharedMemory::write(std::size_t place, std::span<const std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(file_.number(), bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(bytes_);
    place += static_cast<std::size_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

}  // namespace carom
