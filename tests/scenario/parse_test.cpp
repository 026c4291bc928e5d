#include "scenario/parse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "core/error.h"
#include "scenario/catalog.h"
#include "scenario/features.h"
#include "tests/support/folder.h"
#include "tests/support/numbers.h"

namespace carom::test {

namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double kInf = std::numeric_limits<double>::infinity();

// --- scenes that are right
// -----------------------------------------------------------------------------------

/// The least that is a scene.
const std::string kMinimal = R"(title = "One ball"
dimension = 2
duration = 1.0
step = 0.01
frames = 10
[[ball]]
mass = 2.0
radius = 0.5
position = [1.0, -2.0]
)";

/// Every table and every key of the format, each of them once or in tables that can be told apart. The wrong
/// scenes below are this one with one piece of text replaced.
const std::string kEverything = R"(title     = "Everything"
about     = "Every key there is."
dimension = 2
duration  = 2.0
step      = 0.004
frames    = 120

[effects]
gravity   = [0, -9.81]
drag      = { linear = 0.1 }
spin      = true
magnus    = 0.05
collisions = true

[contact]
restitution = 0.9
friction    = 0.2
tangential_restitution = 0.1
[contact.wall]
restitution = 0.8
friction = 0.3
tangential_restitution = 0.4

[box]
min = [0, 0]
max = [4, 3]
[[wall]]
normal = [0, 1]
offset = 0.0
[[slab]]
normal = [1, 0]
offset = 3.9
thickness = 0.01
[[barrier]]
normal = [1, 0]
offset = 2.5
thickness = 1.0
height = 1.0
hbar = 1.0
seed = 3

[[ball]]
mass     = 1.0
radius   = 0.1
position = [1.0, 1.5]
velocity = [1.0, 0.0]
spin     = 0.0
inertia  = 0.4

[[balls]]
kind     = "gas"
count    = 10
seed     = 7
radius   = [0.04, 0.06]
mass     = 1.5
packing  = 0.01
speed    = 1.25

[[balls]]
kind     = "line"
count    = 3
radius   = 0.02
density  = 2.0
position = [0.1, 2.9]
direction = [1, 0]
gap      = 0.01

[[event]]
time  = 1.0
ball  = 0
scale_mass   = 1.1
scale_radius = 1.05
set_velocity = [1, 1]
set_position = [0.5, 0.5]
[[event]]
time = 0.5
ball = 1
remove = true
[[event]]
time = 0.75
add_ball = { mass = 3.0, radius = 0.03, position = [0.2, 0.2] }

[truth]
kind = "auto"

[gate]
energy = 1e-9
escaped = 0
[gate.box2d]
position = 1e-4
)";

const std::vector<std::string> kEngines = {"carom", "box2d"};

