#pragma once

#include <cstddef>
#include <string>

namespace carom {

/// One line on stderr that says how far a long command is; only on a terminal, and gone when it is done.
class Progress {
 public:
  Progress(std::size_t total, bool quiet);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// One more of the total is done; `what` is under way.
  void advance(const std::string& what);

 private:
  std::size_t done_ = 0;
  std::size_t total_;
  bool shown_;
};

}  // namespace carom
