#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "report/page/axis.h"
#include "report/page/polyline.h"
#include "report/page/wording.h"

namespace carom::page {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(PageNumber, HasTheDigitsThatMatter_AtAnySize) {
  EXPECT_EQ(number(1.234e-16), "1.2e-16");
  EXPECT_EQ(number(-0.4321), "−0.432");
  EXPECT_EQ(number(12345.0), "1.23e4");
  EXPECT_EQ(number(-0.0), "0");
  EXPECT_EQ(number(kNaN), "n/a");
  EXPECT_EQ(number(std::nullopt), "n/a");
  EXPECT_EQ(given(1e-9), "1e-9");
  EXPECT_EQ(given(0.0041), "0.0041");
}

TEST(PageAxis, HasRoundTicks_OnALinearScale) {
  std::vector<std::string> labels;
  for (const Tick& tick : Axis::linear(-0.1, 2.0).ticks(6)) labels.push_back(tick.label);
  EXPECT_THAT(labels, testing::ElementsAre("0", "0.5", "1", "1.5", "2"));
}

TEST(PageAxis, PutsZeroAndWhatIsSmallerThanTheFloor_AtTheBottom) {
  const Axis axis = Axis::log(1e-17, 0.5);
  EXPECT_EQ(axis.fraction(0.0), 0.0);
  EXPECT_EQ(axis.fraction(1e-30), 0.0);
  EXPECT_EQ(axis.fraction(1.0), 1.0);
  EXPECT_EQ(axis.ticks(8).front().label, "0");
}

TEST(PageAxis, IsSymmetric_AroundTheZeroOfSignedPowersOfTen) {
  const Axis axis = Axis::symlog(1e-17, -1e-3, 1e-3);
  EXPECT_EQ(axis.fraction(0.0), 0.5);
  // The two logarithms that make a fraction are about 17 and round by ε each, of a length of about 28.
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon();
  EXPECT_NEAR(axis.fraction(1e-9) + axis.fraction(-1e-9), 1.0, rounding);
  EXPECT_TRUE(std::isfinite(axis.fraction(1e299)));
  EXPECT_TRUE(std::isnan(axis.fraction(kInfinite)));
}

TEST(PagePolyline, KeepsTheExtremes_WhereItThinsALongCurve) {
  Polyline curve;
  for (int i = 0; i < 100000; ++i) curve.push_back({0.003 * i, 50.0 + std::sin(0.01 * i)});
  curve[54321].y = 0.0;
  curve[77777].y = 100.0;
  const Polyline thin = thinned(curve);
  EXPECT_LE(thin.size(), kMaxPoints);
  const auto at_height = [&](double y) {
    return std::count_if(thin.begin(), thin.end(), [&](const Point& p) { return p.y == y; });
  };
  EXPECT_EQ(at_height(0.0), 1);
  EXPECT_EQ(at_height(100.0), 1);
}

TEST(PagePolyline, Breaks_WhereAPointIsNotFinite) {
  EXPECT_EQ(path_data({{0, 0}, {1, 2}, {kNaN, 0}, {3, 4}, {5, kInfinite}}), "M0 0L1 2M3 4h0");
}

}  // namespace
}  // namespace carom::page