ScenarioPtr parse(const std::string& text) {
  return parse_scene(text, "scene.toml", {{}, {}, kEngines});
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what << " is not in the scene";
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

std::string error_of(const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Parse, MinimalScene_HasTheDefaults) {
  const ScenarioPtr scene = parse(kMinimal);
  EXPECT_EQ(scene->title, "One ball");
  EXPECT_EQ(scene->about, "");
  EXPECT_EQ(scene->dimension, 2);
  EXPECT_EQ(scene->duration_s, 1.0);
  EXPECT_EQ(scene->step_s, 0.01);
  EXPECT_EQ(scene->frames, 10);
  EXPECT_FALSE(scene->effects.gravity);
  EXPECT_FALSE(scene->effects.drag);
  EXPECT_FALSE(scene->effects.spin);
  EXPECT_FALSE(scene->effects.magnus);
  EXPECT_TRUE(scene->effects.collisions);
  for (const Contact& contact : {scene->ball_contact, scene->wall_contact}) {
    EXPECT_EQ(contact.restitution, 1.0);
    EXPECT_EQ(contact.friction, 0.0);
    EXPECT_EQ(contact.tangential_restitution, 0.0);
  }
  EXPECT_FALSE(scene->box);
  EXPECT_TRUE(scene->walls.empty() && scene->slabs.empty() && scene->barriers.empty() &&
              scene->events.empty());
  EXPECT_EQ(scene->truth, TruthKind::automatic);
  EXPECT_TRUE(scene->gate.under_test.empty() && scene->gate.per_engine.empty());
  ASSERT_EQ(scene->balls.size(), 1U);
  const Ball& ball = scene->balls.front();
  EXPECT_EQ(ball.mass, 2.0);
  EXPECT_EQ(ball.radius, 0.5);
  EXPECT_EQ(ball.position, Vec3(1.0, -2.0, 0.0));
  EXPECT_EQ(ball.velocity, Vec3(0.0, 0.0, 0.0));
  EXPECT_EQ(ball.spin, Vec3(0.0, 0.0, 0.0));
  EXPECT_EQ(ball.inertia, 0.4);
}

TEST(Parse, EffectsContactsAndSolids_AreRead) {
  const ScenarioPtr scene = parse(kEverything);
  EXPECT_EQ(scene->about, "Every key there is.");
  EXPECT_EQ(scene->effects.gravity, Vec3(0.0, -9.81, 0.0));
  ASSERT_TRUE(scene->effects.drag);
  EXPECT_EQ(scene->effects.drag->kind, Drag::Kind::linear);
  EXPECT_EQ(scene->effects.drag->coefficient, 0.1);
  EXPECT_TRUE(scene->effects.spin);
  EXPECT_EQ(scene->effects.magnus, 0.05);
  EXPECT_EQ(scene->ball_contact.restitution, 0.9);
  EXPECT_EQ(scene->ball_contact.friction, 0.2);
  EXPECT_EQ(scene->ball_contact.tangential_restitution, 0.1);
  EXPECT_EQ(scene->wall_contact.restitution, 0.8);
  EXPECT_EQ(scene->wall_contact.friction, 0.3);
  EXPECT_EQ(scene->wall_contact.tangential_restitution, 0.4);
  ASSERT_EQ(scene->slabs.size(), 1U);
  EXPECT_EQ(scene->slabs.front().offset, 3.9);
  EXPECT_EQ(scene->slabs.front().thickness, 0.01);
  ASSERT_EQ(scene->barriers.size(), 1U);
  EXPECT_EQ(scene->barriers.front().height, 1.0);
  EXPECT_EQ(scene->barriers.front().hbar, 1.0);
  EXPECT_EQ(scene->barriers.front().seed, 3U);
}

TEST(Parse, BallsEventsAndGates_AreRead) {
  const ScenarioPtr scene = parse(kEverything);
  EXPECT_EQ(scene->balls.size(), 1U + 10U + 3U);
  EXPECT_EQ(scene->gate.under_test, (Limits{{Metric::energy, 1e-9}, {Metric::escaped, 0.0}}));
  EXPECT_EQ(scene->gate.per_engine.at("box2d"), (Limits{{Metric::position, 1e-4}}));
  ASSERT_EQ(scene->events.size(), 3U);
  EXPECT_EQ(scene->events[0].ball, 1U);
  EXPECT_TRUE(std::holds_alternative<RemoveBall>(scene->events[0].actions.at(0)));
  const auto& added = std::get<AddBall>(scene->events[1].actions.at(0));
  EXPECT_EQ(added.ball.mass, 3.0);
  EXPECT_EQ(added.ball.position, Vec3(0.2, 0.2, 0.0));
  const Event& clicked = scene->events[2];
  ASSERT_EQ(clicked.actions.size(), 4U);
  EXPECT_EQ(std::get<ScaleMass>(clicked.actions[0]).factor, 1.1);
  EXPECT_EQ(std::get<ScaleRadius>(clicked.actions[1]).factor, 1.05);
  EXPECT_EQ(std::get<SetVelocity>(clicked.actions[2]).velocity, Vec3(1.0, 1.0, 0.0));
  EXPECT_EQ(std::get<SetPosition>(clicked.actions[3]).position, Vec3(0.5, 0.5, 0.0));
}

/// The example with which the format is documented: all of its tables and keys at once.
TEST(Parse, DocumentedExample_IsAccepted) {
  const ScenarioPtr scene = parse(R"(
title     = "Head-on, equal masses"
about     = "Two equal balls exchange their velocities."     # Markdown, shown in the report
dimension = 2            # 2 or 3
duration  = 2.0          # s
step      = 0.004        # s
frames    = 120
[effects]
gravity   = [0, -9.81]                  # m/s²
drag      = { linear = 0.1 }            # kg/s
spin      = true
magnus    = 0.05                        # kg:    F = s ω × v
collisions = true
[contact]
restitution = 1.0
friction    = 0.0
tangential_restitution = 0.0
[contact.wall]
[box]
min = [0, 0]
max = [4, 3]
[[wall]]
normal = [0, 1]
offset = 0.0
[[slab]]
normal = [1, 0]
offset = 2.0
thickness = 0.01
[[barrier]]
normal = [1, 0]
offset = 2.0
thickness = 1.0
height = 1.0
hbar = 1.0
[[ball]]
mass     = 1.0
radius   = 0.1
position = [1.0, 1.5]
velocity = [1.0, 0.0]
spin     = 0.0
inertia  = 0.4
[[balls]]
kind     = "gas"
count    = 1000
seed     = 7
radius   = [0.04, 0.06]
mass     = 1.0
packing  = 0.1
speed    = 1.0
[[event]]
time  = 1.0
ball  = 0
scale_mass   = 1.1
scale_radius = 1.05
[truth]
kind = "auto"
[gate]
energy = 1e-9
momentum = 1e-12
angular_momentum = 1e-12
position = 1e-6
penetration = 1e-6
escaped = 0
[gate.box2d]
energy = 1e-4
)");
  EXPECT_EQ(scene->balls.size(), 1001U);
  EXPECT_EQ(scene->walls.size(), 5U);
  EXPECT_EQ(scene->gate.under_test.size(), 6U);
  // A thousand balls of 0.05 m fill 0.65 of the box, so the radii had to give way, and the reader is told.
  EXPECT_THAT(scene->notes, ElementsAre(HasSubstr("radius")));
}

TEST(Parse, Space_HasVectorsOfThreeComponents) {
  const ScenarioPtr scene = parse(R"(title = "3D"
dimension = 3
duration = 1
step = 1
frames = 1
[effects]
spin = true
[box]
min = [-1, -2, -3]
max = [1, 2, 3]
[[ball]]
mass = inf
radius = 0.1
position = [0.1, 0.2, 0.3]
velocity = [1, 2, 3]
spin = [4, 5, 6]
)");
  EXPECT_EQ(scene->balls[0].mass, kInf);
  EXPECT_EQ(scene->balls[0].position, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(scene->balls[0].spin, Vec3(4.0, 5.0, 6.0));
  ASSERT_EQ(scene->walls.size(), 6U);
  EXPECT_EQ(scene->walls[4].normal, Vec3(0.0, 0.0, 1.0));
  EXPECT_EQ(scene->walls[4].offset, -3.0);
  EXPECT_EQ(scene->walls[5].normal, Vec3(0.0, 0.0, -1.0));
  EXPECT_EQ(scene->walls[5].offset, -3.0);
}

TEST(Parse, BoxWalls_StandBeforeTheOthers) {
  const ScenarioPtr scene = parse(kEverything);
  ASSERT_EQ(scene->walls.size(), 5U);
  const std::vector<Vec3> normals = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 1, 0}};
  const std::vector<double> offsets = {0, -4, 0, -3, 0};
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_EQ(scene->walls[i].normal, normals[i]) << i;
    EXPECT_EQ(scene->walls[i].offset, offsets[i]) << i;
  }
}

TEST(Parse, SpinInThePlane_IsAboutZ) {
  EXPECT_EQ(parse(replaced(kEverything, "spin     = 0.0", "spin = -2.5"))->balls[0].spin,
            Vec3(0.0, 0.0, -2.5));
}

TEST(Parse, QuadraticDrag_IsRead) {
  const ScenarioPtr scene = parse(replaced(kEverything, "{ linear = 0.1 }", "{ quadratic = 0.02 }"));
  EXPECT_EQ(scene->effects.drag->kind, Drag::Kind::quadratic);
  EXPECT_EQ(scene->effects.drag->coefficient, 0.02);
}

TEST(Parse, WallContact_InheritsWhatItDoesNotSay) {
  const std::string ball = kMinimal.substr(kMinimal.find("[[ball]]"));
  const std::string top = kMinimal.substr(0, kMinimal.find("[[ball]]"));
  const ScenarioPtr alone = parse(top + "[contact]\nrestitution = 0.5\n" + ball);
  EXPECT_EQ(alone->wall_contact.restitution, 0.5);
  const std::string spin = "[effects]\nspin = true\n";
  const ScenarioPtr both = parse(top + spin + "[contact]\nrestitution = 0.5\nfriction = 0.25\n" +
                                 "tangential_restitution = -1\n[contact.wall]\nfriction = 0.75\n" + ball);
  EXPECT_EQ(both->ball_contact.friction, 0.25);
  EXPECT_EQ(both->wall_contact.restitution, 0.5);
  EXPECT_EQ(both->wall_contact.friction, 0.75);
  EXPECT_EQ(both->wall_contact.tangential_restitution, -1.0);
  const ScenarioPtr wall = parse(top + "[contact.wall]\nrestitution = 0.5\n" + ball);
  EXPECT_EQ(wall->ball_contact.restitution, 1.0);
  EXPECT_EQ(wall->wall_contact.restitution, 0.5);
}

