#include "core/files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include "core/error.h"

namespace carom {

std::string read_file(const std::filesystem::path& file) {
  std::error_code unreadable;
  // A folder opens like a file and then cannot be read.
  if (std::filesystem::is_directory(file, unreadable)) {
    throw InputError(fmt::format("{}: cannot be read: it is a folder", file.string()));
  }
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
  return {std::istreambuf_iterator<char>(in), {}};
}

namespace {

void write_bytes(const std::filesystem::path& file, std::string_view bytes) {
  errno = 0;
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw std::filesystem::filesystem_error("write", file, {errno, std::generic_category()});
}

}  // namespace

void write_file(const std::filesystem::path& file, std::string_view bytes) {
  std::filesystem::path temporary;
  try {
    // A link is followed; a device or a pipe is written to and must not be replaced by a file.
    const bool exists = std::filesystem::exists(file);
    const std::filesystem::path target = exists ? std::filesystem::canonical(file) : file;
    if (exists && !std::filesystem::is_regular_file(target)) return write_bytes(target, bytes);
    if (target.has_parent_path()) std::filesystem::create_directories(target.parent_path());
    temporary = fmt::format("{}.{}.tmp", target.string(), getpid());
    write_bytes(temporary, bytes);
    std::filesystem::rename(temporary, target);
  } catch (const std::filesystem::filesystem_error& error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw MachineError(fmt::format("{}: cannot be written: {}", file.string(), error.code().message()));
  }
}

std::filesystem::path program_prefix() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path();
}

}  // namespace carom
