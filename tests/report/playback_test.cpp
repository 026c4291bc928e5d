#include "report/playback.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "carom/carom_engine.h"
#include "report/impacts.h"
#include "report/pack.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;
using Recorded = Run;  // in a test Run() is GoogleTest's
using testing::HasSubstr;
using testing::Not;

// What reads a playback here is written from what pack.h and playback.h say, and shares nothing with the
// writer.

std::string from_base64(const std::string& text) {
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    const std::size_t digit =
        std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(c);
    if (digit == std::string_view::npos) break;
    group = group << 6U | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> static_cast<unsigned>(bits) & 0xFFU);
  }
  return bytes;
}

std::string inflated(const std::string& packed) {
  std::string bytes;
  std::string piece(std::size_t{1} << 16U, '\0');
  z_stream stream = {};
  EXPECT_EQ(inflateInit(&stream), Z_OK);
  std::string input = packed;
  stream.next_in = reinterpret_cast<Bytef*>(input.data());
  stream.avail_in = static_cast<uInt>(input.size());
  int status = Z_OK;
  while (status == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    status = inflate(&stream, Z_NO_FLUSH);
    bytes.append(piece, 0, piece.size() - stream.avail_out);
  }
  EXPECT_EQ(status, Z_STREAM_END);
  inflateEnd(&stream);
  return bytes;
}

template <class Word>
std::vector<Word> unpacked(const std::string& text) {
  const std::string bytes = inflated(from_base64(text));
  std::vector<Word> words(bytes.size() / sizeof(Word), 0);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    words[i % words.size()] |= static_cast<Word>(static_cast<unsigned char>(bytes[i]))
                               << 8U * (i / words.size());
  }
  return words;
}

std::vector<std::int64_t> integers(const std::string& text) {
  std::vector<std::int64_t> numbers;
  for (const std::uint32_t word : unpacked<std::uint32_t>(text)) {
    numbers.push_back(word % 2 == 0 ? std::int64_t{word / 2} : -std::int64_t{word / 2} - 1);
  }
  return numbers;
}

std::vector<double> doubles(const std::string& text) {
  std::vector<double> numbers;
  for (const std::uint64_t word : unpacked<std::uint64_t>(text))
    numbers.push_back(std::bit_cast<double>(word));
  return numbers;
}

/// Quantity [axis][ball][frame] from its differences.
std::vector<double> series(const std::string& text, std::size_t frames, double grid) {
  std::vector<double> values;
  std::int64_t now = 0;
  for (const std::int64_t n : integers(text)) {
    if (values.size() % frames == 0) now = 0;
    now += n;
    values.push_back(static_cast<double>(now) * grid);
  }
  return values;
}

/// Positions [axis][ball][frame] by (1) of playback.h, frame after frame for all balls.
std::vector<double> positions(const std::string& text, const std::vector<double>& velocities,
                              const std::vector<double>& times, std::size_t axes, double grid) {
  const std::vector<std::int64_t> missed = integers(text);
  const std::size_t frames = times.size();
  const std::size_t balls = missed.size() / frames / axes;
  std::vector<double> x(missed.size());
  for (std::size_t k = 0; k < frames; ++k) {
    for (std::size_t ball = 0; ball < balls; ++ball) {
      const auto at = [&](std::size_t axis) { return (axis * balls + ball) * frames + k; };
      const auto jump = [&](std::size_t axis) { return velocities[at(axis)] - velocities[at(axis) - 1]; };
      const auto off = [&](std::size_t axis) { return static_cast<double>(missed[at(axis)]) * grid; };
      for (std::size_t axis = 0; axis < axes && k == 0; ++axis) x[at(axis)] = off(axis);
      if (k == 0) continue;
      const double h = times[k] - times[k - 1];
      std::size_t lead = axes - 1;
      for (std::size_t axis = axes; axis-- > 0;) {
        if (std::abs(jump(axis)) >= std::abs(jump(lead))) lead = axis;
      }
      const bool once = jump(lead) != 0.0 && std::isfinite(jump(lead)) &&
                        std::abs(off(lead)) <= 0.5 * h * std::abs(jump(lead)) + grid;
      for (std::size_t axis = 0; axis < axes; ++axis) {
        double flight = 0.5 * h * (velocities[at(axis) - 1] + velocities[at(axis)]);
        if (axis != lead && once) flight += off(lead) * (jump(axis) / jump(lead));
        flight = std::max(std::min(flight, 0x1p29 * grid), -0x1p29 * grid);
        x[at(axis)] = x[at(axis) - 1] + flight + off(axis);
      }
    }
  }
  return x;
}

