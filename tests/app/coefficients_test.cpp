#include "app/coefficients.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <thread>

#include "app/engines.h"

namespace carom {
namespace {

constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
// Of velocities in single precision, divided by each other.
constexpr double kSingleRounding = 64.0 * double{std::numeric_limits<float>::epsilon()};

/// All probes in all engines, measured once for all tests.
const std::vector<CoefficientPanel>& panels() {
  static const std::vector<CoefficientPanel> measured = [] {
    const EngineCatalog catalog(CAROM_ENGINE_DIR_PATH, {});
    std::vector<EngineChoice> engines = {{catalog.find("carom")}, {catalog.find("carom:step")}};
    for (const char* name : {"box2d", "bullet-f64"}) {
      for (const char* profile : {"faithful", "default"}) engines.push_back({catalog.find(name), profile});
    }
    return measure_coefficients(engines, {},
                                static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U)));
  }();
  return measured;
}

CurveFinding finding(const CoefficientPanel& panel, const std::string& label) {
  const auto curve = std::find_if(panel.curves.begin(), panel.curves.end(),
                                  [&](const CoefficientCurve& each) { return each.label == label; });
  return finding_of(panel, *curve);
}

TEST(MeasuredCoefficients, Carom_DeliversWhatIsAskedFor_AtAnySpeed) {
  for (const CoefficientPanel& panel : panels()) {
    for (const char* label : {"carom", "carom:step"}) {
      const CurveFinding found = finding(panel, label);
      EXPECT_TRUE(found.arrived);
      EXPECT_FALSE(found.lost_up_to_mps);
      EXPECT_LE(found.largest_error, kRounding) << label;
    }
  }
}

TEST(MeasuredCoefficients, FaithfulRestitution_IsRightToRounding_InEveryEngine) {
  for (const CoefficientPanel& panel : panels()) {
    if (panel.coefficient != Coefficient::restitution) continue;
    EXPECT_LE(finding(panel, "box2d").largest_error, kSingleRounding);
    EXPECT_FALSE(finding(panel, "box2d").lost_up_to_mps);
    EXPECT_LE(finding(panel, "bullet-f64").largest_error, kRounding);
    EXPECT_FALSE(finding(panel, "bullet-f64").lost_up_to_mps);
  }
}

// Box2D takes 1 m/s and less for rest, Bullet 0.2 m/s and less: the highest speeds of the grid below those.
TEST(MeasuredCoefficients, DefaultThresholds_AreSeenWhereTheyAre) {
  for (const CoefficientPanel& panel : panels()) {
    if (panel.coefficient != Coefficient::restitution) continue;
    EXPECT_NEAR(finding(panel, "box2d@default").lost_up_to_mps.value_or(0.0), 1.0, kRounding) << panel.wall;
    EXPECT_NEAR(finding(panel, "bullet-f64@default").lost_up_to_mps.value_or(0.0), 0.1, kRounding)
        << panel.wall;
  }
}

// Bullet pushes erp2 = 1/5 of the overlap out in a step, so that overlaps of 0.2, 0.5 and 0.8 steps give e +
// 0.04 to e + 0.16. A wall acts from 0.02 √3 r on: a ball that is still 0.5 and 0.2 steps away, 0.025 r and
// 0.01 r, is slowed down by as much, and is hit again from what is left.
TEST(MeasuredCoefficients, BulletsDefault_HangsOnThePhaseOfTheStep) {
  // An overlap is a difference of places of up to 0.2 m, in steps of 0.005 m.
  constexpr double kTolerance = 40.0 * kRounding;
  for (const CoefficientPanel& panel : panels()) {
    if (panel.coefficient != Coefficient::restitution) continue;
    const CurveFinding found = finding(panel, "bullet-f64@default");
    EXPECT_NEAR(found.largest_error, 0.04, kTolerance);
    if (panel.wall) {
      EXPECT_LT(found.lowest, panel.nominal - 0.19);
    } else {
      EXPECT_NEAR(found.lowest, panel.nominal, kTolerance);
      EXPECT_NEAR(found.highest, panel.nominal + 0.16, kTolerance);
    }
  }
}

}  // namespace
}  // namespace carom
