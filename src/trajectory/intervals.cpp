#include "trajectory/intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "scenario/cast.h"

namespace carom {

namespace {

std::int64_t equal_steps(double steps) {
  // A whole number that the divisions before rounded up is that number: each errs by at most ½ε.
  const double whole = std::ceil(steps * (1.0 - 2.0 * std::numeric_limits<double>::epsilon()));
  return static_cast<std::int64_t>(std::max(whole, 1.0));
}

/// A moment within an interval, and the step that ends there, where one does.
struct Cut {
  double after_s = 0.0;  ///< from the start of the interval
  std::optional<std::int64_t> step = 0;
};

/// An interval between frames, being cut.
class Interval {
 public:
  explicit Interval(const Scenario& scenario)
      : scenario_(scenario),
        steps_(steps_per_frame(scenario)),
        step_s_(scenario.duration_s / static_cast<double>(scenario.frames) / static_cast<double>(steps_)) {}

  void cut_at(const Cut& cut, std::size_t events) {
    Part part{step_s_, 0, events};
    if (cut.step && last_.step) {
      part.steps = *cut.step - *last_.step;
    } else if (const double rest_s = cut.after_s - last_.after_s; rest_s > same_moment_s(scenario_)) {
      part.steps = equal_steps(rest_s / scenario_.step_s);
      part.step_s = rest_s / static_cast<double>(part.steps);
    }
    last_ = cut;
    if (part.steps > 0 || events > 0) parts_.push_back(part);
  }

  Cut at(double after_s) const {
    const double steps = std::clamp(std::round(after_s / step_s_), 0.0, static_cast<double>(steps_));
    if (std::abs(after_s - steps * step_s_) > same_moment_s(scenario_)) return {after_s, {}};
    return {steps * step_s_, static_cast<std::int64_t>(steps)};
  }

  Cut end() const { return {static_cast<double>(steps_) * step_s_, steps_}; }
  std::vector<Part> parts() const { return parts_; }

 private:
  const Scenario& scenario_;
  std::int64_t steps_;
  double step_s_;
  Cut last_;
  std::vector<Part> parts_;
};

}  // namespace

std::int64_t steps_per_frame(const Scenario& scenario) {
  return equal_steps(scenario.duration_s / static_cast<double>(scenario.frames) / scenario.step_s);
}

std::vector<Part> parts_of_interval(const Scenario& scenario, std::int64_t frame, std::size_t first_event) {
  Interval interval(scenario);
  for (std::size_t i = first_event; i < scenario.events.size(); ++i) {
    const Event& event = scenario.events[i];
    if (first_frame_after(scenario, event) > frame) break;
    interval.cut_at(frame == 0 ? Cut{} : interval.at(event.time - frame_time_s(scenario, frame - 1)), 1);
  }
  if (frame > 0) interval.cut_at(interval.end(), 0);
  return interval.parts();
}

}  // namespace carom
