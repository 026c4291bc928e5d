#include "scenario/cast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "scenario/parse.h"
#include "tests/support/numbers.h"

namespace carom::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Two balls in a box, one second, ten frames; then what the test adds.
ScenarioPtr scene_with(const std::string& events) {
  return parse_scene(R"(title = "two"
dimension = 2
duration = 1.0
step = 0.01
frames = 10
[effects]
spin = true
[box]
min = [0, 0]
max = [4, 3]
[[ball]]
mass = 2
radius = 0.5
position = [1, 1]
velocity = [3, 4]
spin = 8
[[ball]]
mass = inf
radius = 0.25
position = [3, 2]
)" + events,
                     "test.toml");
}

std::string events_error(const std::string& events) {
  try {
    scene_with(events);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string click(double time, int ball) {
  return "[[event]]\ntime = " + std::to_string(time) + "\nball = " + std::to_string(ball) +
         "\nscale_mass = 2\n";
}

TEST(Cast, MassThatIsAdded_MovesAndTurnsAsTheBallDoes) {
  const ScenarioPtr scene = scene_with("[[event]]\ntime = 0.5\nball = 0\nscale_mass = 1.5\n");
  Cast cast(*scene);
  const std::vector<BallChange> changes = cast.take_next();
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].before->mass, 2.0);
  EXPECT_EQ(changes[0].after->mass, 3.0);
  EXPECT_EQ(cast[0]->velocity, Vec3(3, 4, 0));
  EXPECT_EQ(cast[0]->spin, Vec3(0, 0, 8));
  EXPECT_EQ(cast[0]->radius, 0.5);
}

TEST(Cast, ABallThatGrows_KeepsItsAngularMomentum_WhateverTheFactor) {
  Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const double factor = std::exp2(random.uniform(-10.0, 1.0));
    Scenario scene = *scene_with("");
    scene.events = {{0.5, 0, {ScaleRadius{factor}}}};
    Cast cast(scene);
    const Ball before = cast[0].value();
    cast.take_next();
    const Ball after = cast[0].value();
    const auto spin_of = [](const Ball& b) { return b.inertia * b.mass * b.radius * b.radius * b.spin.z(); };
    const auto energy_of = [&](const Ball& b) { return 0.5 * spin_of(b) * b.spin.z(); };
    EXPECT_NEAR(spin_of(after), spin_of(before), 8.0 * kEpsilon * spin_of(before)) << "factor " << factor;
    EXPECT_NEAR(energy_of(after) * factor * factor, energy_of(before), 12.0 * kEpsilon * energy_of(before));
    EXPECT_EQ(after.velocity, before.velocity);
    EXPECT_EQ(after.mass, before.mass);
  }
}

TEST(Cast, NumbersStay_ForBallsThatComeAndGo) {
  const std::string added = "add_ball = { mass = 1, radius = 0.1, position = [1, 2] }\n";
  // In the file the later comes first.
  const ScenarioPtr scene = scene_with("[[event]]\ntime = 0.6\n" + added + "[[event]]\ntime = 0.2\n" + added +
                                       "[[event]]\ntime = 0.4\nball = 2\nremove = true\n" + click(0.7, 3));
  EXPECT_EQ(numbered_balls(*scene), 4U);
  Cast cast(*scene);
  EXPECT_FALSE(cast[2]);
  cast.to_frame(2);
  EXPECT_TRUE(cast[2]);
  cast.to_frame(4);
  EXPECT_FALSE(cast[2]);
  EXPECT_FALSE(cast[3]);
  cast.to_frame(6);
  EXPECT_FALSE(cast[2]);
  EXPECT_TRUE(cast[3]);
  cast.to_frame(10);
  EXPECT_EQ(cast[3]->mass, 2.0);
  EXPECT_EQ(cast.next(), nullptr);
}

TEST(Cast, AFrameAtTheMomentOfAnEvent_ShowsWhatItDid_HoweverTheTimesWereRounded) {
  Scenario scene = *scene_with("");
  for (const double duration : {1.0, 0.3, 7.0, 1e-9, 1e9}) {
    for (const std::int64_t frames : {1, 3, 7, 10, 120, 1000}) {
      scene.duration_s = duration;
      scene.frames = frames;
      for (std::int64_t k = 0; k <= frames; ++k) {
        const double interval = duration / static_cast<double>(frames);
        EXPECT_EQ(first_frame_after(scene, {interval * static_cast<double>(k), 0, {}}), k);
        EXPECT_EQ(first_frame_after(scene, {frame_time_s(scene, k), 0, {}}), k);
        if (k == 0) continue;
        EXPECT_EQ(first_frame_after(scene, {(static_cast<double>(k) - 0.5) * interval, 0, {}}), k);
        EXPECT_EQ(first_frame_after(scene, {(static_cast<double>(k) - 0.99) * interval, 0, {}}), k);
      }
    }
  }
}

TEST(Cast, Ever_SeesWhatEventsMakeOfBalls) {
  const auto fast = [](const Ball& ball) { return ball.velocity.norm() > 100.0; };
  EXPECT_FALSE(ever(*scene_with(click(0.5, 0)), fast));
  EXPECT_TRUE(ever(*scene_with("[[event]]\ntime = 1\nball = 1\nset_velocity = [200, 0]\n"), fast));
}

// --- what the file may not ask for

TEST(Events, AboutABallThatIsNotThere_AreErrors_ThatNameThePlaceAndTheMoment) {
  const std::string gone = "[[event]]\ntime = 0.5\nball = 0\nremove = true\n";
  const std::string added =
      "[[event]]\ntime = 0.5\nadd_ball = { mass = 1, radius = 0.1, position = [1, 2] }\n";
  EXPECT_EQ(events_error(gone + click(0.4, 0)), "no error");
  EXPECT_THAT(
      events_error(gone + click(0.6, 0)),
      AllOf(HasSubstr("test.toml:27:"), HasSubstr("event[1].ball: found 0"), HasSubstr("at t = 0.6 s")));
  EXPECT_EQ(events_error(added + click(0.5, 2)), "no error");
  EXPECT_THAT(events_error(added + click(0.4, 2)), HasSubstr("event[1].ball: found 2"));
  EXPECT_THAT(events_error(click(0.4, 2)), HasSubstr("event[0].ball: found 2"));
}

TEST(Events, ThatMakeAnImpossibleBall_AreErrors) {
  const std::string event = "[[event]]\ntime = 0.5\nball = 0\n";
  EXPECT_THAT(events_error(event + "scale_mass = 1e308\n"),
              AllOf(HasSubstr("scale_mass"), HasSubstr("finite and above 0")));
  EXPECT_THAT(events_error(event + "scale_mass = 1e-323\n" + event + "scale_mass = 1e-10\n"),
              AllOf(HasSubstr("event[1].scale_mass"), HasSubstr("finite and above 0")));
  EXPECT_THAT(events_error(event + "scale_radius = 1e-323\n" + event + "scale_radius = 1e-10\n"),
              HasSubstr("event[1].scale_radius"));
  EXPECT_THAT(events_error(event + "scale_radius = 3.1\n"), HasSubstr("a diameter of 3.1 m"));
  EXPECT_EQ(events_error(event + "scale_radius = 2.9\n"), "no error");
}

}  // namespace
}  // namespace carom::test
