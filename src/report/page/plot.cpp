#include "report/page/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "report/page/canvas.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

constexpr double kPlotWidth_px = 330.0;
constexpr double kPlotHeight_px = 190.0;
constexpr int kTimeTicks = 6;
constexpr int kValueTicks = 8;

// Where zero is drawn on a logarithmic axis: below half the machine epsilon of double precision, 1.1e-16, so
// that "nothing" and "a rounding error" look different. The same in every plot, so that plots can be
// compared.
constexpr double kFloor = 1e-17;
// Where all errors are smaller still, as of tiny balls, an axis follows them down to here.
constexpr double kLowestFloor = 1e-30;
// Engines whose largest values differ by less than this are told apart on a linear axis.
constexpr double kDecadesNeeded = 1e3;
// An axis of powers of ten spans this at least.
constexpr double kLeastSpan = 1e2;

/// "The largest values: carom 2.2e-16, box2d 3.1e-7."
std::string every_peak(const Plot& plot) {
  std::vector<std::string> peaks;
  for (const Line& line : plot.lines) {
    peaks.push_back(line.label + " " + number(line.peak()));
  }
  return "The largest values: " + list_of(peaks) + ".";
}

/// "The peaks reach from 2.2e-16 (carom) to 3.1e-7 (box2d)."
std::string finding(const Plot& plot) {
  const auto [best, worst] = std::minmax_element(
      plot.lines.begin(), plot.lines.end(), [](const Line& a, const Line& b) { return a.peak() < b.peak(); });
  if (!plot.expected.empty()) return "The wide pale line is the truth, where it is not conserved.";
  if (worst->peak() == 0.0) return "Exactly 0 throughout.";
  if (plot.lines.size() == 1) return fmt::format("At most {} in {}.", number(best->peak()), best->label);
  return fmt::format("The peaks reach from {} ({}) to {} ({}).", number(best->peak()), best->label,
                     number(worst->peak()), worst->label);
}

/// A few markers on each line, shifted from engine to engine so that lines that coincide still show theirs.
void draw_markers(const Canvas& canvas, const LineStyle& style, const Polyline& line, double shift) {
  constexpr int kMarkers = 4;
  std::string data;
  for (int i = 0; i < kMarkers; ++i) {
    const double share = (i + shift) / kMarkers;
    const auto at = static_cast<std::size_t>(std::lround(share * static_cast<double>(line.size() - 1)));
    if (std::isfinite(line[at].x) && std::isfinite(line[at].y)) data += style.marker(line[at]);
  }
  if (!data.empty()) add(canvas.area, "path", {{"class", "marker " + style.colour_class}, {"d", data}});
}

Polyline curve(const Canvas& canvas, const Plot& plot, const std::vector<double>& values) {
  Polyline line;
  for (std::size_t k = 0; k < plot.times_s.size(); ++k) line.push_back(canvas.at(plot.times_s[k], values[k]));
  return line;
}

void draw_line(const Canvas& canvas, const Plot& plot, std::size_t index, const LineStyle& style) {
  const Polyline line = curve(canvas, plot, plot.lines[index].values);
  Node path = add(canvas.area, "path",
                  {{"class", "line " + style.colour_class},
                   {"data-label", plot.lines[index].label},
                   {"d", path_data(line)}});
  if (!style.dashes.empty()) path.append_attribute("stroke-dasharray").set_value(style.dashes.c_str());
  const double count = static_cast<double>(plot.lines.size());
  draw_markers(canvas, style, line, (static_cast<double>(index) + 0.5) / count);
}

/// The height of a rule; nothing where it is not in the picture.
std::optional<double> height_of(const Canvas& canvas, const Rule& rule) {
  constexpr double kApart_px = 2.0;  // closer to zero it would be taken for zero
  const double y = canvas.at(0.0, rule.value).y;
  const bool inside = y >= 0.0 && y < canvas.height && std::abs(canvas.at(0.0, 0.0).y - y) > kApart_px;
  return inside ? std::optional(y) : std::nullopt;
}

void draw_rule(const Canvas& canvas, const Rule& rule) {
  const std::optional<double> y = height_of(canvas, rule);
  if (!y) return;
  add(canvas.area, "path",
      {{"class", std::string("rule ") + rule.look},
       {"d", fmt::format("M0 {}h{}", px(*y), px(canvas.width))}});
}

