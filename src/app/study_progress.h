#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace carom {

/// Says on stderr how far a study is and about how long it will still take: on a terminal in one line, which
/// is gone when it is done; elsewhere in a line for each scene, for who looks into the log of a long one.
class StudyProgress {
 public:
  /// @param parts  scenes and gases, that are taken to last equally long until they are known
  StudyProgress(std::size_t parts, bool quiet);
  StudyProgress(const StudyProgress&) = delete;
  StudyProgress& operator=(const StudyProgress&) = delete;
  ~StudyProgress();

  /// @param name  of the scene or gas; the part before has ended
  void begin_part(const std::string& name);
  /// The last one is done.
  void end_part();
  /// So many more runs are to be done in this part.
  void more(std::size_t runs);
  /// One of them is done.
  void done(const std::string& what);

 private:
  using Clock = std::chrono::steady_clock;

  double seconds_left(Clock::time_point now) const;

  std::size_t parts_;
  bool shown_;   // in one line
  bool logged_;  // in many
  std::string name_;
  std::size_t part_ = 0;  // that is under way, from 1
  std::size_t runs_ = 0;  // of this stage
  std::size_t runs_done_ = 0;
  Clock::time_point start_;
  Clock::time_point part_start_;
  Clock::time_point stage_start_;
  Clock::time_point printed_;
};

}  // namespace carom
