#include "comparison/examine_textbook.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace carom::test {
namespace {

constexpr double kFloat = std::numeric_limits<float>::epsilon();

const TextbookFindings& findings() {
  static const TextbookFindings all = examine_textbook();
  return all;
}

TEST(TextbookFindings, ImpulseIsRight_ToRounding) {
  const ImpulseAccuracy& impulse = findings().impulse;
  EXPECT_GT(impulse.pairs, 9000);
  for (const double error : {impulse.velocity, impulse.momentum, impulse.energy}) {
    EXPECT_GT(error, 0.0);
    // A dozen roundings of n, s, p and the velocities, of places up to three times as far as the balls reach.
    EXPECT_LT(error, 36.0 * kFloat);
  }
}

/// With d = (1 − q) R the second ball is moved by 1/(1 − q) overlaps, and the gap is q/(1 − q) of R.
TEST(TextbookFindings, ShiftsAreThoseOfTheFormula) {
  for (const ShiftMeasured& shift : findings().shifts) {
    const double q = shift.overlap;
    const double rounding = 8.0 * kFloat / (q * (1.0 - q));
    EXPECT_NEAR(shift.first, 1.0, rounding) << q;
    EXPECT_NEAR(shift.second, 1.0 / (1.0 - q), rounding) << q;
    EXPECT_NEAR(shift.gap, q / (1.0 - q), rounding) << q;
    EXPECT_NEAR(shift.centre_of_mass, (100.0 / (1.0 - q) - 1.0) / 101.0, rounding) << q;
  }
  // At half of R one ball is moved by 1 and the other by 2 overlaps.
  EXPECT_NEAR(findings().swapped, 1.0, 32.0 * kFloat);
}

/// A correction only ever lifts the upper ball by more than it lowers the lower one.
TEST(TextbookFindings, MovingBallsApart_GainsEnergyUnderGravity_LessAtShorterUpdates) {
  double before = std::numeric_limits<double>::infinity();
  for (const DropMeasured& drop : findings().drops) {
    EXPECT_GT(drop.correction, 0.0) << drop.rate_hz;
    EXPECT_LT(drop.correction, before) << drop.rate_hz;
    before = drop.correction;
  }
  EXPECT_GT(findings().drops.front().correction, 0.1);
}

TEST(TextbookFindings, OneCentre_LosesTwoBalls_AndNoThird) {
  EXPECT_EQ(findings().coincident.not_finite_after_one, 2);
  EXPECT_EQ(findings().coincident.not_finite_after_all, 2);
  EXPECT_TRUE(findings().coincident.third_untouched);
}

TEST(TextbookFindings, SquaresAreKept_OnlyByElasticBalls) {
  for (const SquaredLaw& each : findings().squares) {
    EXPECT_DOUBLE_EQ(each.momentum_after, each.momentum_before);
    // Lost: m (1 − e²) v_n² with m = 3/4 kg and v_n = 3 m/s.
    const double lost = 6.75 * (1.0 - each.restitution * each.restitution);
    EXPECT_NEAR(each.squares_before - each.squares_after, lost, 1e-14 * each.squares_before);
  }
}

TEST(TextbookFindings, PassingUnseen_IsAsLikelyAsTheFormulaSays) {
  for (const RateMeasured& rate : findings().rates) {
    // 2000 evenly spread phases: each end of a range is met to within one of them.
    EXPECT_NEAR(rate.unseen, rate.unseen_by_formula, 2.0 / 2000.0) << rate.rate_hz;
    EXPECT_NEAR(rate.speed_mps, 0.02 * rate.rate_hz, rate.speed_mps * rate.rate_hz * kFloat);
    EXPECT_GT(rate.late_s, 0.0);
    EXPECT_LT(rate.late_s, 1.0 / rate.rate_hz);
  }
  EXPECT_GT(findings().rates.front().unseen, 0.5);
  EXPECT_EQ(findings().rates.back().unseen, 0.0);
}

TEST(TextbookFindings, SpinIsATenthOfRolling) {
  EXPECT_NEAR(findings().spin.drawn_rad, 0.1 * findings().spin.rolling_rad, 64.0 * kFloat);
}

}  // namespace
}  // namespace carom::test
