#include "report/page/speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "report/page/log_plot.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

using Json = nlohmann::json;

/// One quantity in several rounds.
double median(const Json& samples) {
  return samples.at("median").get<double>();
}

/// "123", or "123 (118 … 131)" with the lowest and the highest.
std::string with_spread(const Json& samples) {
  return fmt::format("{} ({} … {})", number(median(samples)), number(samples.at("low").get<double>()),
                     number(samples.at("high").get<double>()));
}

std::string with_unit(const std::string& value, const Json& row) {
  const std::string unit = row.at("unit");
  return unit.empty() ? value : value + " " + unit;
}

/// "at least 100", or "at most 200 bytes"; how fast a thing is was not asked where it was to run at all
std::string asked_for(const Json& goal) {
  const bool at_least = goal.contains("at_least");
  const double limit = goal.at(at_least ? "at_least" : "at_most");
  if (at_least && limit == 0.0) return "that it runs";
  return with_unit(fmt::format("{} {}", at_least ? "at least" : "at most", given(limit)), goal);
}

void add_goals(Node parent, const Json& goals) {
  Node body = add_table(parent, "", "What was to be reached, and what was",
                        {{"what", ""}, {"asked for", "number"}, {"measured", "number"}, {"reached", ""}});
  for (const Json& goal : goals) {
    Node row = add(body, "tr");
    add(row, "td", {}, goal.at("what").get<std::string>());
    add_number(row, asked_for(goal));
    add_number(row, with_spread(goal.at("measured")));
    const bool met = goal.at("met");
    add(row, "td", {{"class", met ? "holds" : "broken"}}, met ? "✓ yes" : "✗ no");
  }
}

/// The costs of one layout of balls, in the order of the file.
using Costs = std::vector<const Json*>;

/// The costs by layout, layouts and costs in the order of the file.
std::vector<std::pair<std::string, Costs>> by_layout(const Json& costs) {
  std::vector<std::pair<std::string, Costs>> groups;
  for (const Json& cost : costs) {
    const std::string layout = cost.at("layout");
    const auto same = [&layout](const auto& group) { return group.first == layout; };
    auto group = std::find_if(groups.begin(), groups.end(), same);
    if (group == groups.end()) group = groups.insert(groups.end(), {layout, {}});
    group->second.push_back(&cost);
  }
  return groups;
}

/// The values of a key, each once, in the order in which they come.
template <class Value>
std::vector<Value> each(const Costs& costs, const char* key) {
  std::vector<Value> values;
  for (const Json* cost : costs) {
    const auto value = cost->at(key).get<Value>();
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

const Json* find(const Costs& costs, const std::string& engine, double balls) {
  const auto found = std::find_if(costs.begin(), costs.end(), [&](const Json* cost) {
    return cost->at("engine") == engine && cost->at("balls") == balls;
  });
  return found == costs.end() ? nullptr : *found;
}

void add_costs_table(Node parent, const std::string& caption, const Costs& costs) {
  std::vector<double> balls = each<double>(costs, "balls");
  std::sort(balls.begin(), balls.end());
  std::vector<Heading> headings = {{"engine", ""}};
  for (const double n : balls) headings.push_back({given(n) + " balls", "number"});
  Node body = add_table(parent, "", caption, headings);
  for (const std::string& engine : each<std::string>(costs, "engine")) {
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, engine);
    for (const double n : balls) {
      const Json* cost = find(costs, engine, n);
      add_number(row, cost == nullptr ? "–" : with_spread(cost->at("ns")));
    }
  }
}

void add_costs_plot(Node parent, const std::string& title, const Costs& costs) {
  std::vector<PowerLine> lines;
  for (const std::string& engine : each<std::string>(costs, "engine")) {
    PowerLine line{engine, {}};
    for (const Json* cost : costs) {
      if (cost->at("engine") == engine) line.points.push_back({cost->at("balls"), median(cost->at("ns"))});
    }
    lines.push_back(std::move(line));
  }
  add_log_plot(parent, title, "ns", lines);
}

void add_goals_and_growth(Node section, const Json& speed) {
  const Json& machine = speed.at("machine");
  add(section, "p", {{"class", "about"}},
      fmt::format(
          "Measured by the benchmark (tests/benchmarks/run), not by the run that made this page, on {} with "
          "{} cores ({}, build {}). Every engine advances the same balls, in its faithful profile, one after "
          "the other in each of up to {} rounds, and nothing is recorded. What counts is the CPU time of one "
          "thread, and real time where two share the balls. A value is the median of the rounds, with the "
          "lowest and the highest; a ratio is taken round by round, so that what else the machine does meets "
          "both.",
          machine.at("cpu").get<std::string>(), machine.at("cores").get<int>(),
          machine.at("compiler").get<std::string>(), machine.at("build").get<std::string>(),
          speed.at("rounds").get<int>()));
  add_goals(section, speed.at("goals"));
  const auto groups = by_layout(speed.at("costs"));
  const auto caption = [](const auto& group) {
    return fmt::format("CPU time of one {}, ns: {}",
                       group.second.front()->at("per").template get<std::string>(), group.first);
  };
  Node plots = add(section, "div", {{"class", "plots"}});
  for (const auto& group : groups) add_costs_plot(plots, caption(group), group.second);
  Node details = add_details(section, "All times");
  for (const auto& group : groups) add_costs_table(details, caption(group), group.second);
  add(section, "p", {{"class", "note"}},
      "Balls of radius 0.5 m and 1 m/s (root mean square), elastic, in closed walls, at a packing of 0.1 "
      "unless it "
      "says otherwise; steps of 1/240 s. In the plots a line that is level costs the same for each ball "
      "however many "
      "there are.");
}

}  // namespace

void add_speed(Node parent, const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return;
  Node section = add(parent, "section", {{"id", "speed"}, {"aria-labelledby", "speed-title"}});
  add(section, "h2", {{"id", "speed-title"}}, "How fast");
  try {
    add_goals_and_growth(section, Json::parse(read_file(file)));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: {}; tests/benchmarks/run writes it anew", file.string(), error.what()));
  }
}

}  // namespace carom::page