// A normal of any length, also of one whose square is no double, says the same as the unit vector along it.
// The unit vector and the offset take a square root and a division, each rounded once: 4 ε covers them.
TEST(Parse, WallNormal_IsMadeAUnitVectorAndTheOffsetGoesWithIt) {
  for (const char* scale : {"", "e-200", "e200", "e-3"}) {
    std::string wall = "[[wall]]\nnormal = [3.0";
    wall.append(scale).append(", 4.0").append(scale).append("]\noffset = 10.0").append(scale).append("\n");
    const ScenarioPtr scene = parse(kMinimal + wall);
    const Wall& read = scene->walls.at(0);
    EXPECT_NEAR(read.normal.x(), 0.6, 4.0 * kEpsilon) << scale;
    EXPECT_NEAR(read.normal.y(), 0.8, 4.0 * kEpsilon) << scale;
    EXPECT_EQ(read.normal.z(), 0.0) << scale;
    EXPECT_NEAR(read.offset, 2.0, 8.0 * kEpsilon) << scale;
  }
}

TEST(Parse, Events_AreInTheOrderOfTimeAndThenOfTheFile) {
  std::string text = kMinimal;
  for (const auto& [time, factor] : {std::pair("1.0", "2"), {"0.5", "3"}, {"1.0", "4"}, {"0", "5"}}) {
    text += std::string("[[event]]\nball = 0\ntime = ") + time + "\nscale_mass = " + factor + "\n";
  }
  const ScenarioPtr scene = parse(text);
  std::vector<double> factors;
  for (const Event& event : scene->events) {
    factors.push_back(std::get<ScaleMass>(event.actions.at(0)).factor);
  }
  EXPECT_THAT(factors, ElementsAre(5.0, 3.0, 2.0, 4.0));
}

TEST(Parse, Options_ReplaceStepAndSeed) {
  EXPECT_EQ(parse_scene(kEverything, "scene.toml", {0.125, {}, {}})->step_s, 0.125);
  const auto gas_with_seed = [](const std::optional<std::uint64_t>& seed) {
    return parse_scene(kEverything, "scene.toml", {{}, seed, {}})->balls.at(1).position;
  };
  EXPECT_EQ(gas_with_seed({}), gas_with_seed(7));
  EXPECT_NE(gas_with_seed(8), gas_with_seed(7));
}

