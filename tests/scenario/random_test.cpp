#include "core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/numbers.h"

namespace carom::test {

namespace {

constexpr std::size_t kDraws = 200'000;

std::vector<double> normals(std::uint64_t seed, std::size_t count) {
  Random random(seed);
  std::vector<double> values(count);
  for (double& value : values) value = random.normal();
  return values;
}

double mean_of_power(const std::vector<double>& values, int power) {
  double sum = 0.0;
  for (const double value : values) sum += std::pow(value, power);
  return sum / static_cast<double>(values.size());
}

/// The largest distance between the values' empirical distribution function and `cdf`.
template <class Cdf>
double kolmogorov_distance(std::vector<double> values, const Cdf& cdf) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double expected = cdf(values[i]);
    const auto below = static_cast<double>(i);
    distance = std::max({distance, expected - below / n, (below + 1.0) / n - expected});
  }
  return distance;
}

/// The distance that is exceeded with probability α = 1e-6, from the tail of Kolmogorov's distribution,
/// α = 2 exp(-2 n D²).
double critical_distance(std::size_t n) {
  constexpr double kAlpha = 1e-6;
  return std::sqrt(std::log(2.0 / kAlpha) / (2.0 * static_cast<double>(n)));
}

// The standard fixes the 10000th draw of mt19937_64 with seed 5489; a uniform is its upper 53 bits.
TEST(Random, Uniform_IsTheStandardsGenerator) {
  Random random(5489);
  for (int i = 1; i < 10'000; ++i) random.uniform();
  EXPECT_EQ(random.uniform(), static_cast<double>(9981545732273789042ULL >> 11U) * 0x1p-53);
}

TEST(Random, FirstValues_AreTheSameOnEveryMachine) {
  Random uniform(1);
  for (const double value :
       {0x1.122deafddb434p-3, 0x1.175c928118c7cp-3, 0x1.ce0b479deb99p-2, 0x1.5876015e4d7p-6})
    EXPECT_EQ(uniform.uniform(), value);
  Random normal(1);
  for (const double value :
       {0x1.9b41ca8d55ee1p-1, -0x1.d51e9a33f741p-2, 0x1.1b1c7962db13p-4, 0x1.3ebe5b3314p-11,
        -0x1.c5465293053f9p+1, -0x1.a4168a51b3cc4p-2, 0x1.3b701ffed4fcap+0, 0x1.908de66cd297ep+0})
    EXPECT_EQ(normal.normal(), value);
}

TEST(Random, Uniform_StaysInItsBounds) {
  Random random(2);
  for (std::size_t i = 0; i < kDraws; ++i) {
    const double unit = random.uniform();
    ASSERT_GE(unit, 0.0);
    ASSERT_LT(unit, 1.0);
    const double between = random.uniform(-3.0, -2.0);
    ASSERT_GE(between, -3.0);
    ASSERT_LE(between, -2.0);
    ASSERT_EQ(random.uniform(0.1, 0.1), 0.1);
  }
}

TEST(Random, Uniform_PassesKolmogorovSmirnov) {
  Random random(3);
  std::vector<double> values(kDraws);
  for (double& value : values) value = random.uniform();
  EXPECT_LT(kolmogorov_distance(values, [](double x) { return x; }), critical_distance(kDraws));
}

TEST(Random, Normal_PassesKolmogorovSmirnov) {
  const auto cdf = [](double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); };
  for (const std::uint64_t seed : {0U, 1U, 12345U}) {
    EXPECT_LT(kolmogorov_distance(normals(seed, kDraws), cdf), critical_distance(kDraws)) << seed;
  }
}

// The standard deviation of the mean of xᵖ over n draws is √((E x²ᵖ - (E xᵖ)²)/n), with E x² = 1, E x⁴ = 3,
// E x⁶ = 15, E x⁸ = 105.
TEST(Random, Normal_HasTheMomentsOfANormal) {
  struct Moment {
    int power;
    double expected;
    double variance;
  };
  const std::vector<double> values = normals(4, kDraws);
  for (const Moment& moment :
       {Moment{1, 0.0, 1.0}, {2, 1.0, 3.0 - 1.0}, {3, 0.0, 15.0}, {4, 3.0, 105.0 - 9.0}}) {
    const double deviation = std::sqrt(moment.variance / static_cast<double>(kDraws));
    EXPECT_NEAR(mean_of_power(values, moment.power), moment.expected, kDeviations * deviation)
        << moment.power;
  }
}

// A binomial count of n draws with probability p has the standard deviation √(n p (1 - p)).
TEST(Random, Normal_HasItsTails) {
  const std::vector<double> values = normals(5, kDraws);
  for (const double beyond : {1.0, 2.0, 3.0, 4.0}) {
    const double p = std::erfc(beyond / std::numbers::sqrt2);
    const auto n = static_cast<double>(kDraws);
    const auto count =
        std::count_if(values.begin(), values.end(), [&](double x) { return std::abs(x) > beyond; });
    EXPECT_NEAR(static_cast<double>(count), n * p, kDeviations * std::sqrt(n * p * (1.0 - p))) << beyond;
  }
}

// Independent draws: the mean of x_i x_(i+lag) has the standard deviation 1/√n.
TEST(Random, Normal_DrawsAreNotCorrelated) {
  const std::vector<double> values = normals(6, kDraws);
  for (const std::size_t lag : {1U, 2U, 3U, 10U}) {
    double sum = 0.0;
    for (std::size_t i = 0; i + lag < values.size(); ++i) sum += values[i] * values[i + lag];
    const auto n = static_cast<double>(values.size() - lag);
    EXPECT_NEAR(sum / n, 0.0, kDeviations / std::sqrt(n)) << lag;
  }
}

}  // namespace

}  // namespace carom::test
