#include "report/page/catches.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "core/files.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

using Json = nlohmann::json;

void add_row(Node body, const Json& row) {
  Node line = add(body, "tr");
  const std::string engine = row.at("engine");
  add(line, "th", {{"scope", "row"}}, engine.substr(engine.find('@') + 1));
  add(line, "td", {}, sentence(row.at("broken").get<std::string>()));
  add(line, "td", {}, row.at("caught").get<bool>() ? row.at("scene").get<std::string>() : "not caught");
  add(line, "td", {}, row.at("metric").get<std::string>());
  add_number(line, number(row.at("value").get<double>()));
  add_number(line, number(row.at("limit").get<double>()));
}

void add_defects(Node section, const Json& catches) {
  add(section, "p", {{"class", "about"}},
      "A gate that nothing can violate is worth nothing. These engines are broken on purpose: one plain "
      "engine, "
      "right in all that it does, and each time one step of it done wrong. Each must be caught by the scene "
      "and "
      "the metric whose business it is, by at least ten times the limit; the right one passes every gate. "
      "Run "
      "by the tests, not by the run that made this page.");
  Node body = add_table(section, "measured", "What is broken, and the gate that catches it",
                        {{"engine", ""},
                         {"what is broken", ""},
                         {"caught in", ""},
                         {"by", ""},
                         {"value", "number"},
                         {"limit", "number"}});
  for (const Json& row : catches) add_row(body, row);
}

}  // namespace

void add_catches(Node parent, const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return;
  Node section = add(parent, "section", {{"id", "catches"}, {"aria-labelledby", "catches-title"}});
  add(section, "h2", {{"id", "catches-title"}}, "What the gates catch");
  try {
    add_defects(section, Json::parse(read_file(file)).at("catches"));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: {}; tests/benchmarks/run writes it anew", file.string(), error.what()));
  }
}

}  // namespace carom::page