// Placing ten million balls takes its time; their number is known first.
TEST(Parse, MoreBallsThanTheReaderTakes_AreRefusedBeforeOneIsPlaced) {
  const std::string far_ball = "[[ball]]\nmass = 1\nradius = 0.1\nposition = [5, 5]\n";
  const std::string box = kMinimal + "[box]\nmin = [-4, -4]\nmax = [9, 9]\n" + far_ball;
  const auto lattice = [](const std::string& count) {
    return "[[balls]]\nkind = \"lattice\"\nradius = 0.1\nmass = 1\nposition = [1, 6]\ngap = 0.1\ncount = " +
           count + "\n";
  };
  const auto refused = [](const std::string& text) -> std::string {
    try {
      parse_scene(text, "scene.toml", {{}, {}, {}, 12});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(parse_scene(box + lattice("10"), "scene.toml", {{}, {}, {}, 12})->balls.size(), 12U);
  EXPECT_THAT(
      refused(box + lattice("11")),
      HasSubstr("balls[0].count: found 11 balls beside 2 others, allowed here: at most 12 balls in all"));
  // The first table would not fit, the second is too many: that is told first, so nothing was placed.
  const std::string too_wide = "[[balls]]\nkind = \"gas\"\nradius = 50\nmass = 1\ncount = 9\n";
  EXPECT_THAT(refused(box + too_wide), Not(HasSubstr("balls in all")));
  EXPECT_THAT(refused(box + too_wide + lattice("10000000")),
              HasSubstr("balls[1].count: found 10000000 balls beside 11 others, allowed here: at most 12"));
  const std::string added =
      "[[event]]\ntime = 0.5\nadd_ball = { mass = 1.0, radius = 0.1, position = [8, 8] }\n";
  EXPECT_THAT(refused(box + lattice("9") + added + added),
              HasSubstr("event[1].add_ball: found 1 ball beside 12 others"));
  std::string one_by_one = kMinimal;
  for (int i = 0; i < 12; ++i) one_by_one += far_ball;
  EXPECT_THAT(refused(one_by_one), HasSubstr("ball[12]: found 1 ball beside 12 others"));
}

TEST(Parse, EnginesOfTheGate_AreAnyWhenNoneAreKnown) {
  const std::string text = kMinimal + "[gate.\"my-engine:odd\"]\nenergy = 1\n";
  EXPECT_EQ(parse_scene(text, "scene.toml")->gate.per_engine.count("my-engine:odd"), 1U);
}

// The digest of these bytes as sha256sum(1) prints it.
TEST(Parse, Sha256_IsThatOfTheBytes) {
  EXPECT_EQ(parse(kMinimal)->sha256, "345a9981a9e8bbde149a35bd4b66b8fe9383e91d2a936e905c557def70d46702");
}

TEST(Parse, LineEndingsAndByteOrderMark_DoNotMatter) {
  std::string windows = "\xEF\xBB\xBF";
  for (const char letter : kMinimal) windows += letter == '\n' ? "\r\n" : std::string(1, letter);
  EXPECT_EQ(parse(windows)->balls.size(), 1U);
}

// --- scenes that are wrong
// -----------------------------------------------------------------------------------

/// A scene that is wrong in one place: `what` of kEverything is replaced by `by`, in which '@' marks the
/// place that the error must name. Where `what` is empty, `by` is what follows kMinimal.
TEST(ParseSymmetries, AreThoseNamedInTheirOrder_OrAll_OrNone) {
  const auto symmetries = [](const std::string& more) {
    return parse_scene(kMinimal + more, "scene.toml")->symmetries;
  };
  EXPECT_TRUE(symmetries("").empty());
  EXPECT_THAT(symmetries("[symmetry]\nchecks = [\"reverse\", \"mirror\"]"),
              ElementsAre(Symmetry::reverse, Symmetry::mirror));
  EXPECT_EQ(symmetries("[symmetry]\nchecks = \"all\"").size(), kSymmetryNames.size());
}

struct Wrong {
  std::string name;
  std::string what;
  std::string by;
  std::string key;
  std::vector<std::string> says;
};

std::ostream& operator<<(std::ostream& out, const Wrong& wrong) {
  return out << wrong.by;
}

class ParseWrong : public ::testing::TestWithParam<Wrong> {};

TEST_P(ParseWrong, Scene_IsRefusedWithPlaceKeyFoundAndAllowed) {
  const Wrong& wrong = GetParam();
  std::string text = wrong.what.empty() ? kMinimal + wrong.by : replaced(kEverything, wrong.what, wrong.by);
  const std::size_t place = text.find('@');
  ASSERT_NE(place, std::string::npos);
  text.erase(place, 1);
  const std::string before = text.substr(0, place);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t column = place - (before.rfind('\n') + 1) + 1;
  const std::string message = error_of(text);
  EXPECT_THAT(message, StartsWith("scene.toml:" + std::to_string(line) + ":" + std::to_string(column) + ": " +
                                  wrong.key + ": "));
  for (const std::string& words : wrong.says) EXPECT_THAT(message, HasSubstr(words));
}

std::string name_of_case(const ::testing::TestParamInfo<Wrong>& info) {
  return info.param.name;
}

const std::string kAllowedFinite = "allowed: a finite number";
const std::string kAllowedPositive = "allowed: a finite number > 0";
const std::string kAllowedNotNegative = "allowed: a finite number >= 0";
const std::string kAllowedUnit = "allowed: a number in [0, 1]";
const std::string kAllowedPair = "allowed: an array of 2 finite numbers";

const std::vector<Wrong> kUnknownKey = {

    {"Scene", "frames    =", "@colour = 1\nframes    =", "colour", {"unknown key, allowed: ", "duration"}},
    {"Table", "[effects]", "[@fields]\n[effects]", "fields", {"unknown key", "effects"}},
    {"Effects", "[effects]", "[effects]\n@wind = 1", "effects.wind", {"unknown key", "gravity"}},
    {"Drag",
     "{ linear = 0.1 }",
     "{ linear = 0.1, @cubic = 1 }",
     "effects.drag.cubic",
     {"unknown key, allowed: linear, quadratic"}},
    {"Contact", "[contact]", "[contact]\n@mu = 1", "contact.mu", {"unknown key", "friction"}},
    {"ContactWall", "[contact.wall]", "[contact.wall]\n@mu = 1", "contact.wall.mu", {"friction"}},
    {"Box", "[box]", "[box]\n@size = 1", "box.size", {"unknown key, allowed: min, max"}},
    {"Wall", "[[wall]]", "[[wall]]\n@thickness = 1", "wall[0].thickness", {"allowed: normal, offset"}},
    {"Slab", "[[slab]]", "[[slab]]\n@height = 1", "slab[0].height", {"unknown key", "thickness"}},
    {"Barrier", "[[barrier]]", "[[barrier]]\n@width = 1", "barrier[0].width", {"unknown key", "hbar"}},
    {"Ball", "[[ball]]", "[[ball]]\n@colour = 1", "ball[0].colour", {"unknown key", "inertia"}},
    {"Balls", "[[balls]]", "[[balls]]\n@temperature = 1", "balls[0].temperature", {"packing"}},
    {"GasGap", "packing  =", "@gap = 1\npacking =", "balls[0].gap", {"unknown key"}},
    {"LinePacking", "density  =", "@packing = 0.1\ndensity =", "balls[1].packing", {"unknown key"}},
    {"Event", "[[event]]", "[[event]]\n@paint = 1", "event[0].paint", {"unknown key", "scale_mass"}},
    {"AddedBall", "{ mass = 3.0,", "{ @hue = 1, mass = 3.0,", "event[2].add_ball.hue", {"unknown key"}},
    {"Truth", "[truth]", "[truth]\n@source = 1", "truth.source", {"unknown key, allowed: kind"}},
    {"Gate", "[gate]", "[gate]\n@speed = 1", "gate.speed", {"unknown key", "penetration"}},
    {"GateOfEngine", "[gate.box2d]", "[gate.box2d]\n@speed = 1", "gate.box2d.speed", {"penetration"}},
    {"Engine", "[gate.box2d]", "@[gate.havok]", "gate.havok", {"unknown engine", "carom, box2d"}},
};
INSTANTIATE_TEST_SUITE_P(UnknownKey, ParseWrong, ::testing::ValuesIn(kUnknownKey), name_of_case);

const std::vector<Wrong> kSymmetry = {
    {"Unknown",
     "",
     "[symmetry]\nchecks = [\"mirror\", @\"shear\"]",
     "symmetry.checks",
     {"found 'shear'", "allowed: \"mirror\", \"rotate-90\"", "\"reverse\""}},
    {"Word",
     "",
     "[symmetry]\nchecks = @\"every\"",
     "symmetry.checks",
     {"found 'every'", "allowed: \"all\", or"}},
    {"Number", "", "[symmetry]\nchecks = [@1]", "symmetry.checks", {"found 1"}},
    {"None", "", "[symmetry]\nchecks = @[]", "symmetry.checks", {"found []", "allowed: \"all\", or"}},
    {"Twice", "", "[symmetry]\nchecks = [\"boost\", @\"boost\"]", "symmetry.checks", {"each of them once"}},
    {"Missing", "", "@[symmetry]\n", "symmetry.checks", {"is missing", "\"all\""}},
    {"Key", "", "[symmetry]\n@scale = 2\nchecks = \"all\"", "symmetry.scale", {"unknown key", "checks"}},
    {"Table", "", "@symmetry = \"all\"", "ball[0].symmetry", {"unknown key"}},
};
INSTANTIATE_TEST_SUITE_P(SymmetryTable, ParseWrong, ::testing::ValuesIn(kSymmetry), name_of_case);

const std::vector<Wrong> kWrongType = {

    {"Title", "\"Everything\"", "@7", "title", {"found 7", "allowed: a string"}},
    {"About", "\"Every key there is.\"", "@true", "about", {"found true", "allowed: a string"}},
    {"DimensionReal", "= 2\nduration", "= @2.0\nduration", "dimension", {"found 2.0", "from 2 to 3"}},
    {"DimensionWord", "= 2\nduration", "= @'2'\nduration", "dimension", {"found '2'", "from 2 to 3"}},
    {"Duration", "= 2.0\nstep", "= @\"2\"\nstep", "duration", {"found '2'", kAllowedPositive}},
    {"Step", "= 0.004", "= @true", "step", {"found true", kAllowedPositive}},
    {"Frames", "= 120", "= @120.0", "frames", {"found 120.0", "allowed: an integer from 1 to"}},
    {"Effects", "[effects]", "@[[effects]]", "effects", {"found", "allowed: a table"}},
    {"Gravity", "[0, -9.81]", "@-9.81", "effects.gravity", {"found -9.81", kAllowedPair}},
    {"GravityWord", "[0, -9.81]", "[0, @\"down\"]", "effects.gravity", {"down", kAllowedFinite}},
    {"Drag", "{ linear = 0.1 }", "@0.1", "effects.drag", {"found 0.1", "allowed: a table"}},
    {"Spin", "spin      = true", "spin = @1", "effects.spin", {"found 1", "allowed: true or false"}},
    {"Collisions", "collisions = true", "collisions = @'no'", "effects.collisions", {"true or false"}},
    {"WallTable", "[[wall]]\n", "@[wall]\n", "wall", {"found a table", "[[wall]]"}},
    {"SpinVector", "spin     = 0.0", "spin = @[0, 0, 1]", "ball[0].spin", {kAllowedFinite}},
    {"Date", "radius   = 0.1", "radius = @1979-05-27", "ball[0].radius", {"1979-05-27", kAllowedPositive}},
    {"Kind",
     "\"gas\"",
     "@\"liquid\"",
     "balls[0].kind",
     {"liquid", "allowed: \"gas\", \"lattice\", \"line\""}},
    {"KindNumber", "\"gas\"", "@1", "balls[0].kind", {"found 1", "\"gas\""}},
    {"Count", "= 10\n", "= @10.5\n", "balls[0].count", {"found 10.5", "allowed: an integer from 1 to"}},
    {"Seed", "= 7\n", "= @'seven'\n", "balls[0].seed", {"found 'seven'", "allowed: an integer from 0"}},
    {"EventBall", "ball  = 0", "ball = @'first'", "event[0].ball", {"found 'first'", "from 0 to 14"}},
    {"Remove", "remove = true", "remove = @1", "event[1].remove", {"found 1", "true or false"}},
    {"TruthKind", "\"auto\"", "@\"best\"", "truth.kind", {"best", "\"closed-form\"", "\"none\""}},
    {"Limit", "energy = 1e-9", "energy = @'low'", "gate.energy", {"found 'low'", kAllowedNotNegative}},
    {"GateOfEngine", "[gate.box2d]\nposition = 1e-4", "@box2d = 1e-4", "gate.box2d", {"unknown key"}},
};
INSTANTIATE_TEST_SUITE_P(WrongType, ParseWrong, ::testing::ValuesIn(kWrongType), name_of_case);

const std::vector<Wrong> kWrongLength = {

    {"Gravity", "[0, -9.81]", "@[0, 0, -9.81]", "effects.gravity", {"found [ 0, 0, -9.81 ]", kAllowedPair}},
    {"GravityEmpty", "[0, -9.81]", "@[]", "effects.gravity", {"found []", kAllowedPair}},
    {"BoxMin", "min = [0, 0]", "min = @[0]", "box.min", {"found [ 0 ]", kAllowedPair}},
    {"BoxMax", "max = [4, 3]", "max = @[4, 3, 2, 1, 0]", "box.max", {"an array of 5", kAllowedPair}},
    {"Normal", "normal = [0, 1]", "normal = @[1]", "wall[0].normal", {kAllowedPair}},
    {"Position", "= [1.0, 1.5]", "= @[1.0, 1.5, 0.0]", "ball[0].position", {kAllowedPair}},
    {"Velocity", "= [1.0, 0.0]", "= @[1.0]", "ball[0].velocity", {kAllowedPair}},
    {"RadiusOne", "[0.04, 0.06]", "@[0.04]", "balls[0].radius", {"found [ 0.04 ]", "[low, high]"}},
    {"RadiusThree", "[0.04, 0.06]", "@[0.04, 0.05, 0.06]", "balls[0].radius", {"[low, high]"}},
    {"Direction", "direction = [1, 0]", "direction = @[1]", "balls[1].direction", {kAllowedPair}},
    {"SetVelocity", "[1, 1]", "@[1, 1, 1]", "event[0].set_velocity", {kAllowedPair}},
    {"SetPosition", "[0.5, 0.5]", "@[]", "event[0].set_position", {kAllowedPair}},
};
INSTANTIATE_TEST_SUITE_P(WrongLength, ParseWrong, ::testing::ValuesIn(kWrongLength), name_of_case);

const std::vector<Wrong> kNotFinite = {

    {"Duration", "= 2.0\nstep", "= @inf\nstep", "duration", {"found inf", kAllowedPositive}},
    {"Step", "= 0.004", "= @nan", "step", {"found nan", kAllowedPositive}},
    {"Gravity", "[0, -9.81]", "[0, @-inf]", "effects.gravity", {"found -inf", kAllowedFinite}},
    {"Drag", "linear = 0.1", "linear = @inf", "effects.drag.linear", {"found inf", kAllowedNotNegative}},
    {"Magnus", "= 0.05\n", "= @nan\n", "effects.magnus", {"found nan", kAllowedFinite}},
    {"Restitution", "= 0.9", "= @nan", "contact.restitution", {"found nan", kAllowedUnit}},
    {"Friction", "= 0.2", "= @inf", "contact.friction", {"found inf", kAllowedNotNegative}},
    {"Tangential", "= 0.1\n[", "= @nan\n[", "contact.tangential_restitution", {"found nan", "[-1, 1]"}},
    {"BoxMin", "min = [0, 0]", "min = [0, @nan]", "box.min", {"found nan", kAllowedFinite}},
    {"BoxMax", "max = [4, 3]", "max = [@inf, 3]", "box.max", {"found inf", kAllowedFinite}},
    {"Normal", "normal = [0, 1]", "normal = [0, @inf]", "wall[0].normal", {"found inf", kAllowedFinite}},
    {"Offset", "offset = 0.0", "offset = @inf", "wall[0].offset", {"found inf", kAllowedFinite}},
    {"Thickness", "thickness = 0.01", "thickness = @inf", "slab[0].thickness", {kAllowedPositive}},
    {"Height", "height = 1.0", "height = @inf", "barrier[0].height", {kAllowedNotNegative}},
    {"Hbar", "hbar = 1.0", "hbar = @nan", "barrier[0].hbar", {"found nan", kAllowedPositive}},
    {"Mass", "mass     = 1.0", "mass = @nan", "ball[0].mass", {"found nan", "allowed: a number > 0, or inf"}},
    {"Radius", "radius   = 0.1", "radius = @inf", "ball[0].radius", {"found inf", kAllowedPositive}},
    {"Position", "[1.0, 1.5]", "[1.0, @nan]", "ball[0].position", {"found nan", kAllowedFinite}},
    {"Velocity", "[1.0, 0.0]", "[@nan, 0.0]", "ball[0].velocity", {"found nan", kAllowedFinite}},
    {"Spin", "spin     = 0.0", "spin = @inf", "ball[0].spin", {"found inf", kAllowedFinite}},
    {"Inertia", "inertia  = 0.4", "inertia = @nan", "ball[0].inertia", {"found nan", "(0, 1]"}},
    {"BallsRadius", "[0.04, 0.06]", "[0.04, @inf]", "balls[0].radius", {"found inf", kAllowedPositive}},
    {"BallsMass", "mass     = 1.5", "mass = @inf", "balls[0].mass", {"found inf", kAllowedPositive}},
    {"Speed", "= 1.25", "= @inf", "balls[0].speed", {"found inf", kAllowedNotNegative}},
    {"EventTime", "time  = 1.0", "time = @nan", "event[0].time", {"found nan", "duration"}},
    {"ScaleMass", "= 1.1", "= @inf", "event[0].scale_mass", {"found inf", kAllowedPositive}},
    {"SetVelocity", "[1, 1]", "[1, @inf]", "event[0].set_velocity", {"found inf", kAllowedFinite}},
    {"Limit", "energy = 1e-9", "energy = @nan", "gate.energy", {"found nan", kAllowedNotNegative}},
};
INSTANTIATE_TEST_SUITE_P(NotFinite, ParseWrong, ::testing::ValuesIn(kNotFinite), name_of_case);

const std::vector<Wrong> kOutOfRange = {

    {"DimensionOne", "= 2\nduration", "= @1\nduration", "dimension", {"found 1", "from 2 to 3"}},
    {"DimensionFour", "= 2\nduration", "= @4\nduration", "dimension", {"found 4", "from 2 to 3"}},
    {"DurationZero", "= 2.0\nstep", "= @0\nstep", "duration", {"found 0", kAllowedPositive}},
    {"DurationNegative", "= 2.0\nstep", "= @-1.5\nstep", "duration", {"found -1.5", kAllowedPositive}},
    {"StepZero", "= 0.004", "= @0.0", "step", {"found 0.0", kAllowedPositive}},
    {"StepNegative", "= 0.004", "= @-0.004", "step", {"found -0.004", kAllowedPositive}},
    // More steps than a 64-bit integer counts.
    {"StepWithoutEnd", "= 0.004", "= @1e-300", "step", {"found 1e-300", "allowed"}},
    {"FramesZero", "= 120", "= @0", "frames", {"found 0", "allowed: an integer from 1 to"}},
    {"FramesNegative", "= 120", "= @-1", "frames", {"found -1", "allowed: an integer from 1 to"}},
    {"FramesMany", "= 120", "= @9000000000", "frames", {"found 9000000000", "allowed: an integer"}},
    {"LinearDrag",
     "linear = 0.1",
     "linear = @-0.1",
     "effects.drag.linear",
     {"found -0.1", kAllowedNotNegative}},
    {"QuadraticDrag",
     "linear = 0.1",
     "quadratic = @-0.1",
     "effects.drag.quadratic",
     {"found -0.1", kAllowedNotNegative}},
    {"Restitution", "= 0.9", "= @1.0001", "contact.restitution", {"found 1.0001", kAllowedUnit}},
    {"RestitutionNegative", "= 0.9", "= @-0.1", "contact.restitution", {"found -0.1", kAllowedUnit}},
    {"Friction", "= 0.2", "= @-0.2", "contact.friction", {"found -0.2", kAllowedNotNegative}},
    {"Tangential", "= 0.1\n[", "= @1.1\n[", "contact.tangential_restitution", {"found 1.1", "[-1, 1]"}},
    {"TangentialLow", "= 0.1\n[", "= @-1.1\n[", "contact.tangential_restitution", {"found -1.1"}},
    {"WallRestitution", "= 0.8", "= @2", "contact.wall.restitution", {"found 2", kAllowedUnit}},
    {"WallFriction", "= 0.3", "= @-1", "contact.wall.friction", {"found -1", kAllowedNotNegative}},
    {"WallTangential",
     "= 0.4\n\n[box]",
     "= @-2\n\n[box]",
     "contact.wall.tangential_restitution",
     {"found -2", "[-1, 1]"}},
    {"BoxFlat", "max = [4, 3]", "max = @[4, 0]", "box.max", {"found [ 4, 0 ]", "allowed"}},
    {"BoxInsideOut", "max = [4, 3]", "max = @[-4, 3]", "box.max", {"found [ -4, 3 ]", "allowed"}},
    {"ZeroNormal", "normal = [0, 1]", "normal = @[0, 0]", "wall[0].normal", {"found", "allowed"}},
    {"SlabThickness", "thickness = 0.01", "thickness = @0", "slab[0].thickness", {kAllowedPositive}},
    {"BarrierThickness", "thickness = 1.0", "thickness = @-1", "barrier[0].thickness", {kAllowedPositive}},
    {"Height", "height = 1.0", "height = @-1", "barrier[0].height", {"found -1", kAllowedNotNegative}},
    {"Hbar", "hbar = 1.0", "hbar = @0", "barrier[0].hbar", {"found 0", kAllowedPositive}},
    {"BarrierSeed", "seed = 3", "seed = @-3", "barrier[0].seed", {"found -3", "from 0"}},
    {"MassZero", "mass     = 1.0", "mass = @0", "ball[0].mass", {"found 0", "allowed: a number > 0, or inf"}},
    {"MassNegative", "mass     = 1.0", "mass = @-1", "ball[0].mass", {"found -1"}},
    {"Radius", "radius   = 0.1", "radius = @0.0", "ball[0].radius", {"found 0.0", kAllowedPositive}},
    {"InertiaZero", "inertia  = 0.4", "inertia = @0", "ball[0].inertia", {"found 0", "(0, 1]"}},
    {"InertiaLarge", "inertia  = 0.4", "inertia = @1.01", "ball[0].inertia", {"found 1.01", "(0, 1]"}},
    {"CountZero", "= 10\n", "= @0\n", "balls[0].count", {"found 0", "allowed: an integer from 1 to"}},
    {"CountNegative", "= 10\n", "= @-10\n", "balls[0].count", {"found -10"}},
    {"Seed", "= 7\n", "= @-7\n", "balls[0].seed", {"found -7", "allowed: an integer from 0 to"}},
    {"BallsRadius", "[0.04, 0.06]", "@-0.04", "balls[0].radius", {"found -0.04", kAllowedPositive}},
    {"BallsRadiusLow", "[0.04, 0.06]", "[@0.0, 0.06]", "balls[0].radius", {"found 0.0", kAllowedPositive}},
    {"BallsRadiusOrder",
     "[0.04, 0.06]",
     "@[0.06, 0.04]",
     "balls[0].radius",
     {"found [ 0.06, 0.04 ]", "low <= high"}},
    {"BallsMass", "mass     = 1.5", "mass = @0", "balls[0].mass", {"found 0", kAllowedPositive}},
    {"Density", "density  = 2.0", "density = @-2", "balls[1].density", {"found -2", kAllowedPositive}},
    {"PackingZero", "packing  = 0.01", "packing = @0", "balls[0].packing", {"found 0", "(0, 1)"}},
    {"PackingOne", "packing  = 0.01", "packing = @1.0", "balls[0].packing", {"found 1.0", "(0, 1)"}},
    {"Speed", "speed    = 1.25", "speed = @-1", "balls[0].speed", {"found -1", kAllowedNotNegative}},
    {"Gap", "gap      = 0.01", "gap = @-0.01", "balls[1].gap", {"found -0.01", kAllowedNotNegative}},
    {"ZeroDirection",
     "direction = [1, 0]",
     "direction = @[0, 0]",
     "balls[1].direction",
     {"found", "allowed"}},
    {"EventEarly", "time  = 1.0", "time = @-1", "event[0].time", {"found -1", "duration"}},
    {"EventLate", "time  = 1.0", "time = @2.5", "event[0].time", {"found 2.5", "duration"}},
    {"EventBall", "ball  = 0", "ball = @15", "event[0].ball", {"found 15", "an integer from 0 to 14"}},
    {"EventBallNegative", "ball  = 0", "ball = @-1", "event[0].ball", {"found -1", "from 0 to 14"}},
    {"ScaleMass", "scale_mass   = 1.1", "scale_mass = @0", "event[0].scale_mass", {kAllowedPositive}},
    {"ScaleRadius", "scale_radius = 1.05", "scale_radius = @-1", "event[0].scale_radius", {kAllowedPositive}},
    {"Limit", "energy = 1e-9", "energy = @-1e-9", "gate.energy", {"found -1e-", kAllowedNotNegative}},
    {"LimitOfEngine", "position = 1e-4", "position = @-1", "gate.box2d.position", {kAllowedNotNegative}},
};
INSTANTIATE_TEST_SUITE_P(OutOfRange, ParseWrong, ::testing::ValuesIn(kOutOfRange), name_of_case);

const std::vector<Wrong> kDoesNotBelong = {

    {"DragWithBoth",
     "{ linear = 0.1 }",
     "@{ linear = 0.1, quadratic = 0.1 }",
     "effects.drag",
     {"linear", "quadratic"}},
    {"DragWithNone", "{ linear = 0.1 }", "@{}", "effects.drag", {"linear", "quadratic"}},
    {"MagnusWithoutSpin", "", "[effects]\nmagnus = @0.05", "effects.magnus", {"effects.spin"}},
    {"FrictionWithoutSpin", "", "[contact]\nfriction = @0.2", "contact.friction", {"effects.spin"}},
    {"WallFrictionWithoutSpin",
     "",
     "[contact.wall]\nfriction = @0.2",
     "contact.wall.friction",
     {"effects.spin"}},
    {"SpinWithoutSpin", "", "spin = @1.0", "ball[0].spin", {"effects.spin"}},
    {"MassAndDensity", "mass     = 1.5", "mass = 1.5\ndensity = @1", "balls[0].density", {"mass"}},
    {"GasWithoutBox", "", "[[balls]]\nkind = @'gas'\ncount = 2\npacking = 0.1", "balls[0].kind", {"[box]"}},
    {"SpeedOfOneBall",
     "",
     "[[balls]]\nkind = 'line'\ncount = 1\nradius = 1\nspeed = @2.0",
     "balls[0].speed",
     {"single ball"}},
    {"EventWithoutAction",
     "[[event]]\ntime = 0.5\nball = 1\nremove = true",
     "@[[event]]\ntime = 0.5\nball = 1",
     "event[1]",
     {"allowed: scale_mass", "remove"}},
    {"RemoveFalse", "", "@[[event]]\ntime = 0.5\nball = 0\nremove = false", "event[0]", {"remove"}},
};
INSTANTIATE_TEST_SUITE_P(DoesNotBelong, ParseWrong, ::testing::ValuesIn(kDoesNotBelong), name_of_case);

const std::vector<Wrong> kMissing = {

    {"Title", "title     = \"Everything\"\n", "@", "title", {"is missing"}},
    {"BoxMin", "[box]\nmin = [0, 0]", "@[box]", "box.min", {"is missing"}},
    {"BoxMax", "[box]\nmin = [0, 0]\nmax = [4, 3]", "@[box]\nmin = [0, 0]", "box.max", {"is missing"}},
    {"Normal", "", "@[[wall]]\noffset = 0", "wall[0].normal", {"is missing"}},
    {"Offset", "", "@[[wall]]\nnormal = [1, 0]", "wall[0].offset", {"is missing"}},
    {"SlabThickness", "", "@[[slab]]\nnormal = [1, 0]\noffset = 0", "slab[0].thickness", {"is missing"}},
    {"Hbar",
     "",
     "@[[barrier]]\nnormal = [1, 0]\noffset = 0\nthickness = 1\nheight = 1",
     "barrier[0].hbar",
     {"is missing"}},
    {"Height",
     "",
     "@[[barrier]]\nnormal = [1, 0]\noffset = 0\nthickness = 1\nhbar = 1",
     "barrier[0].height",
     {"is missing"}},
    {"Mass", "", "@[[ball]]\nradius = 1\nposition = [0, 0]", "ball[1].mass", {"is missing"}},
    {"Radius", "", "@[[ball]]\nmass = 1\nposition = [0, 0]", "ball[1].radius", {"is missing"}},
    {"Position", "", "@[[ball]]\nmass = 1\nradius = 1", "ball[1].position", {"is missing"}},
    {"Kind", "", "@[[balls]]\ncount = 1\nradius = 1", "balls[0].kind", {"is missing"}},
    {"Count", "", "@[[balls]]\nkind = 'line'\nradius = 1", "balls[0].count", {"is missing"}},
    {"BallsRadius", "", "@[[balls]]\nkind = 'line'\ncount = 1", "balls[0].radius", {"is missing"}},
    {"EventTime", "", "@[[event]]\nball = 0\nremove = true", "event[0].time", {"is missing"}},
    {"EventBall", "", "@[[event]]\ntime = 0\nremove = true", "event[0].ball", {"is missing"}},
    {"AddedRadius",
     "",
     "[[event]]\ntime = 0\nadd_ball = @{ mass = 1, position = [0, 0] }",
     "event[0].add_ball.radius",
     {"is missing"}},
};
INSTANTIATE_TEST_SUITE_P(Missing, ParseWrong, ::testing::ValuesIn(kMissing), name_of_case);

const std::string kSmallBox = "[box]\nmin = [-3, -3]\nmax = [3, 3]\n";

const std::vector<Wrong> kDoesNotFit = {
    {"Gas",
     "",
     kSmallBox + "[[balls]]\nkind = 'gas'\ncount = @100\nradius = 0.4",
     "balls[0].count",
     {"of 100 balls fit", "allowed"}},
    {"GasOfGiants",
     "",
     kSmallBox + "[[balls]]\nkind = 'gas'\ncount = @1\nradius = 4",
     "balls[0].count",
     {"0 of 1", "allowed"}},
    {"Lattice",
     "",
     kSmallBox + "[[balls]]\nkind = 'lattice'\ncount = @65\nradius = 0.375",
     "balls[0].count",
     {"64 balls on a lattice, not 65", "allowed"}},
    {"Line",
     "",
     kSmallBox + "[[balls]]\nkind = 'line'\ncount = @7\nradius = 0.5",
     "balls[0].count",
     {"a line of 7 balls", "allowed"}},
    {"LineThroughWall",
     "",
     kSmallBox + "[[balls]]\nkind = 'line'\ncount = @2\nradius = 0.5\nposition = [2.4, 0]",
     "balls[0].count",
     {"behind a wall", "allowed"}},
    {"LineOnABall",
     "",
     "[[balls]]\nkind = 'line'\ncount = @2\nradius = 0.5\nposition = [1.5, -2]",
     "balls[0].count",
     {"allowed"}},
    {"LatticeInASlab",
     "",
     "[[slab]]\nnormal = [1, 0]\noffset = 7\nthickness = 0.1\n[[balls]]\nkind = "
     "'lattice'\ncount = @4\n"
     "radius = 0.5\nposition = [7, 0]",
     "balls[0].count",
     {"allowed"}},
};
INSTANTIATE_TEST_SUITE_P(DoesNotFit, ParseWrong, ::testing::ValuesIn(kDoesNotFit), name_of_case);

TEST(Parse, WhatIsNotToml_IsRefusedWithItsPlace) {
  const std::vector<std::pair<std::string, std::string>> texts = {
      {"hello", "scene.toml:1:"},
      {"a = 1\nb = = 2\n", "scene.toml:2:5: "},
      {"a = 1\na = 2\n", "scene.toml:2:"},
      {"a = 1\n\n[a\n", "scene.toml:3:"},
      {"title = \"no end\n", "scene.toml:1:"},
      {std::string("a = 1\n\0", 7), "scene.toml:2:1: "},
      {"title = \"\xFF\"\n", "scene.toml:1:"},
      {"[[ball]]\nmass = 1\n[ball]\nmass = 2\n", "scene.toml:3:1: "},
      {"a = " + std::string(100'000, '['), "scene.toml:1:"}};
  for (const auto& [text, place] : texts) {
    EXPECT_THAT(error_of(text), StartsWith(place)) << text.substr(0, 60);
    EXPECT_THAT(error_of(text), HasSubstr("not TOML")) << text.substr(0, 60);
  }
}

TEST(Parse, RequiredKeyOfTheScene_IsNamedWhereMissing) {
  for (const std::string key : {"title", "dimension", "duration", "step", "frames"}) {
    const std::size_t at = kMinimal.find(key + " = ");
    std::string text = kMinimal;
    text.erase(at, text.find('\n', at) + 1 - at);
    EXPECT_THAT(error_of(text), StartsWith("scene.toml:1:1: " + key + ": is missing"));
  }
}

TEST(Parse, EmptyFile_IsRefused) {
  EXPECT_THAT(error_of(""), StartsWith("scene.toml:1:1: title: is missing"));
  EXPECT_THAT(error_of("# nothing but a comment\n"), StartsWith("scene.toml:1:1: title: is missing"));
}

TEST(Parse, SceneWithoutBalls_IsRefused) {
  const std::string text = kMinimal.substr(0, kMinimal.find("[[ball]]"));
  EXPECT_THAT(error_of(text), StartsWith("scene.toml:1:1: "));
  EXPECT_THAT(error_of(text), HasSubstr("needs a [[ball]] or [[balls]] table"));
  EXPECT_THAT(error_of("ball = []\n" + text), HasSubstr("needs a [[ball]] or [[balls]] table"));
}

// --- scenes from files
// ---------------------------------------------------------------------------------------

class LoadScene : public ::testing::Test {
 protected:
  LoadScene() { std::filesystem::create_directories(folder_ / "my-group"); }

  test::TestFolder folder_;
};

TEST_F(LoadScene, Id_IsFolderAndName) {
  const std::filesystem::path file = folder_ / "my-group" / "one.ball.toml";
  std::ofstream(file) << kMinimal;
  const ScenarioPtr scene = load_scene(file);
  EXPECT_EQ(scene->id, "my-group/one.ball");
  EXPECT_EQ(scene->file, file.string());
  EXPECT_EQ(load_scene(folder_ / "my-group" / ".." / "my-group" / "one.ball.toml")->id, "my-group/one.ball");
}

TEST_F(LoadScene, UnreadableFile_IsAnInputErrorThatNamesIt) {
  for (const std::filesystem::path& file : {folder_ / "none.toml", folder_ / "my-group"}) {
    try {
      load_scene(file);
      ADD_FAILURE() << file;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), StartsWith(file.string() + ": cannot be read: "));
    }
  }
}

TEST(LoadSceneOfTheCheckout, EveryScene_IsRight) {
  int scenes = 0;
  for (const auto& file : Catalog(CAROM_SOURCE_DIR "/scenarios").all()) {
    ++scenes;
    EXPECT_NO_THROW(load_scene(file)) << file;
  }
  EXPECT_GT(scenes, 0);
}

// --- the law of several contacts at once
// ---------------------------------------------------------------------

/// The least that is a scene, with this text for its [contact].
std::string with_contact(const std::string& contact) {
  return kMinimal + "[contact]\n" + contact;
}

TEST(ContactLaw, Words_NameTheLaws) {
  const auto law_of = [](const std::string& contact) {
    return parse_scene(with_contact(contact), "scene.toml")->multi_contact;
  };
  EXPECT_EQ(parse_scene(kMinimal, "scene.toml")->multi_contact, MultiContact::sequential);
  EXPECT_EQ(law_of("restitution = 0.5\n"), MultiContact::sequential);
  EXPECT_EQ(law_of("law = \"sequential\"\n"), MultiContact::sequential);
  EXPECT_EQ(law_of("law = \"simultaneous\"\n"), MultiContact::simultaneous);
  EXPECT_EQ(law_of("law = \"generalized-reflections\"\n"), MultiContact::generalized_reflections);
}

TEST(ContactLaw, OtherWord_IsRefusedWithTheAllowedOnes) {
  for (const std::string wrong : {"\"both\"", "1", "\"\""}) {
    const std::string error = error_of(with_contact("law = " + wrong + "\n"));
    EXPECT_THAT(error, StartsWith("scene.toml:11:7: contact.law: found "));
    EXPECT_THAT(error, HasSubstr("sequential"));
    EXPECT_THAT(error, HasSubstr("simultaneous"));
    EXPECT_THAT(error, HasSubstr("generalized-reflections"));
  }
}

TEST(ContactLaw, OfTheWalls_IsNoKey) {
  EXPECT_THAT(error_of(with_contact("[contact.wall]\nlaw = \"simultaneous\"\n")),
              HasSubstr("contact.wall.law"));
}

TEST(ContactLaw, FrictionlessLaw_IsRefusedWithFriction) {
  const std::string rough_balls = "friction = 0.1\n";
  const std::string rough_walls = "[contact.wall]\nfriction = 0.1\n";
  const std::string spin = "[effects]\nspin = true\n";
  for (const std::string law : {"simultaneous", "generalized-reflections"}) {
    const std::string key = "law = \"" + law + "\"\n";
    for (const std::string& text : {with_contact(key + rough_balls), with_contact(key + rough_walls)}) {
      const std::string error = error_of(text + spin);
      EXPECT_THAT(error, StartsWith("scene.toml:11:7: contact.law: found '" + law + "'"));
      EXPECT_THAT(error, HasSubstr("frictionless"));
    }
  }
  EXPECT_NO_THROW(parse_scene(with_contact("law = \"sequential\"\n" + rough_balls) + spin, "scene.toml"));
}

TEST(ContactLaw, IsAFeature_UnlessItIsSequential) {
  const auto features_of = [](const std::string& law) {
    return required_features(*parse_scene(with_contact("law = \"" + law + "\"\n"), "scene.toml"));
  };
  EXPECT_THAT(features_of("simultaneous"), Contains(Feature::simultaneous));
  EXPECT_THAT(features_of("generalized-reflections"), Contains(Feature::generalized_reflections));
  EXPECT_THAT(features_of("sequential"), Not(Contains(Feature::simultaneous)));
  EXPECT_THAT(features_of("sequential"), Not(Contains(Feature::generalized_reflections)));
}

}  // namespace

}  // namespace carom::test
