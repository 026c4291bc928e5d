#include "reference/exact/exact.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/random.h"
#include "reference/closed_form/closed_form.h"
#include "reference/exact/certify.h"
#include "scenario/catalog.h"
#include "scenario/parse.h"
#include "tests/support/numbers.h"

namespace carom::test {
namespace {

using ::testing::HasSubstr;

/// What a source handed out.
struct Story {
  std::vector<std::vector<BallState>> states;  ///< at each moment that is known
  std::vector<Tally> tallies;
  Solution solution;
};

/// The moments of a scene's frames.
std::vector<Moment> frames_of(const Scenario& scene) {
  std::vector<Moment> moments;
  const double interval_s = scene.duration_s / static_cast<double>(scene.frames);
  for (std::int64_t k = 0; k <= scene.frames; ++k) moments.push_back({interval_s, k});
  return moments;
}

auto into(Story& story) {
  return [&story](std::size_t, std::span<const BallState> balls, const Tally& tally) {
    story.states.emplace_back(balls.begin(), balls.end());
    story.tallies.push_back(tally);
  };
}

Story solved_by(const TruthSource& source, const Scenario& scene) {
  Story story;
  story.solution = source.solve(scene, frames_of(scene), into(story));
  return story;
}

Story certified(const Scenario& scene, const exact::Demands& demands = {}) {
  Story story;
  story.solution = exact::certify(scene, frames_of(scene), into(story), demands);
  return story;
}

std::string refusal(const Scenario& scene) {
  return make_exact_truth()->refuses(scene);
}

Ball ball(const Vec3& position, const Vec3& velocity = Vec3::Zero(), double mass = 1.0, double radius = 0.1) {
  return {.mass = mass, .radius = radius, .position = position, .velocity = velocity};
}

Scenario scene_of(std::vector<Ball> balls, double duration_s, std::int64_t frames = 20) {
  Scenario scene;
  scene.dimension = 3;
  scene.duration_s = duration_s;
  scene.frames = frames;
  scene.balls = std::move(balls);
  return scene;
}

ScenarioPtr gas(int dimension, int count, double duration_s) {
  const std::string corner = dimension == 2 ? "[4, 4]" : "[2, 2, 2]";
  return parse_scene(
      "title = \"gas\"\ndimension = " + std::to_string(dimension) +
          "\nduration = " + std::to_string(duration_s) +
          "\nstep = 0.01\nframes = 20\n[box]\nmin = " + (dimension == 2 ? "[0, 0]" : "[0, 0, 0]") +
          "\nmax = " + corner + "\n[[balls]]\nkind = \"gas\"\ncount = " + std::to_string(count) +
          "\nseed = 3\nradius = [0.5, 1.0]\npacking = 0.1\nmass = 1.0\nspeed = 1.0\n",
      "gas.toml");
}

/// How far two stories are apart in any position of the frames that both know, m.
double farthest_m(const Story& a, const Story& b) {
  double farthest = 0.0;
  for (std::size_t k = 0; k < std::min(a.states.size(), b.states.size()); ++k) {
    for (std::size_t i = 0; i < a.states[k].size(); ++i) {
      farthest = std::max(farthest, (a.states[k][i].position - b.states[k][i].position).norm());
    }
  }
  return farthest;
}

/// Holds the exact solution against the closed form, positions within what both say of themselves.
void expect_agreement(const Scenario& scene, const std::string& name) {
  const auto closed_form = make_closed_form_truth();
  ASSERT_EQ(closed_form->refuses(scene), "") << name;
  ASSERT_EQ(refusal(scene), "") << name;
  const Story exact = certified(scene);
  const Story closed = solved_by(*closed_form, scene);
  EXPECT_LE(farthest_m(exact, closed), exact.solution.uncertainty_m + closed.solution.uncertainty_m) << name;
  for (std::size_t k = 0; k < exact.tallies.size(); ++k) {
    EXPECT_EQ(exact.tallies[k].impacts, closed.tallies[k].impacts) << name << ", frame " << k;
  }
}

// ------------------------------------------------------------------------------------ against closed forms

TEST(ExactTruth, AgreesWithClosedForm_InEveryScene) {
  int compared = 0;
  for (const auto& file : Catalog(CAROM_SOURCE_DIR "/scenarios").all()) {
    const ScenarioPtr scene = load_scene(file);
    if (!make_closed_form_truth()->refuses(*scene).empty() || !refusal(*scene).empty()) continue;
    expect_agreement(*scene, file.string());
    ++compared;
  }
  EXPECT_GE(compared, 25);
}

TEST(ExactTruth, AgreesWithClosedForm_TwoRoughBalls) {
  Random random(11);
  int met = 0;
  for (int n = 0; n < 100; ++n) {
    Scenario scene = scene_of({}, 3.0);
    scene.effects.spin = true;
    scene.ball_contact = {random.uniform(), random.uniform(), random.uniform(-1.0, 1.0)};
    for (const double side : {-1.0, 1.0}) {
      Ball b = ball({side, random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)},
                    {-side * random.uniform(0.5, 2.0), random.uniform(-0.2, 0.2), 0.0},
                    random.uniform(0.1, 10.0), random.uniform(0.1, 0.4));
      b.spin = Vec3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
      b.inertia = random.uniform(0.2, 0.7);
      scene.balls.push_back(b);
    }
    if (n % 3 == 0) scene.effects.gravity = Vec3(0.0, -9.81, 1.0);
    if (n % 5 == 0) scene.balls[0].mass = kInfinity;
    if (n % 15 == 0) scene.effects.gravity.reset();
    if (!make_closed_form_truth()->refuses(scene).empty()) continue;
    expect_agreement(scene, "pair " + std::to_string(n));
    met += certified(scene).solution.impact_count > 0 ? 1 : 0;
  }
  EXPECT_GE(met, 30);
}

TEST(ExactTruth, AgreesWithClosedForm_BounceOnRoughSlope) {
  Random random(12);
  for (int n = 0; n < 40; ++n) {
    Scenario scene = scene_of({ball({0, 1.0, 0}, {random.uniform(-2, 2), random.uniform(-1, 1), 0.5})}, 1.0);
    scene.balls[0].spin = Vec3(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50));
    scene.effects.spin = true;
    scene.effects.gravity = Vec3(0, -9.81, 0);
    const double slope = random.uniform(-0.3, 0.3);
    scene.walls = {{Vec3(std::sin(slope), std::cos(slope), 0), 0.0}};
    scene.wall_contact = {random.uniform(0.5, 1.0), random.uniform(0.0, 0.5), random.uniform(-1.0, 1.0)};
    expect_agreement(scene, "bounce " + std::to_string(n));
  }
}