std::vector<double> times_of(const Scenario& scene) {
  std::vector<double> times;
  for (int k = 0; k <= scene.frames; ++k) {
    times.push_back(static_cast<double>(k) / static_cast<double>(scene.frames) * scene.duration_s);
  }
  return times;
}

Recorded run_of(const Scenario& scene, const std::string& engine = "carom") {
  Recorded run;
  run.engine = engine;
  run.profile = "faithful";
  run.trajectory = Trajectory(scene);
  const std::unique_ptr<Engine> made = make_carom_engine(engine);
  const std::unique_ptr<Simulation> simulation = made->create(scene, "faithful");
  const double interval_s = scene.duration_s / static_cast<double>(scene.frames);
  const auto steps = static_cast<std::int64_t>(std::ceil(interval_s / scene.step_s));
  for (std::size_t k = 0; k < run.trajectory.frames(); ++k) {
    if (k > 0) simulation->advance(interval_s / static_cast<double>(steps), steps);
    simulation->snapshot(run.trajectory.frame(k));
    run.trajectory.tally(k) = simulation->tally();
  }
  return run;
}

Json played(const Scenario& scene, const Recorded& run, const PlaybackLimits& limits = {}) {
  return Json::parse(playback_json(scene, {&run}, nullptr, limits));
}

/// A position is summed up from at most 2³⁰ grids in three roundings, which come on top of the grid's.
constexpr double kSummed = 0.5 + 3.0 * kEpsilon * 0x1p30;

/// @param most  how far a value may be off, by its rounding
void expect_within(double rounding, const std::vector<double>& values, const Trajectory& trajectory,
                   const std::vector<int>& axes, const Vec3 BallState::*quantity, double most = 0.5) {
  const std::size_t frames = trajectory.frames();
  ASSERT_EQ(values.size(), axes.size() * trajectory.balls() * frames);
  for (std::size_t n = 0; n < values.size(); ++n) {
    const std::size_t frame = n % frames;
    const std::size_t ball = n / frames % trajectory.balls();
    const int axis = axes[n / frames / trajectory.balls()];
    ASSERT_LE(std::abs(values[n] - (trajectory.frame(frame)[ball].*quantity)[axis]), most * rounding)
        << "frame " << frame << " ball " << ball << " axis " << axis;
  }
}

constexpr const char* kRough =
    "[effects]\ngravity = [0.1, -1.0]\nspin = true\n[contact]\nrestitution = 0.9\nfriction = 0.3\n";
constexpr const char* kRoughSpace =
    "[effects]\ngravity = [0.1, -1.0, 0.2]\nspin = true\n[contact]\nrestitution = 0.9\nfriction = 0.3\n";

TEST(Pack, ReadsBack_WhateverTheIntegers) {
  Random random(5);
  std::vector<std::int32_t> numbers = {0, 1, -1, std::numeric_limits<std::int32_t>::max(),
                                       std::numeric_limits<std::int32_t>::min()};
  for (int i = 0; i < 1000; ++i) {
    numbers.push_back(
        static_cast<std::int32_t>(random.uniform(-1.0, 1.0) * std::exp2(random.uniform(0.0, 31.0))));
  }
  for (std::size_t count = 0; count <= numbers.size(); count += count < 8 ? 1 : 99) {
    const std::span<const std::int32_t> some(numbers.data(), count);
    EXPECT_THAT(integers(pack_integers(some)), testing::ElementsAreArray(some)) << count;
  }
}

TEST(Pack, ReadsBackToTheBit_WhateverTheDouble) {
  const std::vector<double> numbers = {0.0,    -0.0,   0.1,
                                       5e-324, -1e308, std::numeric_limits<double>::infinity()};
  const std::vector<double> read = doubles(pack_doubles(numbers));
  ASSERT_EQ(read.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read[i]), std::bit_cast<std::uint64_t>(numbers[i]));
  }
}

