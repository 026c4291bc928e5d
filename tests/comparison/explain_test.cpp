#include "comparison/explain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "tests/support/numbers.h"

namespace carom::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr DivergenceScale kScale{1e-15, 1e-12};

std::vector<Switch> switches(int count) {
  std::vector<Switch> all;
  all.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) all.push_back({std::string(1, static_cast<char>('a' + i)), ""});
  return all;
}

bool has(const Trial& trial, const std::string& name) {
  return std::find(trial.switched.begin(), trial.switched.end(), name) != trial.switched.end();
}

/// An engine whose divergence is this function of what is switched.
RunTrials engine_of(std::function<std::optional<double>(const Trial&)> divergence) {
  return [divergence = std::move(divergence)](const std::vector<Trial>& trials) {
    std::vector<std::optional<double>> all;
    all.reserve(trials.size());
    for (const Trial& trial : trials) all.push_back(divergence(trial));
    return all;
  };
}

std::vector<std::string> order_of(const Explanation& explanation) {
  std::vector<std::string> names;
  for (const SettingEffect& effect : explanation.settings) names.push_back(effect.name);
  return names;
}

double sum_of_shares(const Explanation& explanation) {
  double sum = 0.0;
  for (const SettingEffect& effect : explanation.settings) sum += effect.share.value();
  return sum;
}

TEST(Explain, SettingThatExplainsAll_ComesFirst_AndTheOthersAddNothing) {
  const Explanation found =
      explain(switches(4), kScale,
              engine_of([](const Trial& trial) { return std::optional(has(trial, "c") ? 1e-3 : 1.0); }));
  EXPECT_TRUE(found.settings_matter);
  EXPECT_FALSE(found.pair);
  EXPECT_THAT(order_of(found), ElementsAre("c", "a", "b", "d"));
  EXPECT_EQ(found.settings[0].alone, 1e-3);
  EXPECT_DOUBLE_EQ(*found.settings[0].alone_share, 1.0);
  EXPECT_DOUBLE_EQ(*found.settings[0].share, 1.0);
  EXPECT_EQ(*found.settings[1].share, 0.0);
  EXPECT_EQ(found.settings[3].cumulative, 1e-3);
}

// Bullet's two ways of pushing: taking away either alone is worse than having both.
TEST(Explain, SettingsThatActOnlyTogether_AreFoundAsAPair) {
  const Explanation found = explain(switches(5), kScale, engine_of([](const Trial& trial) {
                                      const bool b = has(trial, "b");
                                      const bool d = has(trial, "d");
                                      return std::optional(b && d ? 1e-6 : b || d ? 10.0 : 1.0);
                                    }));
  ASSERT_TRUE(found.pair);
  EXPECT_EQ(found.pair->first, "b");
  EXPECT_EQ(found.pair->second, "d");
  EXPECT_DOUBLE_EQ(found.pair->share, 1.0);
  EXPECT_THAT(order_of(found), ElementsAre("b", "d", "a", "c", "e"));
  EXPECT_LT(*found.settings[0].alone_share, 0.0);
  EXPECT_NEAR(sum_of_shares(found), 1.0, 10 * kEpsilon);
}

TEST(Explain, OtherDirection_NamesWhatMakesItWorse) {
  const Explanation found =
      explain(switches(3), kScale,
              engine_of([](const Trial& trial) { return std::optional(has(trial, "b") ? 1.0 : 1e-6); }));
  EXPECT_TRUE(found.settings_matter);
  EXPECT_EQ(found.settings.front().name, "b");
  EXPECT_DOUBLE_EQ(*found.settings.front().share, 1.0);
}

TEST(Explain, NoSetting_IsBlamed_WhereAllOfThemChangeLessThanAFactorOfTwo) {
  const Explanation found = explain(switches(3), kScale, engine_of([](const Trial& trial) {
                                      return std::optional(trial.switched.size() == 3 ? 0.6 : 1.0);
                                    }));
  EXPECT_FALSE(found.settings_matter);
  for (const SettingEffect& effect : found.settings) EXPECT_FALSE(effect.share);
}

TEST(Explain, RunThatFails_IsNoExplanation) {
  const Explanation found =
      explain(switches(3), kScale, engine_of([](const Trial& trial) -> std::optional<double> {
                if (has(trial, "a") && trial.switched.size() < 3) return std::nullopt;
                return has(trial, "b") ? 1e-4 : 1.0;
              }));
  EXPECT_EQ(found.settings.front().name, "b");
  const auto a = std::find_if(found.settings.begin(), found.settings.end(),
                              [](const SettingEffect& effect) { return effect.name == "a"; });
  EXPECT_FALSE(a->alone);
  EXPECT_LT(*a->alone_share, 0.0);
}

