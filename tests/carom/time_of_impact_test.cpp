#include "carom/time_of_impact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace carom::test {
namespace {

using Vec2 = Vec<2>;

TEST(TimeToClose, UniformMotion_IsGapOverSpeed) {
  EXPECT_EQ(time_to_close(2.0, -4.0, 0.0, 0.0, 1.0), 0.5);
  EXPECT_EQ(time_to_close(2.0, 4.0, 0.0, 0.0, 1.0), kNever);
  EXPECT_EQ(time_to_close(2.0, 0.0, 0.0, 0.0, 1.0), kNever);
}

TEST(TimeToClose, OverlapAndApproach_IsNow_OverlapAndParting_IsNever) {
  EXPECT_EQ(time_to_close(-1e-12, -1.0, 0.0, 1e-15, 1.0), 0.0);
  EXPECT_EQ(time_to_close(-1e-12, 1.0, 0.0, 1e-15, 1.0), kNever);
  EXPECT_EQ(time_to_close(0.0, 0.0, -9.81, 1e-15, 1.0), 0.0);
}

TEST(TimeToClose, ThrownUpFromContact_FallsBack) {
  // From the floor with v: back after 2 v/g.
  EXPECT_DOUBLE_EQ(time_to_close(0.0, 3.0, -10.0, 1e-15, 1.0), 0.6);
}

TEST(TimeToClose, OverlapThatParts_FallsBackToWhereItIs) {
  // Deeper than the throw is high, so the gap never opens: back at the present depth after 2 v/g.
  EXPECT_DOUBLE_EQ(time_to_close(-1.0, 3.0, -10.0, 1e-15, 1.0), 0.6);
}

TEST(TimeToClose, TurnsBeforeTheWall_IsNever) {
  EXPECT_EQ(time_to_close(1.0, -1.0, 1.0, 0.0, 1.0), kNever);
}

TEST(TimeToClose, TinyGapUnderGravity_DoesNotCancel) {
  // gap = v t to first order; the naive root (-v - √(v² - 2 a gap))/a loses all digits here.
  const double time = time_to_close(1e-18, -1.0, -9.81, 0.0, 1.0);
  EXPECT_NEAR(time, 1e-18, 4.0 * kEpsilon * 1e-18);
}

TEST(TimeToTouch, HeadOn_IsDistanceOverSpeed) {
  EXPECT_EQ(time_to_touch<2>(Vec2(5.0, 0.0), Vec2(-2.0, 0.0), 1.0, 0.0), 2.0);
}

TEST(TimeToTouch, FromFarAway_KeepsTheImpactParameter) {
  // Half the sum of the radii off axis, from 10⁶ away: touches at distance √(1 - ¼) before the centre.
  const double far = 1e6;
  const double expected = far - std::sqrt(0.75);
  const double time = time_to_touch<2>(Vec2(far, 0.5), Vec2(-1.0, 0.0), 1.0, 0.0);
  EXPECT_NEAR(time, expected, 4.0 * kEpsilon * far);
}

TEST(TimeToTouch, Grazing_TouchesJustInsideAndMissesJustOutside) {
  EXPECT_LT(time_to_touch<2>(Vec2(3.0, 1.0 - 1e-12), Vec2(-1.0, 0.0), 1.0, 0.0), kNever);
  EXPECT_EQ(time_to_touch<2>(Vec2(3.0, 1.0 + 1e-12), Vec2(-1.0, 0.0), 1.0, 0.0), kNever);
}

/// The polynomial search is the slow twin of the closed root: a relative acceleration of zero must give the
/// same.
TEST(TimeToTouch, AgreesWithItsTwin_WithoutRelativeAcceleration) {
  Random random(11);
  int hits = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec2 d(random.uniform(1.5, 4.0), random.uniform(-1.0, 1.0));
    const Vec2 w(random.uniform(-3.0, -0.5), random.uniform(-1.0, 1.0));
    const double closed = time_to_touch<2>(d, w, 1.0, 0.0);
    const double searched = time_to_touch<2>(d, w, Vec2(0.0, 0.0), 1.0, 0.0, 100.0);
    ASSERT_EQ(closed < kNever, searched < kNever) << "trial " << trial;
    if (closed == kNever) continue;
    ++hits;
    // The searched root is found where f changes sign in floating point: f is known to a few ε |d|² ≤ 17 ε,
    // and its slope at the root is 2 √D; near a graze the slope is small.
    const double slope = 2.0 * std::abs((d + closed * w).dot(w));
    EXPECT_NEAR(searched, closed, 200.0 * kEpsilon / slope + 8.0 * kEpsilon * closed) << "trial " << trial;
  }
  EXPECT_GT(hits, 500);
}

/// A ball thrown after another that is slowed down by a relative acceleration, against fine sampling of f.
TEST(TimeToTouch, UnderRelativeAcceleration_IsTheFirstFall) {
  Random random(12);
  int hits = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Vec2 d(random.uniform(1.1, 3.0), random.uniform(-1.0, 1.0));
    const Vec2 w(random.uniform(-3.0, 1.0), random.uniform(-1.0, 1.0));
    const Vec2 a(random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0));
    const auto distance = [&](double t) { return (d + t * w + (0.5 * t * t) * a).norm(); };
    const double horizon = 2.0;
    const double found = time_to_touch<2>(d, w, a, 1.0, 0.0, horizon);
    const double sampled_until = std::min(found, horizon);
    for (int k = 0; k < 1000; ++k) {
      const double t = sampled_until * k / 1000.0;
      ASSERT_GE(distance(t), 1.0 - 1e-12) << "trial " << trial << ": overlap before the time found";
    }
    if (found == kNever) continue;
    ++hits;
    EXPECT_NEAR(distance(found), 1.0, 1e-13) << "trial " << trial;
  }
  EXPECT_GT(hits, 100);
}

}  // namespace
}  // namespace carom::test