TEST(Playback, ReadsBackWithinHalfItsRounding_InEveryFrame) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const int dimension = seed % 2 == 0 ? 2 : 3;
    const ScenarioPtr scene = gas(dimension, 12, 0.1, 12.0, seed, dimension == 2 ? kRough : kRoughSpace);
    const Recorded run = run_of(*scene, "carom:toi");
    const Json json = played(*scene, run);
    const Json& rounding = json["rounding"];
    const Json& it = json["runs"][0];
    const std::size_t frames = it["known"];
    EXPECT_LE(rounding["position_m"].get<double>(), 0x1p-14);
    const std::vector<int> axes = dimension == 2 ? std::vector<int>{0, 1} : std::vector<int>{0, 1, 2};
    const std::vector<int> turns = dimension == 2 ? std::vector<int>{2} : axes;
    const std::vector<double> velocities = series(it["velocities"], frames, rounding["speed_mps"]);
    expect_within(
        rounding["position_m"],
        positions(it["positions"], velocities, times_of(*scene), axes.size(), rounding["position_m"]),
        run.trajectory, axes, &BallState::position, kSummed);
    expect_within(rounding["speed_mps"], velocities, run.trajectory, axes, &BallState::velocity);
    expect_within(rounding["spin_radps"], series(it["spins"], frames, rounding["spin_radps"]), run.trajectory,
                  turns, &BallState::spin);
  }
}

// The first frame has no flight behind it: what it misses by is its place, and no sign of an impact.
TEST(Playback, ReadsBackWithinHalfItsRounding_FromAStartWithinAGridOfTheOrigin) {
  const ScenarioPtr scene = scene_of(
      "title = \"t\"\ndimension = 2\nduration = 1.0\nstep = 0.01\nframes = 4\n"
      "[[ball]]\nmass = 1.0\nradius = 1.0\nposition = [0.0, 0.5]\nvelocity = [1.0, 0.9]\n");
  Recorded run = run_of(*scene);
  for (std::size_t k = 0; k < run.trajectory.frames(); ++k) {
    run.trajectory.frame(k)[0].position.x() += 0.9 * 0x1p-14;
  }
  const Json json = played(*scene, run);
  const Json& rounding = json["rounding"];
  ASSERT_EQ(rounding["position_m"].get<double>(), 0x1p-14);
  const Json& it = json["runs"][0];
  const std::vector<double> velocities = series(it["velocities"], it["known"], rounding["speed_mps"]);
  expect_within(rounding["position_m"],
                positions(it["positions"], velocities, times_of(*scene), 2, rounding["position_m"]),
                run.trajectory, {0, 1}, &BallState::position, kSummed);
}

// Between two frames the ball flies a quarter of a million metres to and fro between walls three millimetres
// apart.
TEST(Playback, ReadsBackWithinHalfItsRounding_WhereAFlightIsFarLongerThanTheBox) {
  const ScenarioPtr scene = scene_of(
      "title = \"t\"\ndimension = 2\nduration = 10.0\nstep = 0.01\nframes = 40\n"
      "[box]\nmin = [0, 0]\nmax = [0.003, 0.003]\n"
      "[[ball]]\nmass = 1.0\nradius = 0.001\nposition = [0.0015, 0.0015]\n");
  Recorded run;
  run.engine = "carom";
  run.trajectory = Trajectory(*scene);
  Random random(3);
  for (std::size_t k = 0; k < run.trajectory.frames(); ++k) {
    for (int c = 0; c < 2; ++c) {
      run.trajectory.frame(k)[0].position[c] = random.uniform(0.001, 0.002);
      run.trajectory.frame(k)[0].velocity[c] = random.uniform(-1e6, 1e6);
    }
  }
  const Json json = played(*scene, run);
  const Json& it = json["runs"][0];
  const double rounding = json["rounding"]["position_m"];
  EXPECT_LE(rounding, 0x1p-23);
  const std::vector<double> v = series(it["velocities"], 41, json["rounding"]["speed_mps"]);
  expect_within(rounding, positions(it["positions"], v, times_of(*scene), 2, rounding), run.trajectory,
                {0, 1}, &BallState::position);
}