// Errors of several sources add up; the largest must be removed first to see any of the others.
TEST(Explain, Shares_AddUpToOne_AnyErrorsThatAdd) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<double> parts(7);
    for (double& part : parts) part = std::pow(10.0, -static_cast<double>(random() % 12U));
    const std::vector<Switch> all = switches(7);
    const Explanation found = explain(all, kScale, engine_of([&](const Trial& trial) {
                                        double divergence = 1e-14;
                                        for (std::size_t i = 0; i < parts.size(); ++i) {
                                          if (!has(trial, all[i].name)) divergence += parts[i];
                                        }
                                        return std::optional(divergence);
                                      }));
    ASSERT_TRUE(found.settings_matter);
    const std::vector<std::string> order = order_of(found);
    EXPECT_EQ(std::set<std::string>(order.begin(), order.end()).size(), all.size()) << seed;
    // Each share is a difference of logarithms of at most ln 1e300, of which a handful add up.
    EXPECT_NEAR(sum_of_shares(found), 1.0, 1e3 * kEpsilon) << seed;
    EXPECT_EQ(found.settings.back().cumulative, found.all) << seed;
  }
}

TEST(Explain, Trials_NameSwitchesInTheEnginesOrder) {
  std::vector<Trial> seen;
  explain(switches(4), kScale, [&](const std::vector<Trial>& trials) {
    seen.insert(seen.end(), trials.begin(), trials.end());
    std::vector<std::optional<double>> values;
    values.reserve(trials.size());
    for (const Trial& trial : trials)
      values.emplace_back(1.0 / static_cast<double>(1 + trial.switched.size()));
    return values;
  });
  for (const Trial& trial : seen) EXPECT_TRUE(std::is_sorted(trial.switched.begin(), trial.switched.end()));
}

TEST(Explain, Remainder_IsTheStep_WhereItFallsWithIt) {
  const Explanation found = explain(switches(2), kScale, engine_of([](const Trial& trial) {
                                      const double step = trial.half_step ? 0.5 : 1.0;
                                      return std::optional(has(trial, "a") ? 1e-3 * step * step : 1.0);
                                    }));
  EXPECT_EQ(found.remainder, RemainderCause::step);
  EXPECT_NEAR(found.remainder_order, 2.0, 10 * kEpsilon);
  EXPECT_EQ(*found.step_share, 0.0);
}

TEST(Explain, Remainder_IsToldByItsSize_WhereTheStepDoesNotMatter) {
  const auto remainder_at = [](std::optional<double> left) {
    return explain(switches(1), kScale, engine_of([left](const Trial& trial) {
                     return trial.switched.empty() ? std::optional(1.0) : left;
                   }))
        .remainder;
  };
  EXPECT_EQ(remainder_at(1e-16), RemainderCause::nothing);
  EXPECT_EQ(remainder_at(1e-13), RemainderCause::rounding);
  EXPECT_EQ(remainder_at(1e-5), RemainderCause::method);
  EXPECT_EQ(remainder_at(std::nullopt), RemainderCause::failure);
}

TEST(Explain, EngineWithoutSettings_ShowsWhatTheStepDoes) {
  const Explanation found = explain(
      {}, kScale, engine_of([](const Trial& trial) { return std::optional(trial.half_step ? 0.5 : 1.0); }));
  EXPECT_THAT(found.settings, IsEmpty());
  EXPECT_EQ(found.remainder, RemainderCause::step);
}

TEST(TellingMetric, IsPosition_WhereThereIsATruth_ElseEnergy) {
  RunComparison run;
  EXPECT_EQ(telling_metric(run), std::nullopt);
  run.metrics[Metric::energy_gain] = 0.1;
  EXPECT_EQ(telling_metric(run), Metric::energy_gain);
  run.metrics[Metric::energy] = 0.1;
  EXPECT_EQ(telling_metric(run), Metric::energy);
  run.metrics[Metric::position] = 0.0;
  EXPECT_EQ(telling_metric(run), Metric::position);
  run.run.status = RunStatus::invalid;
  EXPECT_EQ(telling_metric(run), std::nullopt);
}

}  // namespace
}  // namespace carom::test
