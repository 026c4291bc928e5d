#pragma once

#include <algorithm>
#include <vector>

namespace carom::benchmark {

/// The values of one quantity in several rounds. @pre of the members below: there is one
struct Samples {
  std::vector<double> values;

  double low() const { return *std::min_element(values.begin(), values.end()); }
  double high() const { return *std::max_element(values.begin(), values.end()); }
  double median() const {
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t middle = sorted.size() / 2;
    return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
  }
};

/// Round by round, so that what a machine does to both of a round cancels. @pre as many rounds of both
inline Samples ratio(const Samples& dividend, const Samples& divisor) {
  Samples result;
  for (std::size_t i = 0; i < divisor.values.size(); ++i) {
    result.values.push_back(dividend.values[i] / divisor.values[i]);
  }
  return result;
}

}  // namespace carom::benchmark