TEST(ExactTruth, CountsTheDigitsOfPi_BetweenAWallAndAHeavyBall) {
  for (const auto& [ratio, count] : {std::pair{1.0, 3}, {1e2, 31}, {1e4, 314}, {1e6, 3141}, {7.3, 8}}) {
    Scenario scene = scene_of({ball({1, 0, 0}), ball({2, 0, 0}, {-1, 0, 0}, ratio)}, 50.0);
    scene.walls = {{Vec3::UnitX(), 0.0}};
    const double theta = std::atan(std::sqrt(1.0 / ratio));
    const auto expected = static_cast<std::int64_t>(std::ceil(std::numbers::pi / theta)) - 1;
    EXPECT_EQ(expected, count);
    EXPECT_EQ(certified(scene).solution.impact_count, expected) << ratio;
  }
}

// ---------------------------------------------------------------------------------------- the certificate

TEST(ExactTruth, CertifiesWholeDuration_GasOfAHundredBalls) {
  const ScenarioPtr scene = gas(3, 100, 2.0);
  const Story story = certified(*scene);
  EXPECT_FALSE(story.solution.known_until_s.has_value()) << story.solution.limit;
  EXPECT_EQ(story.states.size(), 21U);
  EXPECT_GE(story.solution.impact_count, 500);
  EXPECT_EQ(story.solution.impacts.size(), static_cast<std::size_t>(story.solution.impact_count));
  EXPECT_TRUE(std::is_sorted(story.solution.impacts.begin(), story.solution.impacts.end(),
                             [](const TrueImpact& a, const TrueImpact& b) { return a.time_s < b.time_s; }));
  // Rounded to doubles, and no more: the box is 2 m wide.
  EXPECT_LE(story.solution.uncertainty_m, 2.0 * kEpsilon);
  ASSERT_EQ(story.solution.amplification.size(), story.states.size());
  EXPECT_GE(story.solution.amplification.back(), 1e4);
}

