#include "carom/laws/law_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <locale>

#include "carom/compose.h"
#include "carom/law_engine.h"
#include "carom/laws/law_formula.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

LawFile law_with(const std::string& lines) {
  return parse_law("name = \"A law\"\n" + lines, "my.toml");
}

std::string error_of(const std::string& lines) {
  try {
    law_with(lines);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

PairMeeting a_pair() {
  PairMeeting pair;
  pair.one = {2.0, 0.5, 0.4, {3.0, 1.0, 0.0}, {0.0, 0.0, 2.0}};
  pair.two = {4.0, 0.25, 0.3, {-1.0, 0.5, 0.0}, {0.0, 0.0, -4.0}};
  pair.surface = {0.5, 0.3, 0.2};
  return pair;
}

/// What an expression comes to for the pair, seen by the impulse on ball 2 along n.
double value_of(const std::string& expression, const std::string& more = "") {
  LawFormula formula(law_with("normal = \"" + expression + "\"\n" + more));
  const PairImpulses impulses = formula.impulses(a_pair());
  EXPECT_EQ(impulses.on_one, -impulses.on_two);
  return impulses.on_two.x();
}

TEST(LawFormula, NamesMeanWhatTheySay) {
  // n = x, g = (-4, -0.5) - (0.5·2 - 0.25·4) z × x = (-4, -0.5): t = -y.
  const std::vector<std::pair<std::string, double>> rows = {
      {"m1", 2.0},
      {"m2", 4.0},
      {"m", 4.0 / 3.0},
      {"r1", 0.5},
      {"r2", 0.25},
      {"I1", 0.4},
      {"I2", 0.3},
      {"e", 0.5},
      {"mu", 0.3},
      {"beta0", 0.2},
      {"vn", -4.0},
      {"vt", 0.5},
      {"vn1", 3.0},
      {"vn2", -1.0},
      {"v1", std::sqrt(10.0)},
      {"v2", std::sqrt(1.25)},
      {"v1x", 3.0},
      {"v1y", 1.0},
      {"v1z", 0.0},
      {"v2x", -1.0},
      {"v2y", 0.5},
      {"v2z", 0.0},
      {"w1x", 0.0},
      {"w1y", 0.0},
      {"w1z", 2.0},
      {"w2x", 0.0},
      {"w2y", 0.0},
      {"w2z", -4.0},
      {"nx", 1.0},
      {"ny", 0.0},
      {"nz", 0.0},
      {"tx", 0.0},
      {"ty", -1.0},
      {"tz", 0.0},
      {"mt", 1.0 / (0.5 + 0.25 + 0.25 / 0.4 + 0.0625 / 0.3)},
      {"pi", std::acos(-1.0)}};
  for (const auto& [name, value] : rows) EXPECT_DOUBLE_EQ(value_of(name), value) << name;
  EXPECT_EQ(rows.size(), law_names().size() + 1);  // pi is no property of the pair
}

TEST(LawFormula, FunctionsAndOperators) {
  EXPECT_EQ(value_of("sqrt(4) + abs(-3) * sign(-2) + min(1, 2) - max(1, 2)"), -2.0);
  EXPECT_EQ(value_of("-2^2"), -4.0);
  EXPECT_EQ(value_of("vn < 0 ? 7 : 8"), 7.0);
  EXPECT_DOUBLE_EQ(value_of("exp(ln(2)) + atan2(1, 1) - atan(1)"), 2.0);
  EXPECT_DOUBLE_EQ(value_of("sin(0.5)^2 + cos(0.5)^2 + tan(asin(0)) + acos(1)"), 1.0);
}

TEST(LawFormula, Definitions_StandOnThoseBefore) {
  EXPECT_EQ(value_of("b", "[let]\nz = \"m1 + 1\"\nb = \"z * 2\"\n"), 6.0);
  EXPECT_THAT(error_of("normal = \"z\"\n[let]\nb = \"z\"\nz = \"1\"\n"), StartsWith("my.toml:4:6: let.b:"));
}

/// The right law in a file gives what the formulas of impact give: sticking, as μ J_n = 0.3·8 N s is enough.
TEST(LawFormula, TangentialImpulse_IsAlongTheSlip) {
  LawFormula formula(
      law_with("normal = \"-(1 + e) * m * vn\"\ntangential = \"-min((1 + beta0) * mt * vt, mu * 8)\"\n"));
  const PairImpulses impulses = formula.impulses(a_pair());
  const double mt = 1.0 / (0.5 + 0.25 + 0.25 / 0.4 + 0.0625 / 0.3);
  EXPECT_DOUBLE_EQ(impulses.on_two.x(), 8.0);
  EXPECT_DOUBLE_EQ(impulses.on_two.y(), 1.2 * mt * 0.5);
  EXPECT_DOUBLE_EQ(slip_of(after(a_pair(), impulses)).norm(), 0.2 * 0.5);
}

TEST(LawFormula, EachBallByItself) {
  const LawFile law =
      law_with("normal_1 = \"1\"\nnormal_2 = \"2\"\ntangential_1 = \"3\"\ntangential_2 = \"4\"\n");
  EXPECT_FALSE(law.is_reciprocal());
  EXPECT_TRUE(law.has_tangential());
  LawFormula formula(law);
  const PairImpulses impulses = formula.impulses(a_pair());
  EXPECT_EQ(impulses.on_one, Vec3(1.0, -3.0, 0.0));
  EXPECT_EQ(impulses.on_two, Vec3(2.0, -4.0, 0.0));
}

/// Numbers are written with a point, whatever the program's locale writes.
class DecimalComma : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
};

TEST(LawFormula, KnowsNoLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  EXPECT_EQ(value_of("1.5 * 2"), 3.0);
  std::locale::global(before);
}

TEST(LawFile, Mistakes_AreAnsweredWithThePlaceAndTheNames) {
  EXPECT_THAT(error_of("normal = \"-(1 + e) * mm * vn\"\n"),
              AllOf(StartsWith("my.toml:2:22: normal: "),
                    HasSubstr("character 12: found \"mm\", allowed names: m1, m2, m, "),
                    HasSubstr("functions: sqrt, ")));
  EXPECT_THAT(error_of("normal = \"k\"\n[let]\nk = \"foo(vn)\"\n"), StartsWith("my.toml:4:6: let.k: "));
  EXPECT_THAT(error_of("normal = \"q\"\n[let]\nk = \"1\"\n"), HasSubstr("tz, pi, k; functions"));
  // Of several lines the one that it is in; where the file writes escapes, the expression's.
  EXPECT_THAT(error_of("normal = '''\nm *\n  nope'''\n"), StartsWith("my.toml:4:3: normal: "));
  EXPECT_THAT(error_of("normal = \"\\u006d * nope\"\n"),
              AllOf(StartsWith("my.toml:2:10: normal: "), HasSubstr("character 5: found \"nope\"")));
  const std::vector<std::pair<std::string, std::string>> rows = {
      {"(1 + e", "a bracket is not closed"},
      {"m)", "\")\" closes or opens"},
      {"2m", "\"m\" follows on a value, allowed: an operator"},
      {"m *", "ends too early"},
      {"m * / 2", "operator \"/\""},
      {"m = 2", "found \"=\", allowed: =="},
      {"1,5", "several values"},
      {"", "found nothing"},
      {"sqrt(1, 2)", "sqrt has too many arguments"},
      {"min(1)", "min has too few arguments"},
      {"'x'", "found \"'\""},
  };
  for (const auto& [expression, says] : rows) {
    EXPECT_THAT(error_of("normal = \"" + expression + "\"\n"),
                AllOf(StartsWith("my.toml:2:"), HasSubstr(says)))
        << expression;
  }
}

TEST(LawFile, Keys_AreChecked) {
  EXPECT_THAT(error_of(""), AllOf(HasSubstr("normal: "), HasSubstr("is missing")));
  EXPECT_THAT(error_of("normal = \"1\"\nnormal_2 = \"1\"\n"), HasSubstr("stands beside normal_2"));
  EXPECT_THAT(error_of("normal_1 = \"1\"\n"), HasSubstr("stands alone, allowed: normal_1 and normal_2"));
  EXPECT_THAT(error_of("normal = \"1\"\ntangential_2 = \"1\"\n"), HasSubstr("tangential_2: stands alone"));
  EXPECT_THAT(error_of("normal = 1\n"),
              AllOf(StartsWith("my.toml:2:10: normal: found 1"), HasSubstr("allowed")));
  EXPECT_THAT(error_of("normal = \"1\"\nnormall = \"1\"\n"), HasSubstr("normall"));
  EXPECT_THAT(error_of("normal = \"1\"\n[let]\nm1 = \"1\"\n"), HasSubstr("let.m1: has a meaning already"));
  EXPECT_THAT(error_of("normal = \"1\"\n[let]\n\"1a\" = \"1\"\n"), HasSubstr("is no name"));
  EXPECT_THAT(error_of("normal = \n"), HasSubstr("my.toml:2:"));
}

// --- as an engine

std::vector<BallState> ran(const Scenario& scene, const std::string& law) {
  const auto engine = make_law_engine({law_with(law)});
  EXPECT_EQ(unsupported_reason(*engine, scene, "my"), "");
  const auto simulation = engine->create(scene, "my");
  return run(*simulation, scene, 64);
}

const std::string kRough =
    "normal = \"jn\"\ntangential = \"-min((1 + beta0) * mt * vt, mu * jn)\"\n[let]\njn = \"-(1 + e) * m * "
    "vn\"\n";

/// The compiled law and the same one from a file differ by roundings, which a gas makes grow.
TEST(LawEngine, RightLaw_IsThatOfToi_InBoxesOfTwoBalls) {
  for (const int dimension : {2, 3}) {
    for (const bool rough : {false, true}) {
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Scenario scene = *gas(dimension, 2, 0.2, 4.0, seed, rough ? "[effects]\nspin = true\n" : "");
        scene.duration_s = 4.0;
        scene.ball_contact = {0.9, rough ? 0.3 : 0.0, 0.4};
        scene.wall_contact = {0.95, rough ? 0.2 : 0.0, 0.1};
        const auto toi = compose(scene, {"toi", ""});
        const std::vector<BallState> right = run(*toi, scene, 64);
        const std::vector<BallState> written =
            ran(scene, rough ? kRough : "normal = \"-(1 + e) * m * vn\"\n");
        for (std::size_t i = 0; i < right.size(); ++i) {
          // Some ten impacts, each multiplying an error by at most the gap over the radius, a few.
          EXPECT_LE((right[i].position - written[i].position).norm(), 1e-9) << seed;
          EXPECT_LE((right[i].spin - written[i].spin).norm(), 1e-8) << seed;
        }
      }
    }
  }
}

