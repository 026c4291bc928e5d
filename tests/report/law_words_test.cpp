#include "report/law_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "report/page/laws.h"

namespace carom::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const LawReport& right() {
  static const LawReport report = examine_right_law(false, 500, 1);
  return report;
}

LawReport report_on(const std::string& lines) {
  return examine_law(parse_law("name = \"A <law>\"\nabout = \"**Bold** words.\"\n" + lines, "my.toml"), 500,
                     1);
}

TEST(LawTable, SaysWhatHolds_AndWhatDoesNot_InEightyColumns) {
  const std::string text = law_table(report_on("normal = \"-2 * k\"\n[let]\nk = \"m * vn\"\n"), right());
  EXPECT_THAT(
      text,
      AllOf(HasSubstr("A <law> (my.toml)\n  let.k = m * vn\n  normal = -2 * k\n  500 random pairs, seed 1\n"),
            HasSubstr("momentum is kept                        yes"),
            HasSubstr("balls part with e times the approach    0 %"),
            HasSubstr("rebound: error of e; worst for m1 = ")));
  std::size_t line = 0;
  for (const char c : text) {
    // Bytes that go on with a character take no column.
    line = c == '\n' ? 0 : line + ((static_cast<unsigned char>(c) & 0xC0U) == 0x80U ? 0 : 1);
    EXPECT_LE(line, 80U);
  }
}

TEST(LawTable, OfTheRightLaw_SaysThatNothingIsBroken) {
  EXPECT_THAT(law_table(report_on("normal = \"-(1 + e) * m * vn\""), right()),
              HasSubstr("Nothing is broken."));
}

TEST(LawTable, SaysForHowManyPairsTheLawIsNoNumber) {
  EXPECT_THAT(law_table(report_on("normal = \"sqrt(-1)\""), right()),
              HasSubstr("for 500 of them the law is not a number"));
}

TEST(LawJson, HasEveryRule_BesideTheRightLaw) {
  const auto json = nlohmann::json::parse(law_json(report_on("normal = \"-2 * m * vn\""), right()));
  EXPECT_EQ(json.at("law"), "A <law>");
  EXPECT_EQ(json.at("expressions").at("normal"), "-2 * m * vn");
  ASSERT_EQ(json.at("rules").size(), law_rules().size());
  const auto& rebound = json.at("rules").at(3);
  EXPECT_EQ(rebound.at("rule"), "rebound");
  EXPECT_EQ(rebound.at("holds"), false);
  EXPECT_EQ(rebound.at("broken_share"), 1.0);
  EXPECT_GT(rebound.at("worst"), 0.9);
  EXPECT_LT(rebound.at("right_worst"), 1e-12);
  EXPECT_GT(rebound.at("worst_pair").at("one").at("mass"), 0.0);
}

TEST(LawVocabulary, NamesEverything_Once) {
  const std::string text = law_vocabulary();
  EXPECT_THAT(text, AllOf(HasSubstr("\n  m1            mass of ball 1, kg\n"),
                          HasSubstr("\n  v1x, v1y, v1z velocity of ball 1, m/s\n"), HasSubstr("atan2"),
                          Not(HasSubstr("avg"))));
}

std::string chapter_of(const std::vector<LawReport>& reports) {
  pugi::xml_document document;
  page::Node body = document.append_child("body");
  page::add_laws(body, reports);
  return page::markup(body);
}

TEST(LawsChapter, ShowsEachLaw_WithItsFormulaAndWhatItBreaks) {
  EXPECT_EQ(chapter_of({}), "<body></body>");
  const std::string text = chapter_of({right(), report_on("normal = \"-2 * e * m * vn\"")});
  EXPECT_THAT(text,
              AllOf(HasSubstr(">A &lt;law&gt;</th>"), HasSubstr("<code>normal = -2 * e * m * vn</code>"),
                    HasSubstr("<strong>Bold</strong>"), HasSubstr(" always</td>"), HasSubstr(" in 0 %</td>"),
                    HasSubstr("balls part with e times the approach: error of e;"),
                    HasSubstr("In how many of 500 random pairs it holds")));
  // The right law is compiled in, and has no file to show.
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(text.c_str()));
  EXPECT_EQ(document.select_nodes("//details").size(), 1U);
}

}  // namespace
}  // namespace carom::test