TEST(Playback, TakesAByteForEachBallAndFrame_InAThinGas) {
  const ScenarioPtr made = gas(3, 250, 0.1, 22.0, 4);
  Scenario scene = *made;
  scene.duration_s = 4.0;
  scene.frames = 240;
  const Recorded run = run_of(scene);
  EXPECT_GT(run.trajectory.tally(240).impacts, 300);
  const double states = 250.0 * 241.0;
  EXPECT_LT(static_cast<double>(playback_json(scene, {&run}).size()), states);
}

TEST(Playback, TellsEnergiesThatAddUp_WithWhatTheEngineLoses) {
  const ScenarioPtr scene = gas(2, 12, 0.1, 12.0, 2, kRough);
  const Recorded run = run_of(*scene, "carom:toi");
  const std::vector<double> energy = doubles(played(*scene, run)["runs"][0]["energy"]);
  ASSERT_EQ(energy.size(), 3 * run.trajectory.frames());
  const std::size_t last = run.trajectory.frames() - 1;
  for (const std::size_t k : {std::size_t{0}, last}) {
    EXPECT_NEAR(energy[k],
                kinetic_energy_of(*scene, {run.trajectory.frame(k).begin(), run.trajectory.frame(k).end()}),
                1e-12);
  }
  EXPECT_GT(energy[run.trajectory.frames() + last], 0.0);
  const auto total = [&](std::size_t k) {
    return energy[k] + energy[run.trajectory.frames() + k] + energy[2 * run.trajectory.frames() + k];
  };
  EXPECT_LT(total(last), total(0));
}

TEST(Playback, NamesTheTwin_OfARunThatIsTheSameToTheBit) {
  const ScenarioPtr scene = gas(2, 12, 0.1, 12.0, 2);
  const Recorded a = run_of(*scene, "carom:toi");
  const Recorded b = run_of(*scene, "carom:toi:brute-force");
  const Json json = Json::parse(playback_json(*scene, {&a, &b}));
  EXPECT_EQ(json["runs"][1]["same_as"], "carom:toi");
  EXPECT_FALSE(json["runs"][1].contains("positions"));
}

TEST(Playback, SaysWhyARunIsNotThere) {
  const ScenarioPtr scene = gas(2, 3, 0.1, 12.0, 2);
  Recorded run;
  run.engine = "box2d";
  run.profile = "default";
  run.status = RunStatus::crashed;
  run.reason = "<Segmentation> & fault";
  const std::string text = playback_json(*scene, {&run});
  EXPECT_THAT(text, Not(testing::ContainsRegex("[<>&]")));
  EXPECT_EQ(Json::parse(text)["runs"][0]["reason"], "<Segmentation> & fault");
  EXPECT_EQ(Json::parse(text)["runs"][0]["label"], "box2d@default");
}

TEST(Playback, KeepsToItsLimits_AndSaysSo) {
  const ScenarioPtr made = gas(2, 20, 0.1, 14.0, 2);
  Scenario scene = *made;
  scene.frames = 100;
  const Recorded a = run_of(scene, "carom:toi");
  Recorded b = run_of(scene, "carom:step");
  b.trajectory.frame(50)[0].position.x() += 1.0;
  PlaybackLimits limits;
  limits.balls = 10;
  limits.states = 300;
  limits.bytes = 1;
  const Json json = Json::parse(playback_json(scene, {&a, &b}, nullptr, limits));
  EXPECT_EQ(json["balls"]["shown"], 10);
  EXPECT_EQ(json["balls"]["count"], 20);
  EXPECT_LE(json["frames"]["count"].get<int>(), 30);
  EXPECT_EQ(json["runs"].size(), 1U);
  EXPECT_EQ(json["left_out"], Json::array({"carom:step"}));
  const std::size_t count = json["frames"]["count"];
  const std::size_t last = count - 1;
  std::vector<double> times;
  for (std::size_t f = 0; f < last; ++f) {
    times.push_back(static_cast<double>(f) * json["frames"]["every"].get<double>() / 100.0 *
                    scene.duration_s);
  }
  times.push_back(scene.duration_s);
  const std::vector<double> v = series(json["runs"][0]["velocities"], count, json["rounding"]["speed_mps"]);
  const std::vector<double> x =
      positions(json["runs"][0]["positions"], v, times, 2, json["rounding"]["position_m"]);
  EXPECT_NEAR(x[last], a.trajectory.frame(100)[0].position.x(), json["rounding"]["position_m"]);
}

