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

void write_file(const std::filesystem::path& file, std::string_view bytes) {
  const std::filesystem::path temporary = fmt::format("{}.{}.tmp", file.string(), getpid());
  try {
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
    {
      std::ofstream out(temporary, std::ios::binary);
      out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      out.close();
      if (!out) throw std::filesystem::filesystem_error("write", temporary, {errno, std::generic_category()});
    }
    std::filesystem::rename(temporary, file);
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
