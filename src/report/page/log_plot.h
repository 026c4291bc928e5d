#pragma once

#include <string>
#include <vector>

#include "report/page/html.h"
#include "report/page/polyline.h"

namespace carom::page {

/// A line of a plot whose axes are both powers of ten.
struct PowerLine {
  std::string label;
  Polyline points;  ///< values as they are, above 0
};

/// A small plot of lines by the number of balls, each with a colour and a shape of its own, and their key.
/// The slope of a line is the power by which it grows. @pre there is a point
/// @param quantity  what the vertical axis shows, "operations": its powers of ten are
void add_log_plot(Node parent, const std::string& title, const std::string& quantity,
                  const std::vector<PowerLine>& lines);

}  // namespace carom::page
