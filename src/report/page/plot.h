#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/page/axis.h"
#include "report/page/html.h"
#include "report/page/style.h"

namespace carom::page {

/// The values of one run over time; what is not finite leaves a gap.
struct Line {
  std::string label;
  std::vector<double> values;

  double peak() const;  ///< the largest |value|, 0 where there is none
};

/// A horizontal line that the curves are seen against.
struct Rule {
  double value = 0.0;
  std::string label;
  const char* look = "";
};

/// A moment that the curves are seen against.
struct Mark {
  double time_s = 0.0;
  std::string label;
};

struct Plot {
  std::string title;
  std::string quantity;  ///< of the vertical axis, with its unit
  std::vector<double> times_s;
  std::vector<Line> lines;
  std::vector<double> expected;  ///< the truth's values, where they are known and not zero
  std::vector<Rule> rules;
  std::optional<Mark> horizon;  ///< until when the values mean something
};

/// Powers of ten for values that are >= 0; zero is drawn at the bottom.
Axis log_axis(const Plot& plot);

/// Linear where the peaks of the lines are of a size; else powers of ten to both sides of zero.
Axis signed_axis(const Plot& plot);

/// @pre the plot has a line, and each line a value for each time
void add_plot(Node parent, const Plot& plot, const Axis& y, const Legend& legend);

}  // namespace carom::page
