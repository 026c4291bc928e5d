#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "report/page/math.h"
#include "report/page/textbook.h"

namespace carom::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string chapter_of(const std::optional<TextbookFindings>& findings) {
  pugi::xml_document document;
  page::Node body = document.append_child("body");
  page::add_textbook(body, findings);
  return page::markup(body);
}

std::string cell(const std::string& text) {
  return "<td class=\"number\">" + text + "</td>";
}

TEST(TextbookChapter, IsAbsent_WhereNothingWasExamined) {
  EXPECT_EQ(chapter_of(std::nullopt), "<body></body>");
}

TEST(TextbookChapter, ShowsWhatWasMeasured) {
  TextbookFindings findings;
  findings.impulse = {123, 3.3e-7, 1.5e-7, 9e-7};
  findings.shifts = {{0.25, 1.0, 1.333, 0.333, 1.31}};
  findings.swapped = 0.75;
  findings.drops = {{77, -0.5, 0.25, -0.75}};
  findings.coincident = {2, 3, false};
  findings.squares = {{0.5, -1.0, -1.0, 7.0, 1.9375}};
  findings.rates = {{50, 1.0, 0.45, 0.46, 0.0042}};
  findings.spin = {0.628, 6.28};
  const std::string text = chapter_of(findings);
  EXPECT_THAT(text,
              AllOf(HasSubstr("123 random pairs"), HasSubstr("right to 6 digits"), HasSubstr("3.3e-7")));
  EXPECT_THAT(text, HasSubstr("25 %</th>" + cell("1") + cell("1.33") + cell("33.3 %") + cell("1.31")));
  EXPECT_THAT(text, HasSubstr("ends 0.75 overlaps"));
  EXPECT_THAT(text, HasSubstr("77</th>" + cell("−50 %") + cell("25 %") + cell("−75 %")));
  EXPECT_THAT(text, AllOf(HasSubstr("2 of 3 balls are nowhere, after four seconds 3"),
                          HasSubstr("lost with them"), Not(HasSubstr("untouched"))));
  EXPECT_THAT(text, HasSubstr("0.5</th>" + cell("−1 → −1") + cell("7 → 1.94")));
  EXPECT_THAT(text, HasSubstr("50</th>" + cell("1") + cell("45 %") + cell("46 %") + cell("0.0042")));
  EXPECT_THAT(text, AllOf(HasSubstr("turns by 0.628 rad"), HasSubstr("turns by 6.28 rad")));
}

TEST(TextbookChapter, FormulasAreMathMl_ThatIsWellFormed) {
  const std::string text = chapter_of(TextbookFindings());
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(text.c_str()));
  EXPECT_EQ(document.select_nodes("//math[@display='block']").size(), 3U);
  EXPECT_EQ(document.select_nodes("//math//mfrac[count(*) != 2]").size(), 0U);
  EXPECT_EQ(document.select_nodes("//math//msub[count(*) != 2]").size(), 0U);
  EXPECT_GT(document.select_nodes("//math//msub").size(), 10U);
}

TEST(Formula, EscapesItsSigns) {
  pugi::xml_document document;
  page::Node body = document.append_child("body");
  page::add_formula(body, {page::mi("a"), page::mo("<"), page::mtext("b & c")});
  EXPECT_THAT(page::markup(body),
              HasSubstr("<math display=\"block\"><mi>a</mi><mo>&lt;</mo><mtext>b &amp; c</mtext></math>"));
}

}  // namespace
}  // namespace carom::test
