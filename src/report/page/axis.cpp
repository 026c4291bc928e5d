#include "report/page/axis.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "report/page/wording.h"

namespace carom::page {

namespace {

// A value this close to a power of ten, or to a tick, is that power or tick, rounded by log10 and by
// division.
constexpr double kSlack = 1e-9;

int exponent_below(double value) {
  return static_cast<int>(std::floor(std::log10(value) + kSlack));
}
int exponent_above(double value) {
  return static_cast<int>(std::ceil(std::log10(value) - kSlack));
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `step`.
double round_step(double step) {
  const double power = std::pow(10.0, exponent_below(step));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= step * (1.0 - kSlack)) return factor * power;
  }
  return 10.0 * power;
}

std::vector<Tick> linear_ticks(double low, double high, int at_most) {
  const double step = round_step((high - low) / std::max(at_most - 1, 1));
  std::vector<Tick> ticks;
  const auto last = static_cast<std::int64_t>(std::floor(high / step + kSlack));
  for (auto i = static_cast<std::int64_t>(std::ceil(low / step - kSlack)); i <= last; ++i) {
    const double value = static_cast<double>(i) * step;
    ticks.push_back({value, given(value)});
  }
  return ticks;
}

/// The powers of ten from first to last whose exponent is a multiple of `stride`, so that both sides of zero,
/// and the axes of two plots, name the same ones.
void append_decades(std::vector<Tick>& ticks, int first, int last, int stride, double sign) {
  for (int exponent = first; exponent <= last; ++exponent) {
    if (exponent % stride != 0) continue;
    ticks.push_back({sign * std::pow(10.0, exponent), (sign < 0.0 ? "−" : "") + power_of_ten(exponent)});
  }
}

/// How many decades apart the ticks stand, for at most so many on this many decades.
int decade_stride(double decades, int at_most) {
  return std::max(1, static_cast<int>(std::ceil(decades / std::max(at_most - 1, 1))));
}

}  // namespace

Axis::Axis(Scale scale, double threshold, double low, double high)
    : scale_(scale), threshold_(threshold), low_(low), high_(high) {}

Axis Axis::linear(double low, double high) {
  return {Scale::linear, 0.0, low, high};
}

Axis Axis::log(double floor, double high) {
  const int bottom = exponent_below(floor);
  const int top = high > 0.0 ? exponent_above(high) : bottom;
  return {Scale::log, std::pow(10.0, bottom), static_cast<double>(bottom),
          static_cast<double>(std::max(top, bottom + 1))};
}

Axis Axis::powers(double low, double high) {
  Axis axis = log(low, high);
  axis.names_zero_ = false;
  return axis;
}

Axis Axis::symlog(double threshold, double low, double high) {
  Axis axis(Scale::symlog, std::pow(10.0, exponent_below(threshold)), 0.0, 0.0);
  const auto reach = [&axis](double end) {
    return end > axis.threshold_ ? axis.measure(std::pow(10.0, exponent_above(end))) : 1.0;
  };
  axis.high_ = reach(high);
  axis.low_ = -reach(-low);
  return axis;
}

double Axis::measure(double value) const {
  switch (scale_) {
    case Scale::linear:
      return value;
    case Scale::log:
      return std::log10(std::max(value, threshold_));
    case Scale::symlog:
      // log10(1 + |x|/threshold), written so that no |x| overflows
      return std::copysign(std::log10(threshold_ + std::abs(value)) - std::log10(threshold_), value);
  }
  return value;
}

double Axis::fraction(double value) const {
  if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
  return (measure(value) - low_) / (high_ - low_);
}

std::vector<Tick> Axis::ticks(int at_most) const {
  if (scale_ == Scale::linear) return linear_ticks(low_, high_, at_most);
  const int stride = decade_stride(high_ - low_, at_most);
  const int floor = exponent_below(threshold_);
  if (!names_zero_) {
    std::vector<Tick> powers;
    append_decades(powers, floor, static_cast<int>(high_), stride, 1.0);
    return powers;
  }
  // Zero is labelled too: at the floor of a logarithmic axis, which stands for it, or in the middle. A label
  // nearer to it than about half a stride would touch it.
  const int first = floor + std::max(1, (stride + 1) / 2);
  std::vector<Tick> ticks = {{scale_ == Scale::log ? threshold_ : 0.0, "0"}};
  if (scale_ == Scale::log) {
    append_decades(ticks, first, static_cast<int>(high_), stride, 1.0);
  } else {
    append_decades(ticks, first, floor + static_cast<int>(high_), stride, 1.0);
    append_decades(ticks, first, floor + static_cast<int>(-low_), stride, -1.0);
  }
  return ticks;
}

}  // namespace carom::page
