#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "app/commands.h"
#include "app/options.h"
#include "core/error.h"
#include "core/heap.h"

namespace carom {

namespace {

int run(int argc, char** argv) {
  const Parsed parsed = parse_options(argc, argv);
  if (parsed.exit_code) return *parsed.exit_code;
  const Options& options = parsed.options;
  if (options.command == "list") return static_cast<int>(list_command(options));
  if (options.command == "explain") return static_cast<int>(explain_command(options));
  if (options.command == "lab") return static_cast<int>(lab_command(options));
  if (options.command == "study") return static_cast<int>(study_command(options));
  if (options.command == "law") return static_cast<int>(law_command(options));
  return static_cast<int>(compare_command(options));
}

/// What was printed may still wait in a buffer, and a full disk shows only when it leaves.
void flush_output() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw MachineError(fmt::format("the output cannot be written: {}", std::strerror(errno)));
}

int run_and_flush(int argc, char** argv) {
  try {
    const int exit_code = run(argc, argv);
    flush_output();
    return exit_code;
  } catch (const InputError& error) {
    fmt::print(stderr, "carom: {}\n", error.what());
    return static_cast<int>(ExitCode::bad_input);
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "carom: out of memory\n");
  } catch (const std::exception& error) {
    fmt::print(stderr, "carom: {}\n", error.what());
  }
  return static_cast<int>(ExitCode::machine_failed);
}

}  // namespace

}  // namespace carom

int main(int argc, char** argv) {
  carom::give_large_blocks_back();
  return carom::run_and_flush(argc, argv);
}
