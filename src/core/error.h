#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace carom {

/// The user's input is wrong: what() says where, what was found and what is allowed. Exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The machine failed the program: no space, no permission, no more processes. Exit code 3.
class MachineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A place in a text file; line and column count from 1, and are 0 where they are not known.
struct SourcePlace {
  std::string file;
  std::uint32_t line = 0;
  std::uint32_t column = 0;
};

}  // namespace carom
