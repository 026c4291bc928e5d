#include "comparison/statistics/hard_ball_fluid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/numbers.h"

namespace carom::test {
namespace {

double packing_of(double density) {
  return kPi / 6.0 * density;  // σ = 1
}

TEST(HardBallFluid, EquationOfState_IsCarnahanAndStarlings_InSpace) {
  const double table[][3] = {{0.1, 1.23967, 1.23972},
                             {0.3, 1.96671, 1.96819},
                             {0.5, 3.26243, 3.26951},
                             {0.7, 5.71021, 5.72744},
                             {0.9, 10.7461, 10.7597}};
  for (const auto& [density, z, better] : table) {
    const double eta = packing_of(density);
    EXPECT_NEAR(fluid::compressibility(3, eta), z, 5e-6 * z);
    // The table's difference, of two numbers rounded to six digits.
    EXPECT_NEAR(fluid::compressibility_error(3, eta), (better - z) / z, 1e-5);
  }
}

TEST(HardBallFluid, CollisionRate_FollowsFromThePressure_ByTheVirialTheorem) {
  // Γ = 2 d (Z - 1) √(T/m)/(σ √π): for d = 3 the identity Z - 1 = √π/(6 t0).
  for (const int d : {2, 3}) {
    for (const double eta : {0.01, 0.1, 0.3, 0.45}) {
      const double rate = fluid::collision_rate_per_s(d, eta, 0.2, 3.0, 0.7);
      const double expected =
          2.0 * d * (fluid::compressibility(d, eta) - 1.0) * std::sqrt(3.0 / 0.7) / (0.2 * std::sqrt(kPi));
      EXPECT_NEAR(rate, expected, 1e-13 * expected) << d << "D, η = " << eta;
    }
  }
}

TEST(HardBallFluid, MeanFreeTime_IsTheMeasuredOne_AtHalfDensity) {
  // Molecular dynamics: 0.13022 for σ = m = T = 1; Carnahan and Starling's Z is 0.0064 below the measured
  // 3.2688 there, 0.28 % of Z - 1.
  EXPECT_NEAR(1.0 / fluid::collision_rate_per_s(3, packing_of(0.5), 1.0, 1.0, 1.0), 0.13022,
              0.0029 * 0.13022);
}

TEST(HardBallFluid, Slopes_AreThoseOfTheFunctions) {
  const double h = 1e-5;
  for (const int d : {2, 3}) {
    for (const double eta : {0.05, 0.2, 0.4}) {
      const auto z = [&](double x) { return x * fluid::compressibility(d, x); };
      const auto gamma = [&](double x) { return fluid::wall_tension(d, x, 0.3); };
      // Central differences are off by h²/6 f''' and by rounding, ε f/h.
      const double slope = fluid::compressibility_slope(d, eta);
      EXPECT_NEAR((z(eta + h) - z(eta - h)) / (2.0 * h), slope, 1e-7 * slope);
      const double tension = fluid::wall_tension_slope(d, eta, 0.3);
      EXPECT_NEAR((gamma(eta + h) - gamma(eta - h)) / (2.0 * h), tension, 1e-7 * std::abs(tension));
    }
  }
}

/// ∫ Π (ℓ_i - |x_i|) over |x| < σ in a cube: how many of all pairs of places overlap, by V².
double overlapping_share(int d, double l, double sigma) {
  const double x = sigma / l;
  return d == 3 ? 4.0 / 3.0 * kPi * std::pow(x, 3) - 1.5 * kPi * std::pow(x, 4) + 1.6 * std::pow(x, 5) -
                      std::pow(x, 6) / 6.0
                : kPi * x * x - 8.0 / 3.0 * std::pow(x, 3) + 0.5 * std::pow(x, 4);
}

TEST(HardBallFluid, BoxedFluid_HasTheExactSecondVirialCoefficientOfItsBox_WhenThin) {
  // The configurations of N balls number V^N (1 - N(N-1)/2 q), q the share of places of a pair that overlap;
  // the mean force across i is T times the derivative of their logarithm by ℓ_i. For a cube, by ℓ of all:
  // W/T = -d ln(...)/d ln ℓ beyond d N.
  for (const int d : {2, 3}) {
    const double sigma = 1.0;
    const double side = 21.0;
    const double l = side - sigma;
    const double n = 2.0;
    const double h = 1e-4;
    const auto logarithm = [&](double ln_l) {
      return -0.5 * n * n * overlapping_share(d, std::exp(ln_l), sigma);
    };
    const double ln_l = std::log(l);
    const double exact = (logarithm(ln_l + h) - logarithm(ln_l - h)) / (2.0 * h);
    const fluid::Boxed boxed = fluid::boxed_fluid(d, n, {side, side, side}, sigma, 1.0);
    const double corners = d == 3 ? 16.0 / (15.0 * kPi) : 3.0 / 16.0;
    // The surface's part of q is about d σ/ℓ of it; edges and corners are left out, and densities beyond n².
    const double left_out = d * sigma / l * corners * sigma / l * 2.0 + 8.0 * boxed.bulk_packing;
    EXPECT_NEAR(boxed.pair_virial_J_s, exact, left_out * exact) << d;
  }
}

TEST(HardBallFluid, BoxedFluid_IsTheBulk_WhenTheBoxIsLarge) {
  for (const int d : {2, 3}) {
    for (const double eta : {0.05, 0.25, 0.4}) {
      const double side = 1e6;
      const double volume = std::pow(side, d);
      const double count = eta / (d == 3 ? kPi / 6.0 : kPi / 4.0) * volume;
      const fluid::Boxed boxed = fluid::boxed_fluid(d, count, {side, side, side}, 1.0, 2.0);
      const double z = fluid::compressibility(d, eta);
      // Walls change it by a few σ/L.
      EXPECT_NEAR(boxed.bulk_packing, eta, 1e-5);
      EXPECT_NEAR(boxed.wall_force_N / (2.0 * d * volume / side), 2.0 * z * count / volume, 1e-4 * z);
      EXPECT_NEAR(boxed.pair_virial_J_s, d * count * 2.0 * (z - 1.0), 1e-4 * d * count * z);
    }
  }
}

TEST(HardBallFluid, BoxedFluid_GivesMoreForceThanTheBulk_InANarrowBox) {
  const double count = 500.0;
  const fluid::Boxed boxed = fluid::boxed_fluid(3, count, {10.0, 10.0, 10.0}, 1.0, 1.0);
  EXPECT_GT(boxed.bulk_packing, packing_of(0.5));
  EXPECT_LT(boxed.bulk_packing, packing_of(0.5) * std::pow(10.0 / 9.0, 3));
  EXPECT_GT(boxed.wall_force_N / 600.0, 0.5 * fluid::compressibility(3, packing_of(0.5)));
}

}  // namespace
}  // namespace carom::test
