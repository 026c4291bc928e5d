#include "study/foresee.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/timing.h"

namespace carom {

namespace {

/// A run of more than this gets kLongRepeats, its start and the resolution of the clock being nothing to it.
constexpr double kLong_s = 0.1;
constexpr int kLongRepeats = 3;

}  // namespace

int repeats_for(double cpu_s, int asked) {
  return cpu_s > kLong_s ? std::min(asked, kLongRepeats) : asked;
}

double timing_cost_s(double cpu_s, int runs) {
  return runs * (kStart_s + std::min(cpu_s, kWarm_s) + std::max(cpu_s, kLeast_s));
}

Foresight foresee(const std::vector<StudyPoint>& points, std::size_t index) {
  const StudyPoint& point = points[index];
  Foresight result;
  bool by_itself = false;
  for (const StudyPoint& other : points) {
    const bool same = other.setting == point.setting;
    const bool tells = other.engine == point.engine && other.status;
    if (!tells || other.steps_per_frame > point.steps_per_frame) continue;
    if (!same && (!other.setting.empty() || by_itself)) continue;
    if (same && *other.status == RunStatus::timeout) result.hopeless = true;
    if (other.recorded_cpu_s <= 0.0) continue;
    by_itself = same;
    result.cpu_s = other.recorded_cpu_s * static_cast<double>(point.steps_per_frame) /
                   static_cast<double>(other.steps_per_frame);
  }
  return result;
}

std::string too_long(const Foresight& foresight, double timeout_s) {
  if (foresight.cpu_s && *foresight.cpu_s > timeout_s) {
    return fmt::format("foreseen to take {:.2g} s, longer than {:g} s", *foresight.cpu_s, timeout_s);
  }
  return foresight.hopeless ? "a coarser step was stopped or left out already" : "";
}

}  // namespace carom
