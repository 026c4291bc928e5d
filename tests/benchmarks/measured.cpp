#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "carom/carom_engine.h"
#include "reference/measured/measure.h"

// Measures in Carom what was published of impacts and of fluids, and writes both as JSON.
// Usage: carom-measured FOLDER_OF_PUBLICATIONS

namespace {

using namespace carom;
using namespace carom::measured;
using Json = nlohmann::ordered_json;

Json row_of(const Value& value, Laboratory& laboratory) {
  const Measurement measurement = laboratory.measure(value);
  Json row = {{"name", value.name},
              {"unit", value.unit},
              {"published", value.published ? Json(*value.published) : Json(nullptr)},
              {"uncertainty", value.published ? Json(value.uncertainty) : Json(nullptr)},
              {"uncertainty_from", value.uncertainty_from},
              {"measured", measurement.value},
              {"measured_uncertainty", measurement.uncertainty},
              {"meets", meets(value, measurement)},
              {"why", value.published ? value.beyond : value.cannot}};
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "Usage: carom-measured FOLDER_OF_PUBLICATIONS\n");
    return 2;
  }
  try {
    const auto carom = make_carom_engine("carom");
    Laboratory laboratory(runner_of(*carom));
    Json all = Json::array();
    for (const Publication& publication : read_publications(argv[1])) {
      Json json = {{"key", publication.key},         {"title", publication.title},
                   {"authors", publication.authors}, {"journal", publication.journal},
                   {"year", publication.year},       {"doi", publication.doi},
                   {"note", publication.note},       {"values", Json::array()}};
      for (const Value& value : publication.values) json["values"].push_back(row_of(value, laboratory));
      all.push_back(std::move(json));
    }
    fmt::print("{}\n", all.dump(2));
  } catch (const std::exception& error) {
    fmt::print(stderr, "carom-measured: {}\n", error.what());
    return 3;
  }
  return 0;
}
