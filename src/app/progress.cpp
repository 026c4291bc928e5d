#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace carom {

Progress::Progress(std::size_t total, bool quiet)
    : total_(total), shown_(!quiet && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::advance(const std::string& what) {
  ++done_;
  if (!shown_) return;
  fmt::print(stderr, "\r\x1b[K[{}/{}] {:.60}", done_, total_, what);
  std::fflush(stderr);
}

}  // namespace carom