TEST(Playback, EndsATruthWhereItIsNotKnown) {
  const ScenarioPtr scene = gas(2, 3, 0.01, 12.0, 2);
  const Recorded run = run_of(*scene);
  Truth truth;
  truth.kind = "exact";
  truth.trajectory = run_of(*scene).trajectory;
  truth.trajectory.frame(6)[1].position.x() = std::numeric_limits<double>::quiet_NaN();
  const Json json = Json::parse(playback_json(*scene, {&run}, &truth));
  EXPECT_EQ(json["runs"][0]["label"], "truth");
  EXPECT_EQ(json["runs"][0]["known"], 6);
  EXPECT_EQ(json["runs"][1]["known"], 11);
}

TEST(Playback, EndsATruthBeforeTheFirstEvent) {
  const ScenarioPtr scene = scene_of(
      "title = \"t\"\ndimension = 2\nduration = 4.0\nstep = 0.01\nframes = 40\n"
      "[[ball]]\nmass = 1.0\nradius = 0.1\nposition = [3, 0]\nvelocity = [1, 0]\n"
      "[[event]]\ntime = 1.0\nball = 0\nscale_mass = 1.1\n");
  Truth truth;
  truth.kind = "exact";
  truth.trajectory = run_of(*scene).trajectory;
  const Json json = Json::parse(playback_json(*scene, {}, &truth));
  EXPECT_EQ(json["runs"][0]["known"], 10);
}

TEST(Playback, SaysWhyThereIsNoTruth) {
  const ScenarioPtr scene = gas(2, 3, 0.01, 12.0, 2);
  const Recorded run = run_of(*scene);
  Truth truth;
  truth.reason = "nobody knows";
  const Json json = Json::parse(playback_json(*scene, {&run}, &truth));
  EXPECT_EQ(json["runs"][0]["label"], "truth");
  EXPECT_EQ(json["runs"][0]["reason"], "nobody knows");
}

TEST(Playback, TellsThePairTests_ThatCaromsBroadPhasesCount) {
  const ScenarioPtr scene = gas(2, 200, 0.1, 50.0, 3);
  const Recorded run = run_of(*scene, "carom:toi");
  const Json it = played(*scene, run)["runs"][0];
  // The first frame's count, then none more in the others: all pairs are all pairs wherever the balls are.
  const std::vector<std::int64_t> brute_force = integers(it["brute_force_tests"]);
  EXPECT_EQ(brute_force.front(), 200 * 199 / 2);
  EXPECT_EQ(std::count(brute_force.begin(), brute_force.end(), 0),
            static_cast<std::ptrdiff_t>(run.trajectory.frames()) - 1);
  const std::vector<std::int64_t> tree = integers(it["tree_tests"]);
  EXPECT_EQ(tree.size(), run.trajectory.frames());
  EXPECT_GT(tree.front(), 200);
  EXPECT_LT(tree.front(), 200 * 199 / 4);
}

// Balls of 0.1 m, 2 m apart, one at 1 m/s: they touch at t = 1.8 s.
TEST(Impacts, TellWhoAndWhen_OfTwoBalls) {
  const ScenarioPtr scene = scene_of(
      "title = \"t\"\ndimension = 2\nduration = 4.0\nstep = 0.01\nframes = 50\n"
      "[[wall]]\nnormal = [-1, 0]\noffset = -3\n"
      "[[ball]]\nmass = 1.0\nradius = 0.1\nposition = [0, 0]\nvelocity = [1, 0]\n"
      "[[ball]]\nmass = 1.0\nradius = 0.1\nposition = [2, 0]\n");
  const Recorded run = run_of(*scene);
  const SeenImpacts seen = find_impacts(*scene, run.trajectory, 10);
  ASSERT_EQ(seen.impacts.size(), 3U);
  EXPECT_EQ(seen.impacts[0].ball, 0);
  EXPECT_EQ(seen.impacts[0].other, 1);
  // Seen from 2 % of a radius away: 2 mm at 1 m/s.
  EXPECT_NEAR(seen.impacts[0].time_s, 1.8, 0.0021);
  EXPECT_EQ(seen.impacts[1].ball, 1);
  EXPECT_EQ(seen.impacts[1].other, SeenImpact::kWall);
  EXPECT_NEAR(seen.impacts[1].time_s, 2.7, 1e-9);
  EXPECT_EQ(seen.impacts[2].other, 1);
  EXPECT_NEAR(seen.impacts[2].time_s, 3.6, 0.0021);
}

