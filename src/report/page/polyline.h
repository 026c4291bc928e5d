#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace carom::page {

/// A place in a drawing, in its pixels, y downwards.
struct Point {
  double x = 0.0;
  double y = 0.0;
};

/// A line through points; one that is not finite breaks it.
using Polyline = std::vector<Point>;

/// The coordinate as it stands in an SVG attribute: tenths of a pixel, held to what a drawing can need.
/// @pre the value is finite
std::string px(double value);

/// About one for each pixel of a plot.
inline constexpr std::size_t kMaxPoints = 300;

/// What can be seen of a line: never more than `at_most` points, extremes kept. @pre all points are finite
Polyline thinned(Polyline line, std::size_t at_most = kMaxPoints);

/// The finite pieces of a line.
std::vector<Polyline> pieces(const Polyline& line);

/// The line as the `d` of an SVG path, thinned; empty where nothing is finite.
std::string path_data(const Polyline& line, std::size_t at_most = kMaxPoints);

}  // namespace carom::page
