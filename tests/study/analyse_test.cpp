#include "study/analyse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace carom::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A point with an error and a time, and no spread.
StudyPoint point(const std::string& engine, std::int64_t steps, double error_m, double cpu_s) {
  StudyPoint result;
  result.engine = engine;
  result.steps_per_frame = steps;
  result.step_s = 1.0 / static_cast<double>(steps);
  result.status = RunStatus::ok;
  result.errors.position_m = error_m;
  result.steps = steps;
  result.cpu_s = {cpu_s, cpu_s, cpu_s};
  return result;
}

/// A scene of balls of radius 1 m with a truth that is known to 1e-14 m.
StudyScene scene_of(std::vector<StudyPoint> points) {
  StudyScene scene;
  scene.truth = "exact";
  scene.uncertainty_m = 1e-14;
  scene.smallest_radius_m = 1.0;
  scene.reach_m = 10.0;
  scene.balls = 2;
  scene.points = std::move(points);
  for (const StudyPoint& each : scene.points) {
    const bool known = std::any_of(scene.engines.begin(), scene.engines.end(),
                                   [&](const StudyEngine& engine) { return engine.label == each.engine; });
    if (!known) scene.engines.push_back({each.engine, true, true, 1});
  }
  return scene;
}

std::vector<std::size_t> indices(const std::vector<Mark>& marks) {
  std::vector<std::size_t> result;
  result.reserve(marks.size());
  for (const Mark& mark : marks) result.push_back(mark.point);
  return result;
}

TEST(Spread, HasQuartiles_BetweenTheValues) {
  const Spread spread = spread_of({4.0, 1.0, 3.0, 2.0});
  EXPECT_EQ(spread.least, 1.0);
  EXPECT_EQ(spread.lower_quartile, 1.75);
  EXPECT_EQ(spread.median, 2.5);
  EXPECT_EQ(spread.upper_quartile, 3.25);
}

TEST(Spread, IsTheValue_OfOne) {
  const Spread spread = spread_of({2.0});
  EXPECT_EQ(spread.least, 2.0);
  EXPECT_EQ(spread.median, 2.0);
  EXPECT_EQ(spread.upper_quartile, 2.0);
}

TEST(Front, HasWhatNoneBeats_FastestFirst) {
  const StudyScene scene = scene_of({point("a", 1, 1e-2, 1.0), point("a", 2, 1e-3, 2.0),  // both on it
                                     point("b", 1, 2e-2, 1.5),                            // slower and worse
                                     point("b", 2, 1e-3, 3.0),                            // as good, slower
                                     point("b", 4, 1e-5, 9.0), point("c", 1, 0.5, 0.1)});
  EXPECT_THAT(indices(front_of(marks_of(scene))), ElementsAre(5, 0, 1, 4));
}

TEST(Front, LeavesOut_WhatFailedOrWasNotTimed) {
  std::vector<StudyPoint> points = {point("a", 1, 1e-2, 1.0), point("a", 2, 1e-3, 2.0),
                                    point("a", 4, 1e-4, 4.0)};
  points[1].status = RunStatus::invalid;
  points[2].cpu_s.clear();
  EXPECT_THAT(indices(front_of(marks_of(scene_of(points)))), ElementsAre(0));
}

TEST(Front, HoldsErrorsEqual_BelowTheTruthsUncertainty) {
  const StudyScene scene = scene_of({point("a", 1, 5e-15, 1.0), point("b", 1, 1e-16, 2.0)});
  EXPECT_THAT(indices(front_of(marks_of(scene))), ElementsAre(0));
}

TEST(Cheapest, IsTheFastestThatMeetsTheTolerance) {
  const StudyScene scene =
      scene_of({point("a", 1, 1e-2, 1.0), point("a", 2, 1e-4, 5.0), point("b", 1, 5e-5, 3.0)});
  const std::vector<Mark> marks = marks_of(scene);
  EXPECT_EQ(cheapest(marks, 1e-2)->point, 0U);
  EXPECT_EQ(cheapest(marks, 1e-4)->point, 2U);
  EXPECT_FALSE(cheapest(marks, 1e-6));
  EXPECT_EQ(best_within(marks, 3.0)->point, 2U);
  EXPECT_FALSE(best_within(marks, 0.5));
}

