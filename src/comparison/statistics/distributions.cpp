#include "comparison/statistics/distributions.h"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <numeric>

namespace carom {

EnergyShare::EnergyShare(int dimension, std::size_t balls) : dimension_(dimension), balls_(balls) {}

double EnergyShare::cdf(double x) const {
  if (!(x > 0.0)) return 0.0;
  if (x >= 1.0) return 1.0;
  const double others = static_cast<double>(balls_ - 1);
  return boost::math::cdf(boost::math::beta_distribution<>(0.5 * dimension_, 0.5 * dimension_ * others), x);
}

double EnergyShare::fourth_moment_mean() const {
  return -2.0 / (dimension_ * static_cast<double>(balls_) + 2.0);
}

double EnergyShare::fourth_moment_deviation() const {
  const auto n = static_cast<double>(balls_);
  const double a = 0.5 * dimension_;
  const double s = a * n;
  const double d = s * (s + 1.0) * (s + 2.0) * (s + 3.0);
  const double of_one = a * (a + 1.0) * (a + 2.0) * (a + 3.0) / d;
  const double of_two = a * (a + 1.0) * a * (a + 1.0) / d;
  const double mean = n * a * (a + 1.0) / (s * (s + 1.0));
  const double square = n * of_one + n * (n - 1.0) * of_two;
  return n * dimension_ / (dimension_ + 2.0) * std::sqrt(std::max(0.0, square - mean * mean));
}

double EnergyShare::group_deviation(std::size_t members) const {
  const double share = static_cast<double>(members) / static_cast<double>(balls_);
  const double s = 0.5 * dimension_ * static_cast<double>(balls_);
  return std::sqrt(share * (1.0 - share) / (s + 1.0));
}

double kolmogorov_distance(std::span<const double> sorted, const std::function<double(double)>& cdf) {
  const auto n = static_cast<double>(sorted.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double expected = cdf(sorted[i]);
    const auto below = static_cast<double>(i);
    largest = std::max({largest, expected - below / n, (below + 1.0) / n - expected});
  }
  return largest;
}

double kolmogorov_p(double distance, std::size_t n) {
  const double root = std::sqrt(static_cast<double>(n));
  const double lambda = (root + 0.12 + 0.11 / root) * distance;
  // Below this p is 1 to all digits of a double, and the series converges slowly.
  constexpr double kCertain = 0.2;
  if (lambda < kCertain) return 1.0;
  double sum = 0.0;
  double sign = 1.0;
  for (int k = 1; k < 100; ++k) {
    const double term = std::exp(-2.0 * k * k * lambda * lambda);
    sum += sign * term;
    if (term <= std::numeric_limits<double>::epsilon() * std::abs(sum)) break;
    sign = -sign;
  }
  return std::clamp(2.0 * sum, 0.0, 1.0);
}

double sigmas_of(double p) {
  if (p >= 0.5) return 0.0;
  const double least = std::numeric_limits<double>::min();
  return boost::math::quantile(boost::math::complement(boost::math::normal(), std::max(p, least)));
}

TimeMean time_mean(std::span<const double> series) {
  const std::size_t length = series.size() / kBatches;
  const auto whole = series.last(length * kBatches);
  TimeMean result;
  result.mean = std::accumulate(whole.begin(), whole.end(), 0.0) / static_cast<double>(whole.size());
  double squares = 0.0;
  for (std::size_t batch = 0; batch < kBatches; ++batch) {
    const auto span = whole.subspan(batch * length, length);
    const double mean = std::accumulate(span.begin(), span.end(), 0.0) / static_cast<double>(length);
    squares += (mean - result.mean) * (mean - result.mean);
  }
  result.error = std::sqrt(squares / static_cast<double>(kBatches * (kBatches - 1)));
  return result;
}

}  // namespace carom