TEST(LawEngine, Settings_SayTheLaw) {
  const auto engine = make_law_engine({law_with("normal = \"-2 * k\"\n[let]\nk = \"m * vn\"\n")});
  const ScenarioPtr scene = gas(2, 2, 0.1, 2.0, 1);
  const Settings settings = engine->create(*scene, "my")->settings();
  EXPECT_EQ(std::get<std::string>(settings.at("law")), "A law");
  EXPECT_EQ(std::get<std::string>(settings.at("law_normal")), "-2 * k");
  EXPECT_EQ(std::get<std::string>(settings.at("law_let.k")), "m * vn");
}

TEST(LawEngine, AccountOfEnergy_IsThereForOppositeImpulsesOnly) {
  const ScenarioPtr scene = gas(2, 2, 0.1, 2.0, 1);
  EXPECT_TRUE(make_law_engine({law_with("normal = \"1\"")})->create(*scene, "my")->tally().energy.known);
  EXPECT_FALSE(make_law_engine({law_with("normal_1 = \"-1\"\nnormal_2 = \"1\"")})
                   ->create(*scene, "my")
                   ->tally()
                   .energy.known);
}

TEST(LawEngine, TangentialLaw_NeedsBallsThatTurn) {
  const auto engine = make_law_engine({law_with(kRough)});
  EXPECT_THAT(unsupported_reason(*engine, *gas(2, 2, 0.1, 2.0, 1), "my"), HasSubstr("balls cannot turn"));
}

/// A law without an end is told by itself, at the first impact.
TEST(LawEngine, LawThatDoesNotEndAnImpact_SaysSo) {
  const Ball left{1.0, 0.1, {-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, Vec3::Zero(), 0.4};
  const Ball right{1.0, 0.1, {1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, Vec3::Zero(), 0.4};
  const Scenario scene = free_scene(2, {left, right}, 2.0, 0.1);
  for (const std::string impulse : {"0", "m * vn", "0/0", "ln(vn)"}) {
    const auto engine = make_law_engine({law_with("normal = \"" + impulse + "\"")});
    const auto simulation = engine->create(scene, "my");
    try {
      simulation->advance(0.1, 20);
      ADD_FAILURE() << impulse;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(),
                  AllOf(HasSubstr("\"A law\" does not end an impact"), HasSubstr("vn = -2 m/s")));
    }
  }
}

}  // namespace
}  // namespace carom::test
