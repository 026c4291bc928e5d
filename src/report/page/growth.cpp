#include "report/page/growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/page/canvas.h"
#include "report/page/style.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

using Json = nlohmann::json;

constexpr double kGrowthWidth_px = 330.0;
constexpr double kGrowthHeight_px = 220.0;
constexpr int kBallTicks = 4;
constexpr int kWorkTicks = 10;

bool equal_balls(const Json& growth) {
  return growth.at("size_ratio") == 1.0;
}

/// "space, radii 1:1000"
std::string gas_of(const Json& growth) {
  return fmt::format(
      "{}, {}", growth.at("dimension") == 2 ? "plane" : "space",
      equal_balls(growth) ? "equal balls" : "radii 1:" + given(growth.at("size_ratio").get<double>()));
}

/// The numbers of balls for which anything was counted, ascending.
std::vector<double> ball_counts(const Json& growths) {
  std::vector<double> counts;
  for (const Json& growth : growths) {
    for (const Json& work : growth.at("work")) counts.push_back(work.at("balls"));
  }
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  return counts;
}

void add_work(Node row, const Json& growth, double balls) {
  for (const Json& work : growth.at("work")) {
    if (work.at("balls") != balls) continue;
    add_number(row,
               number(work.at("pair_tests").get<double>()) + " / " + number(work.at("total").get<double>()));
    return;
  }
  add_number(row, "–");
}

void add_growth_table(Node parent, const Json& growths) {
  const std::vector<double> counts = ball_counts(growths);
  std::vector<Heading> headings = {
      {"balls", ""}, {"broad phase", ""}, {"x of the tests", "number"}, {"x of the work", "number"}};
  for (const double balls : counts) headings.push_back({"n = " + given(balls), "number"});
  Node body =
      add_table(parent, "", "Tests of pairs / all work in a step, and x in n^x fitted to each", headings);
  for (const Json& growth : growths) {
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, gas_of(growth));
    add(row, "td", {}, growth.at("broad_phase").get<std::string>());
    add_number(row, fmt::format("{:.2f}", growth.at("exponent_of_pair_tests").get<double>()));
    add_number(row, fmt::format("{:.2f}", growth.at("exponent_of_total").get<double>()));
    for (const double balls : counts) add_work(row, growth, balls);
  }
}

/// A colour and a shape of its own for each line of a plot.
LineStyle style_of(std::size_t line) {
  return {fmt::format("c{}", line), {}, line};
}

void add_key(Node parent, const std::vector<Json>& growths) {
  Node key = add(parent, "ul", {{"class", "key"}});
  for (std::size_t i = 0; i < growths.size(); ++i) {
    Node item = add(key, "li");
    Node svg = add(
        item, "svg",
        {{"class", "swatch " + style_of(i).colour_class}, {"viewBox", "0 0 34 12"}, {"aria-hidden", "true"}});
    add(svg, "path", {{"class", "line"}, {"d", "M1 6h32"}});
    add(svg, "path", {{"class", "marker"}, {"d", style_of(i).marker({17.0, 6.0})}});
    say(item, fmt::format(" {}, n^{:.2f}", growths[i].at("broad_phase").get<std::string>(),
                          growths[i].at("exponent_of_total").get<double>()));
  }
}

/// The work as (log₁₀ n, log₁₀ work).
Polyline logarithms(const Json& growth) {
  Polyline line;
  for (const Json& work : growth.at("work")) {
    line.push_back({std::log10(work.at("balls").get<double>()), std::log10(work.at("total").get<double>())});
  }
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

void add_growth_plot(Node parent, const std::vector<Json>& growths) {
  const std::string title = "Work of a step, " + gas_of(growths.front());
  std::vector<Polyline> lines;
  lines.reserve(growths.size());
  for (const Json& growth : growths) lines.push_back(logarithms(growth));
  Node figure = add(parent, "figure");
  add(add(figure, "figcaption"), "strong", {}, title + ".");
  add_key(figure, growths);
  const Canvas canvas =
      add_canvas(figure, {title, "The numbers are in the table."}, axis_over(lines, &Point::x),
                 axis_over(lines, &Point::y), kGrowthWidth_px, kGrowthHeight_px,
                 {kBallTicks, "balls, as a power of ten"}, {kWorkTicks, "operations, as a power of ten"});
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

/// A plot for each gas of equal balls.
void add_plots_of_equal_balls(Node parent, const Json& growths) {
  Node row = add(parent, "div", {{"class", "plots"}});
  std::map<std::string, std::vector<Json>> by_gas;
  for (const Json& growth : growths) by_gas[gas_of(growth)].push_back(growth);
  for (const auto& [gas, lines] : by_gas) add_growth_plot(row, lines);
}

}  // namespace

void add_growth(Node parent, const Json& broad_phases) {
  Json equal = Json::array();
  Json mixed = Json::array();
  for (const Json& growth : broad_phases.at("growth"))
    (equal_balls(growth) ? equal : mixed).push_back(growth);
  add(parent, "h3", {}, "Who may meet whom");
  add(parent, "p", {{"class", "about"}},
      fmt::format(
          "Before balls can collide, an engine has to find out who is near whom: that is its broad phase. "
          "Looking at all pairs costs n(n−1)/2 tests, so twice the balls are four times the work. Space "
          "sorted into cells or into a tree leaves a test for about each ball that is really near: twice "
          "the balls, twice the work. A sweep along one axis is in between. Balls fill {} % of the box.",
          number(100.0 * broad_phases.at("packing").get<double>())));
  add_growth_table(parent, equal);
  add_plots_of_equal_balls(parent, equal);
  if (!mixed.empty()) add_growth_table(add_details(parent, "The same for balls of different sizes"), mixed);
  add(parent, "p", {{"class", "note"}},
      "Work: tests of pairs, comparisons while sorting, balls put into place and cells or nodes looked at. "
      "In "
      "the plots a step is a factor of ten on both axes, so the slope of a line is its x.");
}

}  // namespace carom::page