TEST(ExactTruth, StatesAreTheSameToTheBit_WhateverDigitsItStartsWith) {
  const ScenarioPtr scene = gas(2, 30, 2.0);
  const Story forty = certified(*scene);
  const Story more = certified(*scene, {.digits = 57});
  EXPECT_EQ(forty.solution.digits, 40);
  EXPECT_EQ(more.solution.digits, 57);
  ASSERT_EQ(forty.states.size(), more.states.size());
  for (std::size_t k = 0; k < forty.states.size(); ++k) {
    for (std::size_t i = 0; i < forty.states[k].size(); ++i) {
      EXPECT_EQ(forty.states[k][i].position, more.states[k][i].position);
      EXPECT_EQ(forty.states[k][i].velocity, more.states[k][i].velocity);
    }
  }
}

TEST(ExactTruth, StopsWhereDigitsNoLongerAgree_TooFewOfThem) {
  const ScenarioPtr scene = gas(2, 30, 8.0);
  const Story whole = certified(*scene);
  ASSERT_FALSE(whole.solution.known_until_s.has_value());
  double before_s = 0.0;
  for (const int digits : {24, 30}) {
    const Story cut = certified(*scene, {.digits = digits, .most_digits = 2 * digits});
    ASSERT_TRUE(cut.solution.known_until_s.has_value());
    EXPECT_THAT(cut.solution.limit, HasSubstr("digits do not agree"));
    EXPECT_GT(*cut.solution.known_until_s, before_s);  // more digits reach farther
    EXPECT_LT(cut.states.size(), whole.states.size());
    EXPECT_LE(farthest_m(cut, whole), kEpsilon * 4.0);  // and what was handed out is true
    EXPECT_LT(cut.solution.impact_count, whole.solution.impact_count);
    before_s = *cut.solution.known_until_s;
  }
}

TEST(ExactTruth, HandsOutNothing_DigitsThatCannotHoldTheScene) {
  const ScenarioPtr scene = gas(2, 10, 1.0);
  EXPECT_THROW(certified(*scene, {.digits = 10, .most_digits = 20}), std::runtime_error);
}

TEST(ExactTruth, RaisesItsDigits_UntilTheyAgree) {
  const ScenarioPtr scene = gas(2, 30, 8.0);
  const Story story = certified(*scene, {.digits = 10});
  EXPECT_FALSE(story.solution.known_until_s.has_value()) << story.solution.limit;
  EXPECT_GT(story.solution.digits, 20);
}

TEST(ExactTruth, StopsAtItsBudget_AndAlwaysAtTheSamePlace) {
  const ScenarioPtr scene = gas(3, 30, 8.0);
  const Story once = certified(*scene, {.budget = 3'000'000});
  ASSERT_TRUE(once.solution.known_until_s.has_value());
  EXPECT_THAT(once.solution.limit, HasSubstr("budget"));
  EXPECT_EQ(once.solution.known_until_s, certified(*scene, {.budget = 3'000'000}).solution.known_until_s);
}

// ------------------------------------------------------------------------------------------ amplification

TEST(ExactAmplification, IsThatOfFreeFlight_OneBall) {
  const Story story = certified(scene_of({ball({1, 0, 0}, {1, 1, 0})}, 4.0, 8));
  ASSERT_EQ(story.solution.amplification.size(), 9U);
  // |δx + δv t| / max(|δx|, |δv| T), which is linear in t, and at most 1 + t/T.
  const std::vector<double>& a = story.solution.amplification;
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_LE(a[k], 1.0 + static_cast<double>(k) / 8.0 + kEpsilon);
  // x² is a parabola in t: its second differences are equal.
  const auto second = [&](std::size_t k) {
    return a[k - 1] * a[k - 1] - 2.0 * a[k] * a[k] + a[k + 1] * a[k + 1];
  };
  for (std::size_t k = 2; k < 8; ++k) EXPECT_NEAR(second(k), second(1), 64.0 * kEpsilon);
}

