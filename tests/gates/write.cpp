#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "core/files.h"
#include "tests/gates/catches.h"

// carom-gate-catches FILE: runs every broken engine against the gate that must catch it and writes what came
// of it. Ends with 1 where one is not caught.

int main(int argc, char** argv) {
  try {
    if (argc != 2) {
      fmt::print(stderr, "usage: carom-gate-catches FILE\n");
      return 2;
    }
    const std::vector<carom::gates::Catch> catches = carom::gates::run_catches(CAROM_TEST_ENGINE_DIR);
    carom::write_file(argv[1], carom::gates::catches_json(catches));
    const bool all = std::all_of(catches.begin(), catches.end(), [](const auto& row) { return row.caught; });
    return all ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "carom-gate-catches: {}\n", error.what());
    return 3;
  }
}