void name_rule(const Canvas& canvas, const Rule& rule) {
  const std::optional<double> y = height_of(canvas, rule);
  if (!y) return;
  const bool at_top = *y < 14.0;  // no line of text fits above it
  add(canvas.area, "text",
      {{"class", "over end"}, {"x", px(canvas.width - 4.0)}, {"y", px(at_top ? *y + 12.0 : *y - 4.0)}},
      rule.label);
}

/// Across the whole height, with its label beside it on the side that has room.
void draw_horizon(const Canvas& canvas, const Mark& mark) {
  const double x = canvas.at(mark.time_s, 0.0).x;
  if (!(x >= 0.0 && x <= canvas.width)) return;
  add(canvas.area, "path",
      {{"class", "rule horizon"}, {"d", fmt::format("M{} 0v{}", px(x), px(canvas.height))}});
  const bool left = x > 0.5 * canvas.width;
  add(canvas.area, "text",
      {{"class", left ? "over end" : "over"}, {"x", px(left ? x - 4.0 : x + 4.0)}, {"y", px(12.0)}},
      mark.label);
}

/// What the page's script needs to read values off the drawing.
void describe_to_script(const Canvas& canvas) {
  const char* scale = canvas.y.scale() == Axis::Scale::linear ? "linear"
                      : canvas.y.scale() == Axis::Scale::log  ? "log"
                                                              : "symlog";
  Node svg = canvas.svg;
  svg.append_attribute("data-scale").set_value(scale);
  svg.append_attribute("data-threshold").set_value(fmt::format("{}", canvas.y.threshold()).c_str());
  svg.append_attribute("data-y").set_value(fmt::format("{} {}", canvas.y.low(), canvas.y.high()).c_str());
  svg.append_attribute("data-x").set_value(fmt::format("{} {}", canvas.x.low(), canvas.x.high()).c_str());
}

std::string floor_note(const Axis& axis) {
  if (axis.scale() != Axis::Scale::log) return {};
  return fmt::format(" Zero, and what is below {}, is drawn at the bottom.", given(axis.threshold()));
}

}  // namespace

double Line::peak() const {
  double largest = 0.0;
  for (const double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  return largest;
}

Axis log_axis(const Plot& plot) {
  double high = 0.0;
  for (const Line& line : plot.lines) high = std::max(high, line.peak());
  const double floor = high > 0.0 ? std::clamp(0.1 * high, kLowestFloor, kFloor) : kFloor;
  for (const Rule& rule : plot.rules) high = std::max(high, rule.value);
  return Axis::log(floor, std::max(high, kLeastSpan * floor));
}

Axis signed_axis(const Plot& plot) {
  double low = 0.0;
  double high = 0.0;
  double smallest_peak = std::numeric_limits<double>::infinity();
  for (const Line& line : plot.lines) {
    if (line.peak() > 0.0) smallest_peak = std::min(smallest_peak, line.peak());
    for (const double value : line.values) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  const double largest_peak = std::max(high, -low);
  if (largest_peak > kFloor && largest_peak <= kDecadesNeeded * smallest_peak) {
    const double room = 0.06 * (high - low);
    return Axis::linear(low - room, high + room);
  }
  for (const Rule& rule : plot.rules) high = std::max(high, rule.value);
  return Axis::symlog(kFloor, std::min(low, -kLeastSpan * kFloor), std::max(high, kLeastSpan * kFloor));
}

void add_plot(Node parent, const Plot& plot, const Axis& y, const Legend& legend) {
  const std::string note = floor_note(y);
  Node figure = add(parent, "figure", {{"class", "plot"}});
  Node caption = add(figure, "figcaption");
  add(caption, "strong", {}, plot.title);
  say(caption, " " + finding(plot) + note);
  const Canvas canvas =
      add_canvas(figure, {plot.title, every_peak(plot) + note}, Axis::linear(0.0, plot.times_s.back()), y,
                 kPlotWidth_px, kPlotHeight_px, {kTimeTicks, "time, s"}, {kValueTicks, plot.quantity});
  describe_to_script(canvas);
  for (const Rule& rule : plot.rules) draw_rule(canvas, rule);
  if (plot.horizon) draw_horizon(canvas, *plot.horizon);
  if (!plot.expected.empty()) {
    add(canvas.area, "path", {{"class", "truth"}, {"d", path_data(curve(canvas, plot, plot.expected))}});
  }
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    draw_line(canvas, plot, i, legend.style(plot.lines[i].label));
  }
  for (const Rule& rule : plot.rules) name_rule(canvas, rule);
}

}  // namespace carom::page
