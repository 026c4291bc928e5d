#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace carom {

/// One line on stderr that says how far a study is and about how long it will still take; only on a terminal,
/// and gone when it is done.
class StudyProgress {
 public:
  /// @param parts  scenes and gases, that are taken to last equally long until they are known
  StudyProgress(std::size_t parts, bool quiet);
  StudyProgress(const StudyProgress&) = delete;
  StudyProgress& operator=(const StudyProgress&) = delete;
  ~StudyProgress();

  void begin_part();
  /// So many more runs are to be done in this part.
  void more(std::size_t runs);
  /// One of them is done.
  void done(const std::string& what);

 private:
  using Clock = std::chrono::steady_clock;

  double seconds_left(Clock::time_point now) const;

  std::size_t parts_;
  bool shown_;
  std::size_t part_ = 0;  // that is under way, from 1
  std::size_t runs_ = 0;  // of this stage
  std::size_t runs_done_ = 0;
  Clock::time_point start_;
  Clock::time_point part_start_;
  Clock::time_point stage_start_;
  Clock::time_point printed_;
};

}  // namespace carom
