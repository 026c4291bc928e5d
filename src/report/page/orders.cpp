#include "report/page/orders.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "core/files.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

using Json = nlohmann::json;

/// The error and the step that it is of: "0.0983 m at 0.0156 s".
void add_error(Node row, const Json& error) {
  add_number(row, fmt::format("{} m at {} s", number(error.at("error_m").get<double>()),
                              number(error.at("step_s").get<double>())));
}

/// What it comes to, in the five columns after scene and evolver.
void add_result(Node row, const Json& result) {
  if (const std::string refuses = result.at("refuses"); !refuses.empty()) {
    add(row, "td", {{"colspan", "5"}, {"class", "reason"}}, "does not take it: " + refuses);
    return;
  }
  const Json& claimed = result.at("claimed");
  add_number(row, claimed.is_null() ? "exact" : fmt::format("{}", claimed.get<int>()));
  const Json& order = result.at("order");
  add_number(row, order.is_null() ? "rounding" : fmt::format("{:.3f}", order.get<double>()));
  const Json& r_squared = result.at("r_squared");
  add_number(row, r_squared.is_null() ? "–" : fmt::format("{:.5f}", r_squared.get<double>()));
  const Json& errors = result.at("errors");
  add_error(row, errors.at(0));
  add_error(row, errors.at(errors.size() - 1));
}

InputError useless(const std::filesystem::path& file, const char* why) {
  return InputError(fmt::format("{}: {}; tests/benchmarks/run writes it anew", file.string(), why));
}

void add_orders_table(Node parent, const Json& results) {
  Node body = add_table(parent, "", "p in error ~ stepᵖ, claimed and measured",
                        {{"scene", ""},
                         {"evolver", ""},
                         {"p claimed", "number"},
                         {"p measured", "number"},
                         {"R²", "number"},
                         {"error at the longest step", "number"},
                         {"at the shortest", "number"}});
  for (const Json& result : results) {
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, result.at("scene").get<std::string>());
    add(row, "td", {}, result.at("evolver").get<std::string>());
    add_result(row, result);
  }
}

}  // namespace

void add_orders(Node parent, const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return;
  Node section = add(parent, "section", {{"id", "orders"}, {"aria-labelledby", "orders-title"}});
  add(section, "h2", {{"id", "orders-title"}}, "What a shorter step buys");
  add(section, "p", {{"class", "about"}},
      "Halve the step, and an evolver of order 1 is half as wrong, one of order 2 a quarter as wrong; an "
      "exact "
      "one stays as right as rounding lets it be. Each scene is run with a step halved five times, and the "
      "last place of its balls held against the closed form (tests/benchmarks/run). The order measured is "
      "the "
      "slope of the straight line of log error over log step by least squares; R², near 1, says how straight "
      "the errors lie on it.");
  try {
    const Json results = Json::parse(read_file(file));
    if (!results.is_array() || results.empty()) throw useless(file, "not a list of orders");
    add_orders_table(section, results);
  } catch (const Json::exception& error) {
    throw useless(file, error.what());
  }
  add(section, "p", {{"class", "note"}},
      "Rounding: every error is within what rounding alone may come to, and there is no order to fit; it "
      "grows "
      "with the number of steps. When an impact comes within a step is chance, so an error is the mean over "
      "64 "
      "steps between the one that is named and half of it.");
}

}  // namespace carom::page
