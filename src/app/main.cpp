#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>

#include "app/commands.h"
#include "app/options.h"
#include "core/error.h"

namespace carom {

namespace {

ExitCode run_command(const Options& options) {
  try {
    return options.command == "list" ? list_command(options) : compare_command(options);
  } catch (const InputError& error) {
    fmt::print(stderr, "carom: {}\n", error.what());
    return ExitCode::bad_input;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "carom: out of memory\n");
  } catch (const std::exception& error) {
    fmt::print(stderr, "carom: {}\n", error.what());
  }
  return ExitCode::machine_failed;
}

}  // namespace

}  // namespace carom

int main(int argc, char** argv) {
  const carom::Parsed parsed = carom::parse_options(argc, argv);
  if (parsed.exit_code) return *parsed.exit_code;
  return static_cast<int>(carom::run_command(parsed.options));
}
