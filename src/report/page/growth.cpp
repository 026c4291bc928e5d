#include "report/page/growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "report/page/log_plot.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

using Json = nlohmann::json;

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

void add_growth_plot(Node parent, const std::vector<Json>& growths) {
  std::vector<PowerLine> lines;
  for (const Json& growth : growths) {
    PowerLine line{fmt::format("{}, n^{:.2f}", growth.at("broad_phase").get<std::string>(),
                               growth.at("exponent_of_total").get<double>()),
                   {}};
    for (const Json& work : growth.at("work")) {
      line.points.push_back({work.at("balls").get<double>(), work.at("total").get<double>()});
    }
    lines.push_back(std::move(line));
  }
  add_log_plot(parent, "Work of a step, " + gas_of(growths.front()), "operations", lines);
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