TEST(ExactAmplification, OfBallsOnALine_IsThatAlongIt) {
  Scenario scene = scene_of({ball({1, 0, 0}), ball({2, 0, 0}, {-1, 0, 0}, 1e4)}, 4.0);
  scene.walls = {{Vec3::UnitX(), 0.0}};
  const Story story = certified(scene);
  ASSERT_EQ(story.solution.amplification.size(), story.states.size());
  // The light ball ends at less than 100 times the speed of the heavy one, within 4 s, and its places and
  // times differ by no more than its number of impacts; across the line errors would grow by 10³⁹.
  EXPECT_LE(*std::max_element(story.solution.amplification.begin(), story.solution.amplification.end()), 1e5);
}

// -------------------------------------------------------------------------------------------------- ties

TEST(ExactTie, IsToldAndEndsTheTruth_FiveBallsAtOnePoint) {
  const ScenarioPtr scene = load_scene(CAROM_SOURCE_DIR "/scenarios/hard/five-at-once.toml");
  const Story story = certified(*scene);
  ASSERT_EQ(story.solution.ties.size(), 1U);
  EXPECT_EQ(story.solution.ties[0].balls, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  EXPECT_TRUE(story.solution.ties[0].shares_ball);
  // The centres are neighbours on a pentagon of circumradius 1 - t, with sides 2 (1 - t) sin 36° = 0.2.
  const double meet_s = 1.0 - 0.1 / std::sin(std::numbers::pi / 5.0);
  EXPECT_NEAR(story.solution.ties[0].time_s, meet_s, 16.0 * kEpsilon);
  ASSERT_TRUE(story.solution.known_until_s.has_value());
  EXPECT_LT(*story.solution.known_until_s, story.solution.ties[0].time_s);
  EXPECT_NEAR(*story.solution.known_until_s, meet_s, 16.0 * kEpsilon);
  EXPECT_THAT(story.solution.limit, HasSubstr("depends on their order"));
  EXPECT_EQ(story.solution.impact_count, 0);
}

/// A ball that flies into the corner of two walls and meets both at t = 1 s.
Scenario corner_shot(double friction) {
  Scenario scene = scene_of({ball({1.25, 1.25, 0}, {-1, -1, 0}, 1.0, 0.25)}, 2.0);
  scene.walls = {{Vec3::UnitX(), 0.0}, {Vec3::UnitY(), 0.0}};
  scene.effects.spin = true;
  scene.wall_contact.friction = friction;
  return scene;
}

TEST(ExactTie, EndsNothing_SmoothCorner) {
  const Story story = certified(corner_shot(0.0));
  EXPECT_FALSE(story.solution.known_until_s.has_value()) << story.solution.limit;
  ASSERT_EQ(story.solution.ties.size(), 1U);
  EXPECT_TRUE(story.solution.ties[0].shares_ball);
  EXPECT_EQ(story.solution.ties[0].time_s, 1.0);
  EXPECT_EQ(story.solution.impact_count, 2);
  EXPECT_EQ(story.states.back()[0].velocity, Vec3(1, 1, 0));
  EXPECT_EQ(story.states.back()[0].position, Vec3(1.25, 1.25, 0));
}

TEST(ExactTie, EndsTheTruth_RoughCorner) {
  const Story story = certified(corner_shot(0.3));
  ASSERT_TRUE(story.solution.known_until_s.has_value());
  EXPECT_EQ(*story.solution.known_until_s, std::nextafter(1.0, 0.0));
}

TEST(ExactTie, IsToldAndEndsNothing_PairsApart) {
  const Story story = certified(scene_of({ball({-1, 0, 0}, {1, 0, 0}), ball({1, 0, 0}, {-1, 0, 0}),
                                          ball({-1, 5, 0}, {1, 0, 0}), ball({1, 5, 0}, {-1, 0, 0})},
                                         2.0));
  EXPECT_FALSE(story.solution.known_until_s.has_value()) << story.solution.limit;
  ASSERT_EQ(story.solution.ties.size(), 1U);
  EXPECT_EQ(story.solution.ties[0].balls, (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_FALSE(story.solution.ties[0].shares_ball);
  EXPECT_EQ(story.states.back()[2].velocity, Vec3(-1, 0, 0));
}

TEST(ExactTie, EndsTheTruth_TouchingCradleIsHit) {
  const ScenarioPtr scene = load_scene(CAROM_SOURCE_DIR "/scenarios/hard/cradle-sequential.toml");
  const Story story = certified(*scene);
  ASSERT_TRUE(story.solution.known_until_s.has_value());
  EXPECT_NEAR(*story.solution.known_until_s, 0.75, kEpsilon);
  EXPECT_THAT(story.solution.limit, HasSubstr("touch"));
}

TEST(ExactTruth, EndsWhenBouncesPileUp_DropWithLoss) {
  Scenario scene = scene_of({ball({0, 1.1, 0})}, 20.0, 400);
  scene.effects.gravity = Vec3(0, -9.81, 0);
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.wall_contact.restitution = 0.5;
  const Story story = certified(scene);
  ASSERT_TRUE(story.solution.known_until_s.has_value());
  // √(2h/g) (1 + e)/(1 - e)
  EXPECT_NEAR(*story.solution.known_until_s, std::sqrt(2.0 / 9.81) * 3.0, 1e-14);
  EXPECT_THAT(story.solution.limit, HasSubstr("comes to rest"));
}

// ------------------------------------------------------------------------------------------------ refusals

TEST(ExactTruth, SaysWhy_ItRefuses) {
  Scenario scene = scene_of({ball({0, 1, 0}), ball({1, 1, 0})}, 1.0);
  EXPECT_EQ(refusal(scene), "");
  scene.effects.drag = Drag{Drag::Kind::linear, 0.1};
  EXPECT_THAT(refusal(scene), HasSubstr("drag"));
  scene.effects.drag.reset();
  scene.effects.magnus = 0.1;
  EXPECT_THAT(refusal(scene), HasSubstr("Magnus"));
  scene.effects.magnus.reset();
  scene.multi_contact = MultiContact::simultaneous;
  EXPECT_THAT(refusal(scene), HasSubstr("one pair at a time"));
  scene.multi_contact = MultiContact::sequential;
  scene.slabs.resize(1);
  EXPECT_THAT(refusal(scene), HasSubstr("slab"));
  scene.slabs.clear();
  scene.events.resize(1);
  EXPECT_THAT(refusal(scene), HasSubstr("person"));
  scene.events.clear();
  scene.balls[1].position.x() = 0.15;
  EXPECT_THAT(refusal(scene), HasSubstr("balls 0 and 1 start overlapping"));
  scene.balls[1].position.x() = 1.0;
  scene.walls = {{Vec3::UnitY(), 1.0}};
  EXPECT_THAT(refusal(scene), HasSubstr("ball 0 starts outside wall 0"));
  scene.walls = {{Vec3::UnitY(), 0.9}};
  EXPECT_EQ(refusal(scene), "");
  scene.effects.gravity = Vec3(0, -9.81, 0);
  EXPECT_THAT(refusal(scene), HasSubstr("ball 0 starts at rest on wall 0"));
}

TEST(ExactTruth, ImmovableBallsPassEachOther) {
  Scenario scene =
      scene_of({ball({-1, 0, 0}, {1, 0, 0}, kInfinity), ball({1, 0, 0}, {-1, 0, 0}, kInfinity)}, 2.0);
  scene.walls = {{Vec3::UnitX(), -1.5}};
  const Story story = certified(scene);
  EXPECT_FALSE(story.solution.known_until_s.has_value()) << story.solution.limit;
  EXPECT_EQ(story.solution.impact_count, 0);
  EXPECT_EQ(story.states.back()[0].position, Vec3(1, 0, 0));
}

}  // namespace
}  // namespace carom::test
