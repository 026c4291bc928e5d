#include "reference/measured/publication.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/files.h"
#include "reference/measured/relaxation.h"
#include "scenario/read.h"

namespace carom::measured {

namespace {

constexpr Range kAcute{0.0, 90.0, false, true, "degrees in [0, 90)"};
constexpr std::array<std::string_view, 4> kPartners = {"wall", "equal", "mirrored", "heavy"};
/// In the order of the enumeration.
constexpr std::array<std::string_view, 11> kQuantities = {
    "restitution", "tangential-ratio", "tangential",      "spin",           "beta",           "scaled-slip",
    "scaled-spin", "friction",         "compressibility", "mean-free-time", "fourth-cumulant"};

template <std::size_t count>
std::vector<std::string_view> listed(const std::array<std::string_view, count>& words) {
  return {words.begin(), words.end()};
}

Impact read_impact(Reader reader) {
  Impact impact;
  impact.radius_m = reader.required("radius", reader.number("radius", kPositive));
  if (const auto angle_deg = reader.number("angle", kAcute)) {
    const double angle_rad = *angle_deg * std::numbers::pi / 180.0;
    const double speed_mps = reader.required("speed", reader.number("speed", kPositive));
    impact.normal_mps = speed_mps * std::cos(angle_rad);
    impact.tangential_mps = speed_mps * std::sin(angle_rad);
  } else {
    impact.normal_mps = reader.required("normal", reader.number("normal", kPositive));
    impact.tangential_mps = reader.number_or("tangential", kFinite, 0.0);
  }
  impact.spin_radps = reader.number_or("spin", kFinite, 0.0);
  impact.restitution = reader.required("restitution", reader.number("restitution", kUnitInterval));
  impact.friction = reader.number_or("friction", kNotNegative, 0.0);
  impact.tangential_restitution = reader.number_or("tangential_restitution", kMinusOneToOne, 0.0);
  impact.partner = static_cast<Partner>(reader.word("partner", listed(kPartners)).value_or(0));
  reader.finish();
  return impact;
}

constexpr Range kCollisions{0.0, kMostCollisions, true, false, "a number in (0, 6]"};

Fluid read_fluid(Reader reader, Quantity quantity) {
  Fluid fluid;
  fluid.density = reader.required("density", reader.number("density", kPositive));
  fluid.count = static_cast<std::size_t>(reader.required("count", reader.integer("count", 100, 1'000'000)));
  if (quantity == Quantity::fourth_cumulant) {
    fluid.collisions = reader.required("collisions", reader.number("collisions", kCollisions));
  }
  reader.finish();
  return fluid;
}

Value read_value(Reader& reader) {
  Value value;
  value.name = reader.required("name", reader.text("name"));
  value.quantity =
      static_cast<Quantity>(reader.required("quantity", reader.word("quantity", listed(kQuantities))));
  value.unit = reader.text("unit").value_or("");
  value.published = reader.number("published", kFinite);
  value.cannot = reader.text("cannot").value_or("");
  value.beyond = reader.text("beyond").value_or("");
  if (value.published) {
    value.uncertainty = reader.required("uncertainty", reader.number("uncertainty", kPositive));
    value.uncertainty_from = reader.required("uncertainty_from", reader.text("uncertainty_from"));
  } else if (value.cannot.empty()) {
    reader.fail("published", "is missing, allowed: a number, or cannot = \"why there is none\"");
  }
  const bool of_fluid = value.quantity >= Quantity::compressibility;
  const char* key = of_fluid ? "fluid" : "impact";
  auto experiment = reader.required(key, reader.table(key));
  if (of_fluid) {
    value.experiment = read_fluid(std::move(experiment), value.quantity);
  } else {
    value.experiment = read_impact(std::move(experiment));
  }
  reader.finish();
  return value;
}

}  // namespace

Publication read_publication(const std::filesystem::path& file) {
  Publication publication;
  publication.key = file.stem().string();
  try {
    const toml::table table = toml::parse(read_file(file), file.string());
    const std::string name = file.string();
    Reader root(table, name, "");
    publication.title = root.required("title", root.text("title"));
    publication.authors = root.required("authors", root.text("authors"));
    publication.note = root.required("note", root.text("note"));
    publication.journal = root.text("journal").value_or("");
    publication.year = static_cast<int>(root.integer("year", 1600, 9999).value_or(0));
    publication.doi = root.text("doi").value_or("");
    for (Reader& reader : root.tables("value")) publication.values.push_back(read_value(reader));
    root.finish();
  } catch (const toml::parse_error& error) {
    const auto& place = error.source().begin;
    throw InputError(
        fmt::format("{}:{}:{}: not TOML: {}", file.string(), place.line, place.column, error.description()));
  }
  return publication;
}

std::vector<Publication> read_publications(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<Publication> publications;
  publications.reserve(files.size());
  for (const auto& file : files) publications.push_back(read_publication(file));
  return publications;
}

}  // namespace carom::measured
