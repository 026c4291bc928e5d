#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "carom/carom_engine.h"
#include "core/error.h"
#include "core/files.h"
#include "reference/exact/exact.h"
#include "reference/measured/fluid.h"
#include "reference/measured/measure.h"

// Carom, its evolvers and the exact solver against what others have published, in runs of their own.

namespace carom::measured {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::string kFolder = CAROM_SOURCE_DIR "/reference/measured";

/// Whoever can run an impact; a fluid of thousands is for the first alone.
std::map<std::string, Runner> runners() {
  static const auto event = make_carom_engine("carom:event");
  static const auto toi = make_carom_engine("carom:toi");
  static const auto exact = make_exact_truth();
  return {{"carom:event", runner_of(*event)}, {"carom:toi", runner_of(*toi)}, {"exact", runner_of(*exact)}};
}

bool is_fluid(const Value& value) {
  return std::holds_alternative<Fluid>(value.experiment);
}

/// Meets the publication, or is where the data says that a right law is.
void expect_published(const Value& value, const Measurement& measurement) {
  if (!value.published) {
    EXPECT_FALSE(value.cannot.empty());
    return;
  }
  EXPECT_EQ(meets(value, measurement), value.beyond.empty())
      << measurement.value << " ± " << measurement.uncertainty << ", published " << *value.published << " ± "
      << value.uncertainty;
  // Nothing that is said to be a little outside may be far outside: none is off by more than 1.5 %.
  if (!value.beyond.empty()) {
    EXPECT_NEAR(measurement.value / *value.published, 1.0, 0.015);
  }
}

TEST(Measured, Impacts_AreWhatWasPublished_InEveryEngine) {
  for (const auto& [name, run] : runners()) {
    for (const Publication& publication : read_publications(kFolder)) {
      for (const Value& value : publication.values) {
        if (is_fluid(value)) continue;
        SCOPED_TRACE(testing::Message() << name << ": " << publication.key << ": " << value.name);
        expect_published(value, measure(value, run));
      }
    }
  }
}

// The rigid law itself, at every angle: sliding where tan θ > (7/2) μ (1 + e)/(1 + β0), else sticking with
// β0.
TEST(Measured, ObliqueImpacts_FollowTheRigidLaw_AtAllAngles) {
  constexpr double kSpeed = 3.9;
  for (const auto& [name, run] : runners()) {
    for (int angle_deg = 5; angle_deg <= 85; angle_deg += 5) {
      SCOPED_TRACE(testing::Message() << name << " at " << angle_deg << "°");
      const double angle = angle_deg * std::numbers::pi / 180.0;
      const Impact impact{
          0.0025, kSpeed * std::cos(angle), kSpeed * std::sin(angle), 0.0, 0.98, 0.092, 0.44, Partner::wall};
      const double friction = impact.friction * (1.0 + impact.restitution) * impact.normal_mps;
      const double sticking = 2.0 / 7.0 * (1.0 + impact.tangential_restitution) * impact.tangential_mps;
      const double loss = std::min(friction, sticking);
      const Value ratio{"", Quantity::tangential_ratio, "", {}, 0.0, "", "", "", impact};
      const Value spin{"", Quantity::spin, "", {}, 0.0, "", "", "", impact};
      // A handful of roundings.
      EXPECT_NEAR(measure(ratio, run).value, 1.0 - loss / impact.tangential_mps, 1e-13);
      EXPECT_NEAR(measure(spin, run).value, -2.5 * loss / impact.radius_m, 1e-10);
    }
  }
}

TEST(Measured, HardSphereFluid_HasThePublishedPressureAndCollisionRate) {
  const Runner run = runners().at("carom:event");
  std::map<double, Measurement> compressibilities;  // one run for all values at a density
  for (const Publication& publication : read_publications(kFolder)) {
    for (const Value& value : publication.values) {
      if (!is_fluid(value)) continue;
      SCOPED_TRACE(testing::Message() << publication.key << ": " << value.name);
      const auto& fluid = std::get<Fluid>(value.experiment);
      if (!compressibilities.contains(fluid.density)) {
        compressibilities[fluid.density] = compressibility(fluid, run);
      }
      const Measurement z = compressibilities.at(fluid.density);
      expect_published(value, value.quantity == Quantity::compressibility ? z : mean_free_time(z));
      // A measurement that allows itself more than 2 % would meet anything.
      EXPECT_LT(z.uncertainty / z.value, 0.02);
    }
  }
}

// An engine with a wrong law must not meet what was measured.
TEST(Measured, WrongFriction_IsOutside) {
  Publication paper = read_publication(kFolder + "/foerster-1994.toml");
  const Runner run = runners().at("carom:event");
  for (Value& value : paper.values) {
    auto& impact = std::get<Impact>(value.experiment);
    impact.friction *= 1.05;
    impact.restitution *= 0.98;
    impact.tangential_restitution *= 0.95;
    EXPECT_FALSE(meets(value, measure(value, run))) << value.name;
  }
}

// What the page shows is what Carom does now, not what it did once.
TEST(Measured, PagesFile_IsUpToDate) {
  const auto shown = nlohmann::json::parse(read_file(CAROM_SOURCE_DIR "/reports/measured/published.json"));
  const std::vector<Publication> publications = read_publications(kFolder);
  ASSERT_EQ(shown.size(), publications.size());
  const Runner run = runners().at("carom:event");
  for (std::size_t i = 0; i < publications.size(); ++i) {
    const auto& values = shown.at(i).at("values");
    EXPECT_EQ(shown.at(i).at("doi"), publications[i].doi);
    ASSERT_EQ(values.size(), publications[i].values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      const Value& value = publications[i].values[k];
      EXPECT_EQ(values.at(k).at("name"), value.name);
      if (value.published) {
        EXPECT_EQ(values.at(k).at("published"), *value.published);
      }
      if (!is_fluid(value)) {
        const double measured = measure(value, run).value;
        EXPECT_NEAR(values.at(k).at("measured").get<double>(), measured,
                    1e-12 * std::max(1.0, std::abs(measured)));
      }
    }
  }
}

TEST(Measured, EveryPublication_NamesItsSource_OrSaysWhyNot) {
  for (const Publication& publication : read_publications(kFolder)) {
    EXPECT_FALSE(publication.note.empty());
    EXPECT_TRUE(publication.doi.starts_with("10.") || publication.authors == "not known") << publication.key;
    EXPECT_FALSE(publication.values.empty());
  }
}

TEST(Measured, BadData_IsNamedWithItsPlace) {
  const std::string file = testing::TempDir() + "bad-publication.toml";
  const std::string head = "title = \"t\"\nauthors = \"a\"\nnote = \"n\"\n[[value]]\nname = \"v\"\n";
  write_file(file, head + "quantity = \"colour\"\n");
  EXPECT_THAT([&] { read_publication(file); },
              ThrowsMessage<InputError>(HasSubstr(":6:12: value[0].quantity: found 'colour', allowed: ")));
  write_file(file, head + "quantity = \"beta\"\n");
  EXPECT_THAT([&] { read_publication(file); },
              ThrowsMessage<InputError>(HasSubstr("published: is missing, allowed: a number, or cannot")));
}

}  // namespace
}  // namespace carom::measured
