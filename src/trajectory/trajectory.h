#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "scenario/scenario.h"
#include "trajectory/interference.h"
#include "trajectory/shared_memory.h"

namespace carom {

/// The recorded frames of one run: the state of every ball and the running totals, at t = 0 and then evenly
/// over the duration. It lives in memory that a recording process can share with the one that started it.
class Trajectory {
 public:
  Trajectory() = default;
  /// Room for a scene's frames. @throws MachineError where there is no memory.
  explicit Trajectory(const Scenario& scenario);
  /// The same, with its states in this memory, through which they can be written, too.
  Trajectory(const Scenario& scenario, const SharedMemory& states);
  static SharedMemory memory_for_states(const Scenario& scenario);

  std::size_t frames() const { return frames_; }  ///< the initial one included
  std::size_t balls() const { return balls_; }    ///< by number (scenario/cast.h)
  double time(std::size_t frame) const {
    return duration_s_ * static_cast<double>(frame) / static_cast<double>(frames_ - 1);
  }

  std::span<BallState> frame(std::size_t frame) { return {states_.get() + frame * balls_, balls_}; }
  std::span<const BallState> frame(std::size_t frame) const {
    return {states_.get() + frame * balls_, balls_};
  }
  /// Whether a ball is there in a frame: events add balls and take them away. The state of one that is not is
  /// NaN.
  bool present(std::size_t frame, std::size_t ball) const {
    return !absent_ || !(*absent_)[frame * balls_ + ball];
  }
  Tally& tally(std::size_t frame) { return tallies_.get()[frame]; }
  const Tally& tally(std::size_t frame) const { return tallies_.get()[frame]; }

 private:
  std::size_t frames_ = 0;
  std::size_t balls_ = 0;
  double duration_s_ = 0.0;
  std::shared_ptr<BallState[]> states_;
  std::shared_ptr<Tally[]> tallies_;
  std::shared_ptr<std::vector<bool>> absent_;  ///< by frame and ball; none: all are always there
};

/// An engine in a profile, as on the command line: the profile is named unless it is the faithful one.
inline std::string engine_label(const std::string& engine, const std::string& profile) {
  return profile == "faithful" ? engine : engine + "@" + profile;
}

enum class RunStatus { ok, unsupported, crashed, timeout, invalid };

/// One engine's run of one scene: what it was, how it ended, and what was recorded where it ended well.
struct Run {
  std::string engine;
  std::string profile;
  std::string version;
  std::string precision;
  Settings settings;
  RunStatus status = RunStatus::ok;
  std::string reason;        ///< why the status is not ok
  double cpu_seconds = 0.0;  ///< of the stepping alone
  std::int64_t steps = 0;
  double uncertainty_m = 0.0;
  std::vector<Interference> interferences;  ///< what the scene's events did, in order
  Trajectory trajectory;                    ///< meaningless unless the status is ok

  std::string label() const { return engine_label(engine, profile); }
};

}  // namespace carom
