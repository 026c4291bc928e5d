#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "carom/carom_engine.h"
#include "core/error.h"
#include "core/files.h"
#include "reference/exact/exact.h"
#include "reference/measured/fluid.h"
#include "reference/measured/measure.h"
#include "reference/measured/relaxation.h"
#include "tests/support/folder.h"

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

/// |Σ e^{ik·x}|/N with k along the diagonal of the cubic lattice, where walls make no layers: 1 on the
/// lattice.
double order_of(std::span<const BallState> states, double pitch_m) {
  std::complex<double> sum = 0.0;
  for (const BallState& state : states) {
    sum += std::polar(1.0, 2.0 * std::numbers::pi / pitch_m * state.position.sum());
  }
  return std::abs(sum) / static_cast<double>(states.size());
}

/// The experiment in a smaller box and for a shorter time: seconds, and a larger uncertainty that it states.
/// The page's file is of the whole one. Each is held to twice its stated uncertainty, four standard errors:
/// whatever changes how an engine rounds draws the chance anew, and two are exceeded once in twenty times.
Measurement doubled(const Measurement& measurement) {
  return {measurement.value, 2.0 * measurement.uncertainty};
}

class MeasuredFluid : public testing::TestWithParam<double> {};

TEST_P(MeasuredFluid, HasThePublishedPressureAndCollisionRate_AndHasForgottenItsLattice) {
  const double density = GetParam();
  const int edge = density < 0.8 ? 10 : 15;
  const auto count = static_cast<std::size_t>(edge * edge * edge);
  std::vector<double> orders;
  const Runner run = runners().at("carom:event");
  const FluidMeasurement measured = measure_fluid(
      {density, count, 0.0, density < 0.8 ? 20 : 6}, [&](const Scenario& scene, const Watch& watch) {
        run(scene, [&](std::span<const BallState> states, const Tally& tally) {
          orders.push_back(order_of(states, scene.box->max.x() / edge));
          watch(states, tally);
        });
      });
  // Of random places a sum of N phases is about √N long, and longer than 4 √N once in e¹⁶ times.
  EXPECT_NEAR(orders.front(), 1.0, 1e-9);
  EXPECT_LT(orders.back(), 4.0 / std::sqrt(static_cast<double>(count)));

  // Two ways to know the density far from walls.
  EXPECT_NEAR(
      measured.density_by_theory.value, measured.density_by_counting.value,
      doubled(measured.density_by_theory).uncertainty + doubled(measured.density_by_counting).uncertainty);

  const Measurement& z = measured.compressibility;
  EXPECT_LT(z.uncertainty / z.value, 0.06);  // one that allows itself more would meet anything
  int values = 0;
  for (const Publication& publication : read_publications(kFolder)) {
    for (const Value& value : publication.values) {
      if (!is_fluid(value) || value.quantity == Quantity::fourth_cumulant) continue;
      if (std::get<Fluid>(value.experiment).density != density) continue;
      SCOPED_TRACE(testing::Message() << publication.key << ": " << value.name);
      expect_published(value, doubled(value.quantity == Quantity::compressibility ? z : mean_free_time(z)));
      ++values;
    }
  }
  EXPECT_EQ(values, density < 0.2 ? 1 : 3);
}

INSTANTIATE_TEST_SUITE_P(AtDensity, MeasuredFluid, testing::Values(0.1, 0.5, 0.9));

TEST(Measured, EqualSpeeds_RelaxAsPublished) {
  Laboratory laboratory(runners().at("carom:event"));
  int values = 0;
  for (Value value : read_publication(kFolder + "/hard-sphere-dynamics.toml").values) {
    if (value.quantity != Quantity::fourth_cumulant) continue;
    SCOPED_TRACE(value.name);
    std::get<Fluid>(value.experiment).count = 20'000;
    const Measurement measured = laboratory.measure(value);
    expect_published(value, doubled(measured));
    EXPECT_LT(measured.uncertainty, 0.016);
    ++values;
  }
  EXPECT_EQ(values, 6);
}

TEST(Measured, EqualSpeeds_AreFarthestFromMaxwell_AtTheStart) {
  const std::vector<RelaxationPoint> points = relaxation({0.1, 2000}, runners().at("carom:event"));
  EXPECT_EQ(points.front().collisions, 0.0);
  EXPECT_NEAR(points.front().cumulant, -0.4, 1e-14);
  EXPECT_GE(points.back().collisions, kMostCollisions);
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
  const test::TestFolder folder;
  const std::string file = (folder / "bad-publication.toml").string();
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
