#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tests/benchmarks/convergence.h"

// Measures by which power of the step each evolver's error falls, and writes it as JSON.
// Usage: carom-orders FOLDER_OF_SCENES

namespace {

using namespace carom;
using Json = nlohmann::ordered_json;

Json json_of(const StepError& error) {
  return {{"step_s", error.step_s}, {"error_m", error.error_m}, {"rounding_m", error.rounding_m}};
}

Json row_of(const Convergence& row) {
  Json json = {{"scene", row.scene}, {"evolver", row.evolver}, {"refuses", row.refuses}};
  if (!row.refuses.empty()) return json;
  json["claimed"] = row.claimed ? Json(*row.claimed) : Json(nullptr);
  json["order"] = row.order ? Json(*row.order) : Json(nullptr);
  json["r_squared"] = row.order ? Json(row.r_squared) : Json(nullptr);
  json["errors"] = Json::array();
  for (const StepError& error : row.errors) json["errors"].push_back(json_of(error));
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "Usage: carom-orders FOLDER_OF_SCENES\n");
    return 2;
  }
  try {
    Json all = Json::array();
    for (const Convergence& row : measure_convergence(argv[1])) all.push_back(row_of(row));
    fmt::print("{}\n", all.dump(2));
  } catch (const std::exception& error) {
    fmt::print(stderr, "carom-orders: {}\n", error.what());
    return 3;
  }
  return 0;
}
