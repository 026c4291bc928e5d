#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace carom {

/// The bytes of a file. @throws InputError where it cannot be read.
std::string read_file(const std::filesystem::path& file);

/// Writes a whole file or nothing: into a temporary file beside it, which is then renamed. Creates the
/// folders above it. @throws MachineError where the machine refuses, with its reason.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// <prefix> of the running program <prefix>/bin/carom, from the kernel and not from argv.
std::filesystem::path program_prefix();

}  // namespace carom