std::vector<ErrorAtStep> errors_of_order(double order, double factor, double rounding) {
  std::vector<ErrorAtStep> errors;
  for (const double steps : {1.0, 2.0, 6.0, 13.0, 32.0, 75.0, 178.0, 422.0, 1000.0}) {
    errors.push_back({1.0 / steps, factor * std::pow(steps, -order) + rounding * steps, rounding * steps});
  }
  return errors;
}

TEST(Order, IsThatOfAPower_OfAnyExponent) {
  for (const double order : {-0.5, 0.5, 1.0, 2.0, 3.0}) {
    const Order fit = fit_order(errors_of_order(order, 1e-3, 0.0), 1e-15, 1.0);
    ASSERT_EQ(fit.kind, Order::Kind::fitted);
    // Nine logarithms, each right to a few ε of at most ln 1e12 = 28, over a range of ln 1000 = 7.
    EXPECT_NEAR(fit.order, order, 1e-13);
    EXPECT_NEAR(fit.r_squared, 1.0, 1e-13);
  }
}

TEST(Order, LeavesTheRoundOffFloorOut) {
  // C h² with rounding R/h: they meet where h³ = R/C, so at h = 1/200; beyond, errors rise.
  const Order fit = fit_order(errors_of_order(2.0, 1e-3, 1.25e-10), 1e-15, 1.0);
  ASSERT_EQ(fit.kind, Order::Kind::fitted);
  EXPECT_LT(fit.used, 7U);
  // An error at four times the least is rounding by a quarter at most, which over the decade and a half that
  // is left turns the slope by ln(4/3)/ln(32) at most.
  EXPECT_NEAR(fit.order, 2.0, 0.083);
}

TEST(Order, LeavesOut_ErrorsAsLargeAsABall) {
  std::vector<ErrorAtStep> errors = errors_of_order(1.0, 0.1, 0.0);
  errors[0].error = 3.0;
  errors[1].error = 2.5;
  const Order fit = fit_order(errors, 1e-15, 1.0);
  EXPECT_EQ(fit.used, errors.size() - 2);
  EXPECT_NEAR(fit.order, 1.0, 1e-13);
}

TEST(Order, IsRounding_WhereRoundingExplainsAll) {
  std::vector<ErrorAtStep> errors = errors_of_order(1.0, 0.0, 1e-16);
  EXPECT_EQ(fit_order(errors, 1e-15, 1.0).kind, Order::Kind::rounding);
  errors.front().error = 1e-3;
  EXPECT_NE(fit_order(errors, 1e-15, 1.0).kind, Order::Kind::rounding);
}

TEST(Order, IsNotFitted_ToTooFew) {
  std::vector<ErrorAtStep> errors = errors_of_order(1.0, 1e-3, 0.0);
  errors.resize(kFewestToFit - 1);
  EXPECT_EQ(fit_order(errors, 1e-15, 1.0).kind, Order::Kind::too_few);
  EXPECT_EQ(fit_order({}, 1e-15, 1.0).kind, Order::Kind::too_few);
}

TEST(PriceOfDigit, IsTenToTheInverseOrder_WhereTimeGoesWithSteps) {
  for (const int order : {1, 2}) {
    std::vector<StudyPoint> points;
    for (const std::int64_t steps : {1, 2, 6, 13, 32, 75}) {
      const auto count = static_cast<double>(steps);
      points.push_back(point("a", steps, 1e-2 * std::pow(count, -order), 1e-3 * count));
    }
    const StudyScene scene = scene_of(points);
    EXPECT_NEAR(*price_of_digit(scene, series_of(scene).front()), std::pow(10.0, 1.0 / order), 1e-11);
  }
}

