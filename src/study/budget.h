#pragma once

#include <sys/resource.h>

#include "trajectory/cpu_time.h"

namespace carom {

/// What a part of a study may take in CPU time, of this program and of all the processes that it has waited
/// for: so a machine that is busy with something else leaves no more runs out than an idle one.
class CpuBudget {
 public:
  explicit CpuBudget(double seconds) : end_s_(used_s() + seconds) {}

  /// s; below zero where more was used.
  double left_s() const { return end_s_ - used_s(); }

 private:
  static double used_s() {
    rusage children{};
    getrusage(RUSAGE_CHILDREN, &children);
    double sum_s = cpu_now();
    for (const timeval& each : {children.ru_utime, children.ru_stime}) {
      sum_s += static_cast<double>(each.tv_sec) + 1e-6 * static_cast<double>(each.tv_usec);
    }
    return sum_s;
  }

  double end_s_;
};

}  // namespace carom
