#include "app/study_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace carom {

namespace {

using Seconds = std::chrono::duration<double>;
/// Often enough for the eye.
constexpr std::chrono::milliseconds kBetween(100);

/// "about 40 s", "about 3 min"
std::string about(double seconds) {
  return seconds < 90.0 ? fmt::format("about {:.0f} s", std::ceil(seconds))
                        : fmt::format("about {:.0f} min", std::ceil(seconds / 60.0));
}

}  // namespace

StudyProgress::StudyProgress(std::size_t parts, bool quiet)
    : parts_(parts),
      shown_(!quiet && isatty(STDERR_FILENO) == 1),
      logged_(!quiet && !shown_),
      start_(Clock::now()),
      part_start_(start_),
      stage_start_(start_),
      printed_(start_ - kBetween) {}

StudyProgress::~StudyProgress() {
  if (shown_) fmt::print(stderr, "\r\x1b[K");
}

void StudyProgress::begin_part(const std::string& name) {
  if (part_ > 0) end_part();
  ++part_;
  name_ = name;
  part_start_ = Clock::now();
  runs_ = 0;
  runs_done_ = 0;
}

void StudyProgress::end_part() {
  if (!logged_) return;
  const Clock::time_point now = Clock::now();
  runs_done_ = runs_;
  fmt::print(stderr, "[{}/{}] {}: {:.0f} s, {} left\n", part_, parts_, name_,
             Seconds(now - part_start_).count(), about(seconds_left(now)));
}

void StudyProgress::more(std::size_t runs) {
  stage_start_ = Clock::now();
  runs_ = runs;
  runs_done_ = 0;
}

double StudyProgress::seconds_left(Clock::time_point now) const {
  const double stage_s = Seconds(now - stage_start_).count();
  const double in_part_s = stage_s * static_cast<double>(runs_ - runs_done_) /
                           static_cast<double>(std::max<std::size_t>(runs_done_, 1));
  const double parts_done = static_cast<double>(part_ - 1);
  const double before_s = Seconds(part_start_ - start_).count();
  const double this_part_s = Seconds(now - part_start_).count() + in_part_s;
  const double each_s = (before_s + this_part_s) / (parts_done + 1.0);
  return in_part_s + each_s * static_cast<double>(parts_ - part_);
}

void StudyProgress::done(const std::string& what) {
  if (runs_done_ < runs_) ++runs_done_;
  const Clock::time_point now = Clock::now();
  if (!shown_ || part_ == 0 || now - printed_ < kBetween) return;
  printed_ = now;
  fmt::print(stderr, "\r\x1b[K[{}/{}] {:.44}, {} left", part_, parts_, what, about(seconds_left(now)));
  std::fflush(stderr);
}

}  // namespace carom
