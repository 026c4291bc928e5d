#include "comparison/law_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace carom::test {
namespace {

constexpr std::int64_t kPairs = 2000;

std::set<LawRule> broken(const LawReport& report) {
  std::set<LawRule> rules;
  for (const RuleResult& result : report.results) {
    if (!result.holds()) rules.insert(result.rule);
  }
  return rules;
}

std::set<LawRule> broken_by(const std::string& lines) {
  return broken(examine_law(parse_law("name = \"A law\"\n" + lines, "my.toml"), kPairs, 3));
}

const RuleResult& result_of(const LawReport& report, LawRule rule) {
  return report.results.at(static_cast<std::size_t>(rule));
}

TEST(LawReport, RightLaw_BreaksNothing) {
  for (const bool friction : {false, true}) {
    const LawReport report = examine_right_law(friction, kPairs, 2);
    EXPECT_EQ(broken(report), std::set<LawRule>());
    EXPECT_EQ(report.not_finite, 0);
    for (std::size_t i = 0; i < report.results.size(); ++i)
      EXPECT_EQ(report.results[i].rule, law_rules()[i].rule);
  }
}

TEST(LawReport, LawsOfTheCheckout_BreakWhatTheySay) {
  using R = LawRule;
  const std::vector<std::pair<std::string, std::set<R>>> rows = {
      {"right", {}},
      {"rough", {}},
      {"course-program", {R::rebound}},
      {"impulse-times-e", {R::rebound, R::parting}},
      {"mirrored", {R::momentum, R::rebound, R::pushing, R::angular_momentum, R::boost}},
      {"momentum-for-energy", {R::momentum, R::pushing, R::angular_momentum, R::boost}},
      {"swapped-velocities",
       {R::momentum, R::energy_elastic, R::energy_never_won, R::rebound, R::angular_momentum}}};
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CAROM_SOURCE_DIR "/scenarios/laws")) {
    files += entry.path().extension() == ".toml" ? 1 : 0;
  }
  EXPECT_EQ(files, rows.size());
  for (const auto& [name, rules] : rows) {
    const LawFile law = load_law(CAROM_SOURCE_DIR "/scenarios/laws/" + name + ".toml");
    EXPECT_EQ(broken(examine_law(law, kPairs, 3)), rules) << name;
    EXPECT_FALSE(law.about.empty()) << name;
  }
}

// Whatever an impulse makes of the masses: along the normal and of the approach alone it keeps momentum, and
// is the same from a train and in a mirror. Of masses 1:10⁴ some throw the light ball off ten thousand times
// as fast as it came.
TEST(LawReport, ImpulseOfTheApproach_KeepsItsRules_HoweverSteep) {
  for (const std::string impulse : {"-(1 + e) * m1 * vn", "-2 * m1 * vn", "-(1 + e) * (m1 + m2) * vn",
                                    "-m1 * m1 / m2 * vn", "-sqrt(m1 * m2) * vn"}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const LawFile law = parse_law("name = \"A law\"\nnormal = \"" + impulse + "\"\n", "my.toml");
      const std::set<LawRule> rules = broken(examine_law(law, kPairs, seed));
      for (const LawRule kept : {LawRule::momentum, LawRule::angular_momentum, LawRule::boost,
                                 LawRule::mirror, LawRule::units, LawRule::pushing}) {
        EXPECT_EQ(rules.count(kept), 0U)
            << impulse << ", rule " << static_cast<int>(kept) << ", seed " << seed;
      }
    }
  }
}

TEST(LawReport, EachRule_IsBrokenByWhatItIsFor) {
  using R = LawRule;
  const std::string right = "normal = \"-(1 + e) * m * vn\"\n";
  EXPECT_EQ(broken_by(right), std::set<R>());
  // Directions that only this frame knows; a preference for ball 1; a length that is no mass times speed.
  EXPECT_EQ(broken_by("normal = \"-(1 + e) * m * vn * (1 + 0.001 * nx^2)\"").count(R::mirror), 1U);
  EXPECT_EQ(broken_by("normal = \"-(1 + e) * m * vn * (1 + 0.001 * m1 / (m1 + m2))\"").count(R::exchange),
            1U);
  EXPECT_EQ(broken_by("normal = \"-(1 + e) * m * vn * r1 * r2\"").count(R::units), 1U);
  EXPECT_EQ(broken_by("normal = \"-(1 + e) * m * vn * (1 + 0.001 * v1 / (v1 + v2))\"").count(R::boost), 1U);
  EXPECT_EQ(broken_by("normal = \"(1 + e) * m * vn\"").count(R::pushing), 1U);
  EXPECT_EQ(broken_by("normal = \"-(1.001 + e) * m * vn\""),
            (std::set<R>{R::energy_elastic, R::energy_never_won, R::rebound}));
  // Friction that slides on where it should stick turns the slip round: energy may be won.
  EXPECT_EQ(broken_by(right + "tangential = \"-20 * mt * vt\""),
            (std::set<R>{R::energy_elastic, R::energy_never_won}));
}

TEST(LawReport, Numbers_AreThoseOfTheLaw) {
  const LawReport report =
      examine_law(parse_law("name = \"A law\"\nnormal = \"-1.5 * m * vn\"", "my.toml"), kPairs, 3);
  // v_n' = -0.5 v_n, so e is off by |0.5 - e|, e uniform: its largest is near ½, its median near ¼, with a
  // standard error of ½/√2000 = 0.011 of a quarter's place.
  EXPECT_NEAR(result_of(report, LawRule::rebound).worst, 0.5, 0.005);
  EXPECT_NEAR(result_of(report, LawRule::rebound).median, 0.25, 0.04);
  EXPECT_EQ(result_of(report, LawRule::rebound).broken_share, 1.0);
  EXPECT_EQ(report.pairs, kPairs);
}

TEST(LawReport, WorstPair_IsTheWorst) {
  const LawReport report =
      examine_law(parse_law("name = \"A law\"\nnormal = \"-2 * e * m * vn\"", "my.toml"), kPairs, 3);
  const RuleResult& result = result_of(report, LawRule::rebound);
  EXPECT_NEAR(result.worst, 1.0 - result.worst_pair.surface.restitution, 1e-12);
}

TEST(LawReport, SameSeed_SameBits) {
  const LawFile law = parse_law("name = \"A law\"\nnormal = \"-2 * m1 * vn\"", "my.toml");
  const LawReport once = examine_law(law, kPairs, 5);
  const LawReport twice = examine_law(law, kPairs, 5);
  const LawReport other = examine_law(law, kPairs, 6);
  for (std::size_t i = 0; i < once.results.size(); ++i) {
    EXPECT_EQ(once.results[i].worst, twice.results[i].worst);
    EXPECT_EQ(once.results[i].median, twice.results[i].median);
  }
  EXPECT_NE(result_of(once, LawRule::rebound).worst, result_of(other, LawRule::rebound).worst);
}

TEST(LawReport, WhatIsNoNumber_IsCounted) {
  const LawReport report = examine_law(
      parse_law("name = \"A law\"\nnormal = \"-(1 + e) * m * vn * sqrt(e - 0.5) / sqrt(e - 0.5)\"",
                "my.toml"),
      kPairs, 3);
  // e < ½ in half of the pairs, to 5 standard deviations of ½√2000.
  EXPECT_NEAR(static_cast<double>(report.not_finite), 1000.0, 5.0 * 22.4);
  EXPECT_FALSE(broken(report).contains(LawRule::momentum));
}

}  // namespace
}  // namespace carom::test
