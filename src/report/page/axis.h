#pragma once

#include <string>
#include <vector>

namespace carom::page {

struct Tick {
  double value = 0.0;
  std::string label;
};

/// One axis of a plot: from values to fractions of its length, and where its ticks stand. Its ends are below
/// 1e300.
class Axis {
 public:
  enum class Scale { linear, log, symlog };

  /// @pre low < high, both finite
  static Axis linear(double low, double high);

  /// Powers of ten from `floor` to at least `high`. What is smaller than `floor`, zero included, is drawn
  /// there.
  /// @pre floor > 0
  static Axis log(double floor, double high);

  /// Powers of ten from at most `low` to at least `high`, for values that are never zero.
  /// @pre 0 < low <= high
  static Axis powers(double low, double high);

  /// Powers of ten to both sides of a zero: u = sign(x) log10(1 + |x|/threshold), reaching at least from low
  /// to high. @pre threshold > 0, low <= 0 <= high
  static Axis symlog(double threshold, double low, double high);

  /// 0 at the low end and 1 at the high one; not a number for what is not finite.
  double fraction(double value) const;

  /// At round values (linear) or powers of ten, as many as are readable but not more than about `at_most`.
  std::vector<Tick> ticks(int at_most) const;

  Scale scale() const { return scale_; }
  double threshold() const { return threshold_; }  ///< the floor of a logarithmic axis
  double low() const { return low_; }              ///< in the axis' own measure, as high()
  double high() const { return high_; }

 private:
  Axis(Scale scale, double threshold, double low, double high);

  double measure(double value) const;

  Scale scale_;
  double threshold_;
  double low_;
  double high_;
  bool names_zero_ = true;  // a logarithmic axis: its floor stands for zero
};

}  // namespace carom::page