TEST(Leads, AreWhereNoOwnRunIsAsGoodAndAsFast) {
  const StudyScene scene = scene_of({point("own:x", 1, 1e-3, 2.0), point("own:y", 1, 1e-9, 5.0),
                                     point("peer", 1, 1e-1, 1.0),    // faster than any of one's own
                                     point("peer", 2, 1e-3, 2.5),    // matched
                                     point("peer", 4, 1e-4, 3.0)});  // better than what is as fast
  const std::vector<Lead> leads = leads_over(scene, "own");
  ASSERT_EQ(leads.size(), 2U);
  EXPECT_EQ(leads[0].mark.point, 2U);
  EXPECT_FALSE(leads[0].own_at_cost);
  EXPECT_EQ(leads[0].own_at_error->point, 0U);
  EXPECT_EQ(leads[1].mark.point, 4U);
  EXPECT_EQ(leads[1].own_at_error->point, 1U);
  EXPECT_EQ(leads[1].own_at_cost->point, 0U);
}

TEST(Leads, AreNone_WhereQuartilesOverlap) {
  StudyScene scene = scene_of({point("own", 1, 1e-3, 2.0), point("peer", 1, 1e-3, 1.9)});
  EXPECT_EQ(leads_over(scene, "own").size(), 1U);
  scene.points[0].cpu_s = {1.8, 1.9, 2.0, 2.1, 2.2};
  EXPECT_THAT(leads_over(scene, "own"), IsEmpty());
}

TEST(Leads, AreNone_WhereBothAreWithinRounding) {
  StudyScene scene = scene_of({point("own", 1, 5e-13, 2.0), point("peer", 1, 1e-13, 2.0)});
  EXPECT_EQ(leads_over(scene, "own").size(), 1U);
  // Which run has the fewest roundings does not matter: what they come to in it nobody can do without.
  scene.points[0].rounding_m = 1e-9;
  scene.points[1].rounding_m = 6e-13;
  EXPECT_THAT(leads_over(scene, "own"), IsEmpty());
}

TEST(Overview, HoldsFamiliesAtEqualCost_AndAtEqualError) {
  const StudyScene scene = scene_of({point("a:x", 1, 1e-3, 1.0), point("a:y", 1, 1e-9, 6.0),
                                     point("b", 1, 1e-2, 2.0), point("b", 2, 1e-4, 20.0)});
  const std::optional<Comparison> row = compare_families(scene);
  ASSERT_TRUE(row);
  EXPECT_EQ(row->cost_s, 2.0);
  EXPECT_EQ(row->error, 1e-4);
  ASSERT_EQ(row->entries.size(), 2U);
  EXPECT_EQ(row->entries[0].family, "a");
  EXPECT_EQ(row->entries[0].error_at_cost, 1e-3);
  EXPECT_EQ(row->entries[0].cost_at_error_s, 6.0);
  EXPECT_EQ(row->entries[1].error_at_cost, 1e-2);
  EXPECT_EQ(row->entries[1].cost_at_error_s, 20.0);
}

TEST(Family, IsTheEngineOfAVariant) {
  EXPECT_EQ(family_of("carom:toi"), "carom");
  EXPECT_EQ(family_of("carom:toi:tree"), "carom");
  EXPECT_EQ(family_of("box2d"), "box2d");
  EXPECT_EQ(family_of("box2d@default"), "box2d@default");
}

TEST(Cost, IsPerBallAndStep_AndPerImpact) {
  StudyScene scene = scene_of({point("a", 5, 1e-3, 1e-6)});
  scene.points[0].impacts = 4;
  const Cost cost = cost_of(scene, scene.points[0]);
  EXPECT_DOUBLE_EQ(*cost.per_ball_and_step_ns, 100.0);
  EXPECT_DOUBLE_EQ(*cost.per_impact_ns, 250.0);
  scene.engines[0].takes_steps = false;
  EXPECT_FALSE(cost_of(scene, scene.points[0]).per_ball_and_step_ns);
}

TEST(Growth, HasTheExponent_OfAPower) {
  StudyGrowth growth;
  for (const std::int64_t balls : {10, 100, 1000, 10'000}) {
    GrowthPoint& each = growth.points.emplace_back();
    each.balls = balls;
    each.status = RunStatus::ok;
    each.steps = 20;
    each.cpu_s = {1e-8 * std::pow(static_cast<double>(balls), 1.5)};
  }
  EXPECT_NEAR(growth_of(growth)->exponent, 1.5, 1e-13);
  growth.points.resize(2);
  EXPECT_FALSE(growth_of(growth));
}

}  // namespace
}  // namespace carom::test