// Frames 2.5 ms apart, so that no ball has two impacts between two of them.
TEST(Impacts, AreAsManyAsTheEngineCounts_InAThinGas) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const int dimension = seed % 2 == 0 ? 2 : 3;
    const ScenarioPtr made = gas(dimension, 20, 0.05, dimension == 2 ? 24.0 : 12.0, seed);
    Scenario scene = *made;
    scene.duration_s = 20.0;
    scene.frames = 8000;
    const Recorded run = run_of(scene);
    const Tally& tally = run.trajectory.tally(8000);
    const SeenImpacts seen = find_impacts(scene, run.trajectory, 100000);
    std::int64_t walls = 0;
    for (const SeenImpact& impact : seen.impacts) {
      EXPECT_NE(impact.other, SeenImpact::kUnknown) << impact.time_s;
      if (impact.other == SeenImpact::kWall) ++walls;
    }
    EXPECT_GT(tally.impacts, 30);
    EXPECT_EQ(walls, tally.wall_impacts) << seed;
    EXPECT_EQ(static_cast<std::int64_t>(seen.impacts.size()), tally.impacts) << seed;
  }
}

TEST(Impacts, AreNone_InFlight) {
  for (const char* effects : {"gravity = [0, -9.81]", "gravity = [0, -9.81]\ndrag = { linear = 0.5 }",
                              "drag = { quadratic = 0.5 }"}) {
    const ScenarioPtr scene =
        scene_of(std::string("title = \"t\"\ndimension = 2\nduration = 2.0\nstep = 0.002\n"
                             "frames = 40\n[effects]\n") +
                 effects + "\n[[ball]]\nmass = 1.0\nradius = 0.1\nposition = [0, 0]\nvelocity = [3, 4]\n");
    EXPECT_TRUE(find_impacts(*scene, run_of(*scene).trajectory, 10).impacts.empty()) << effects;
  }
}

TEST(Impacts, OfABallThatComesToRest_EndWithItsBounces) {
  const ScenarioPtr scene = scene_of(
      "title = \"t\"\ndimension = 2\nduration = 6.0\nstep = 0.002\nframes = 300\n[effects]\ngravity = [0, "
      "-9.81]\n"
      "[contact]\nrestitution = 0.5\n[[wall]]\nnormal = [0, 1]\noffset = 0\n"
      "[[ball]]\nmass = 1.0\nradius = 0.1\nposition = [0, 1.1]\n");
  const Recorded run = run_of(*scene);
  const SeenImpacts seen = find_impacts(*scene, run.trajectory, 1000);
  // Falls for √(2/g) = 0.45 s; then the bounces last 0.9 s, halved each time: at rest after 0.45 + 0.9 = 1.35
  // s.
  ASSERT_GT(seen.impacts.size(), 2U);
  EXPECT_LT(seen.impacts.size(), 12U);
  EXPECT_LT(seen.impacts.back().time_s, 1.4);
}

TEST(Impacts, BeyondTheLimit_AreSaidToBeThere) {
  const ScenarioPtr made = gas(2, 20, 0.1, 17.0, 3);
  Scenario scene = *made;
  scene.duration_s = 10.0;
  scene.frames = 500;
  const Recorded run = run_of(scene);
  const SeenImpacts all = find_impacts(scene, run.trajectory, 100000);
  const SeenImpacts some = find_impacts(scene, run.trajectory, 5);
  EXPECT_EQ(some.impacts.size(), 5U);
  EXPECT_GT(all.impacts.size(), 5U);
  EXPECT_TRUE(some.more);
  EXPECT_FALSE(all.more);
}

}  // namespace
}  // namespace carom::test
