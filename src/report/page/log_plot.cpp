#include "report/page/log_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/page/canvas.h"
#include "report/page/style.h"

namespace carom::page {

namespace {

constexpr double kLogPlotWidth_px = 330.0;
constexpr double kLogPlotHeight_px = 220.0;
constexpr int kBallTicks = 4;
constexpr int kQuantityTicks = 10;

/// A colour and a shape of its own for each line of a plot.
LineStyle style_of(std::size_t line) {
  return {fmt::format("c{}", line), {}, line};
}

void add_key(Node parent, const std::vector<PowerLine>& lines) {
  Node key = add(parent, "ul", {{"class", "key"}});
  for (std::size_t i = 0; i < lines.size(); ++i) {
    Node item = add(key, "li");
    Node svg = add(
        item, "svg",
        {{"class", "swatch " + style_of(i).colour_class}, {"viewBox", "0 0 34 12"}, {"aria-hidden", "true"}});
    add(svg, "path", {{"class", "line"}, {"d", "M1 6h32"}});
    add(svg, "path", {{"class", "marker"}, {"d", style_of(i).marker({17.0, 6.0})}});
    say(item, " " + lines[i].label);
  }
}

/// (log₁₀ x, log₁₀ y)
Polyline logarithms(const Polyline& points) {
  Polyline line;
  for (const Point& point : points) line.push_back({std::log10(point.x), std::log10(point.y)});
  return line;
}

/// From the smallest to the largest of a coordinate of all points, widened to whole powers.
Axis axis_over(const std::vector<Polyline>& lines, double Point::*coordinate) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Polyline& line : lines) {
    for (const Point& point : line) {
      low = std::min(low, std::floor(point.*coordinate));
      high = std::max(high, std::ceil(point.*coordinate));
    }
  }
  return low < high ? Axis::linear(low, high) : Axis::linear(0.0, 1.0);
}

}  // namespace

void add_log_plot(Node parent, const std::string& title, const std::string& quantity,
                  const std::vector<PowerLine>& power_lines) {
  std::vector<Polyline> lines;
  lines.reserve(power_lines.size());
  for (const PowerLine& line : power_lines) lines.push_back(logarithms(line.points));
  Node figure = add(parent, "figure");
  add(add(figure, "figcaption"), "strong", {}, title + ".");
  add_key(figure, power_lines);
  const Canvas canvas = add_canvas(figure, {title, "The numbers are in the table."},
                                   axis_over(lines, &Point::x), axis_over(lines, &Point::y), kLogPlotWidth_px,
                                   kLogPlotHeight_px, {kBallTicks, "balls, as a power of ten"},
                                   {kQuantityTicks, quantity + ", as a power of ten"});
  for (std::size_t i = 0; i < lines.size(); ++i) {
    Polyline drawn;
    for (const Point& point : lines[i]) drawn.push_back(canvas.at(point.x, point.y));
    const LineStyle style = style_of(i);
    add(canvas.area, "path", {{"class", "line " + style.colour_class}, {"d", path_data(drawn)}});
    std::string markers;
    for (const Point& point : drawn) markers += style.marker(point);
    add(canvas.area, "path", {{"class", "marker " + style.colour_class}, {"d", markers}});
  }
}

}  // namespace carom::page
