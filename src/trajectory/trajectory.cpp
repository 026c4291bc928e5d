#include "trajectory/trajectory.h"

#include <limits>

#include "scenario/cast.h"

namespace carom {

SharedMemory Trajectory::memory_for_states(const Scenario& scenario) {
  return SharedMemory((static_cast<std::size_t>(scenario.frames) + 1) * numbered_balls(scenario) *
                      sizeof(BallState));
}

Trajectory::Trajectory(const Scenario& scenario) : Trajectory(scenario, memory_for_states(scenario)) {}

Trajectory::Trajectory(const Scenario& scenario, const SharedMemory& states)
    : frames_(static_cast<std::size_t>(scenario.frames) + 1),
      balls_(numbered_balls(scenario)),
      duration_s_(scenario.duration_s),
      states_(states.mapped<BallState>()),
      tallies_(SharedMemory(frames_ * sizeof(Tally)).mapped<Tally>()) {
  if (scenario.events.empty()) return;
  absent_ = std::make_shared<std::vector<bool>>(frames_ * balls_);
  const Vec3 nowhere = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  Cast cast(scenario);
  for (std::size_t k = 0; k < frames_; ++k) {
    cast.to_frame(static_cast<std::int64_t>(k));
    for (std::size_t i = 0; i < balls_; ++i) {
      if (cast[i]) continue;
      (*absent_)[k * balls_ + i] = true;
      frame(k)[i] = {nowhere, nowhere, nowhere};
    }
  }
}

}  // namespace carom
