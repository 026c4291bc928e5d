#include "report/page/measured.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "core/files.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

using Json = nlohmann::json;

/// "0.684 ± 0.003", with its unit.
std::string with_uncertainty(double value, double uncertainty, const std::string& unit) {
  std::string text = given(value);
  if (uncertainty > 0.0) text += " ± " + number(uncertainty);
  return unit.empty() ? text : text + " " + unit;
}

/// What the publication is called by: "Y. C. Chung, J. Y. Ooi: Title. Journal (2011)", and its DOI to click
/// on.
void add_source(Node parent, const Json& publication) {
  Node line = add(parent, "p", {{"class", "note"}});
  std::string text = fmt::format("{}: {}.", publication.at("authors").get<std::string>(),
                                 publication.at("title").get<std::string>());
  if (const std::string journal = publication.at("journal"); !journal.empty()) text += " " + journal;
  if (const int year = publication.at("year"); year > 0) text += fmt::format(" ({})", year);
  say(line, text + ". ");
  if (const std::string doi = publication.at("doi"); !doi.empty()) {
    add(line, "a", {{"href", "https://doi.org/" + doi}}, "doi:" + doi);
    say(line, ". ");
  }
  say(line, publication.at("note").get<std::string>());
}

void add_verdict(Node row, const Json& value) {
  const bool published = !value.at("published").is_null();
  const bool meets = value.at("meets");
  const Verdict verdict = meets ? Verdict::pass : published ? Verdict::fail : Verdict::unsupported;
  Node cell = add(row, "td");
  Node words = add(cell, "span", {{"class", "verdict " + std::string(name_of(verdict))}});
  add(words, "span", {{"class", "mark"}, {"aria-hidden", "true"}}, std::string(glyph_of(verdict)));
  say(words, meets ? " within" : published ? " outside" : " cannot");
  if (const std::string why = value.at("why"); !why.empty()) {
    add(cell, "span", {{"class", "reason"}}, " " + why);
  }
}

void add_values(Node parent, const Json& publication) {
  Node body = add_table(
      parent, "measured", publication.at("title").get<std::string>(),
      {{"quantity", ""}, {"published", "number"}, {"uncertainty is", ""}, {"Carom", "number"}, {"", ""}});
  for (const Json& value : publication.at("values")) {
    const std::string unit = value.at("unit");
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, value.at("name").get<std::string>());
    const Json& published = value.at("published");
    add_number(row, published.is_null() ? number(std::nullopt)
                                        : with_uncertainty(published, value.at("uncertainty"), unit));
    add(row, "td", {}, value.at("uncertainty_from").get<std::string>());
    const double measured = value.at("measured");
    const double uncertainty = value.at("measured_uncertainty");
    // More digits than the publication has would say nothing.
    add_number(row, with_uncertainty(std::stod(fmt::format("{:.5g}", measured)), uncertainty, unit));
    add_verdict(row, value);
  }
}

}  // namespace

void add_measured(Node parent, const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return;
  Node section = add(parent, "section", {{"id", "measured"}, {"aria-labelledby", "measured-title"}});
  add(section, "h2", {{"id", "measured-title"}}, "Against published measurements");
  add(section, "p", {{"class", "about"}},
      "What others have measured or published, measured anew in Carom: each number comes from runs of the "
      "engine (tests/benchmarks/run), none from a formula. Nothing is tuned to fit: where a rigid impulse "
      "law "
      "cannot give a measured value, or is outside its uncertainty, the row says so.");
  try {
    for (const Json& publication : Json::parse(read_file(file))) {
      add_values(section, publication);
      add_source(section, publication);
    }
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: {}; tests/benchmarks/run writes it anew", file.string(), error.what()));
  }
}

}  // namespace carom::page
