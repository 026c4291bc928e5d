#pragma once

#include <cstddef>
#include <vector>

namespace carom {

struct FittedLine {
  double slope = 0.0;
  double r_squared = 0.0;  ///< share of the variance of y that the line explains, 0 … 1
};

/// The straight line through points (x, y) with the least squares of distances along y.
/// @pre not all x are equal, nor all y
inline FittedLine line_through(const std::vector<double>& x, const std::vector<double>& y) {
  const auto count = static_cast<double>(x.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / count;
    mean_y += y[i] / count;
  }
  double covariance = 0.0;
  double variance_x = 0.0;
  double variance_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    covariance += (x[i] - mean_x) * (y[i] - mean_y);
    variance_x += (x[i] - mean_x) * (x[i] - mean_x);
    variance_y += (y[i] - mean_y) * (y[i] - mean_y);
  }
  return {covariance / variance_x, covariance * covariance / (variance_x * variance_y)};
}

}  // namespace carom
