#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "carom/broad_phase/broad_phase.h"

namespace carom {

/// Pairs of balls by the time at which they are due: a calendar queue whose days are steps, or a few
/// of them where there are very many. Source: R. Brown, Commun. ACM 31, 1220 (1988).
///
/// A step ends where a day does, but for rounding; so days are put a little later, and end a thousandth of
/// a day after the step.
class Calendar {
 public:
  /// Forgets all pairs, and begins at time zero. @param day_s  how long steps will be. @param end_s  when the
  /// last day is over
  void begin(double day_s, double end_s) {
    const double wanted = end_s / day_s + 2.0;
    const double days = wanted < kMostDays ? wanted : kMostDays;
    day_s_ = std::max(day_s, end_s / days);
    days_.clear();
    days_.resize(static_cast<std::size_t>(days));
    last_ = static_cast<std::size_t>(days) - 1;
    today_ = 0;
  }

  /// @param due_s  when the pair is due; at once where that is over. @pre begin() was called
  void put(const BallPair& pair, double due_s) { days_[std::max(today_, day_of(due_s))].push_back(pair); }

  /// Takes out all pairs that are due until then, and adds them to `due`; some that are a little later may be
  /// among them.
  void take(double until_s, std::vector<BallPair>& due) {
    const std::size_t until = std::max(today_, day_of(until_s * kRoundUp));
    for (; today_ < until; ++today_) take_day(due);
    take_day(due);  // it may go on in the next step
  }

 private:
  /// So that an empty calendar is begun in no time; with more steps than that before its end, some look at
  /// the same day.
  static constexpr double kMostDays = 1024.0;
  /// Day k ends 1/1024 of a day after k days; what is rounded of a thousand days is far less.
  static constexpr double kLater = 1.0 - 1.0 / 1024.0;
  /// For times that are added up step by step: n steps are off by n u at most, and 2⁻²⁴ is 2²⁹ u.
  static constexpr double kRoundUp = 1.0 + 0x1p-24;

  void take_day(std::vector<BallPair>& due) {
    std::vector<BallPair>& day = days_[today_];
    due.insert(due.end(), day.begin(), day.end());
    day.clear();
  }

  /// What is not a number is due on the last day, which is never over.
  std::size_t day_of(double time_s) const {
    const double day = time_s / day_s_ + kLater;
    return day < static_cast<double>(last_) ? static_cast<std::size_t>(day) : last_;
  }

  std::vector<std::vector<BallPair>> days_;
  double day_s_ = 1.0;
  std::size_t today_ = 0;
  std::size_t last_ = 0;
};

}  // namespace carom
