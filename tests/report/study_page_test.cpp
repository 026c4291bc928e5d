#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <string>

#include "report/page.h"
#include "report/page/axis.h"
#include "report/page/study.h"
#include "tests/report/studies.h"

namespace carom::test {
namespace {

using page::Node;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::string chapter_of(const Study& study) {
  pugi::xml_document document;
  Node body = document.append_child("body");
  page::add_study(body, study, "## How to\n\nRead *this*.");
  return page::markup(body);
}

TEST(StudyChapter, HasADiagramWithEveryTimedRun_AndItsSetting) {
  const std::string text = chapter_of(some_study());
  EXPECT_THAT(text, AllOf(HasSubstr("<title>carom:event: 1e-15 m in 2.0 µs</title>"),
                          HasSubstr("<title>peer, step 0.1 s: 0.001 m in 1.0 µs</title>"),
                          HasSubstr("<title>peer, step 0.001 s: 1e-5 m in 100 µs</title>"),
                          HasSubstr("the truth is known to here")));
  EXPECT_THAT(
      text, HasSubstr("The front: peer, step 0.1 s: 0.001 m in 1.0 µs and carom:event: 1e-15 m in 2.0 µs."));
}

TEST(StudyChapter, ShowsClaimAndFit_PriceAndFailures) {
  const std::string text = chapter_of(some_study());
  EXPECT_THAT(text, AllOf(HasSubstr(" peer</th><td class=\"number\">1</td><td class=\"number\">1.00</td>"
                                    "<td class=\"number\">1.0000</td><td class=\"number\">4 of 4</td>"
                                    "<td class=\"number\">1e-6</td><td class=\"number\">10</td>"),
                          HasSubstr(" carom:event</th><td class=\"number\">exact</td>"),
                          HasSubstr("crashed: ended by a \"signal\", early")));
}

TEST(StudyChapter, SaysWhereAPeerIsAhead_AndWhereNoneIs) {
  Study study = some_study();
  EXPECT_THAT(chapter_of(study), AllOf(HasSubstr("at or below every peer's in 0 of 1 scene"),
                                       HasSubstr("impact/some: peer, step 0.1 s: 0.001 m in 1.0 µs")));
  study.scenes[0].points[0].cpu_s = {5e-7};
  EXPECT_THAT(chapter_of(study),
              AllOf(HasSubstr("at or below every peer's in 1 of 1 scene"), Not(HasSubstr("needs"))));
}

TEST(StudyChapter, PricesADigitOfTheCheapest_FromOneToleranceToTheNext) {
  Study study = some_study();
  study.scenes[0].points[0].cpu_s = {9e-6};
  // From 1 µs for 0.01 to 9 µs for 0.0001: two digits for nine times the time; its quartiles agree.
  EXPECT_THAT(chapter_of(study),
              HasSubstr("<td>carom:event</td><td class=\"number\">9.0 µs (9.0 µs – 9.0 µs)</td>"
                        "<td class=\"number\">1e-15</td><td class=\"number\">3</td>"));
}

TEST(StudyChapter, SaysHowItWasMeasured_AndHowToReadIt) {
  EXPECT_THAT(chapter_of(some_study()), AllOf(HasSubstr("a compiler, build Release (-O3)"),
                                              HasSubstr("a CPU"), HasSubstr("Read <em>this</em>")));
}

TEST(StudyChapter, EscapesWhatAScenesTitleSays) {
  EXPECT_THAT(chapter_of(some_study()), AllOf(HasSubstr("Some &lt;impact&gt;"), Not(HasSubstr("<impact>"))));
}

TEST(StudyChapter, LivesWithASceneOfWhichNothingIsKnown) {
  Study study = some_study();
  for (StudyPoint& point : study.scenes[0].points) point.cpu_s.clear();
  EXPECT_THAT(chapter_of(study), Not(HasSubstr("Work and precision")));
}

TEST(StudyChapter, ShowsTheGrowthOfTheCost) {
  Study study = some_study();
  StudyGrowth growth{2, 0.2, "peer", {}};
  for (const std::int64_t balls : {10, 100, 1000}) {
    growth.points.push_back({balls, RunStatus::ok, "", 20, 5, {2e-6 * static_cast<double>(balls)}});
  }
  study.growths.push_back(growth);
  EXPECT_THAT(chapter_of(study),
              AllOf(HasSubstr("peer, plane</th><td class=\"number\">1.00</td>"),
                    HasSubstr("<title>peer, 100 balls: 100 ns</title>"), HasSubstr("20 % in the plane")));
}

TEST(StudyPage, IsWellFormed_AndOfItself) {
  const std::string text =
      render_study_page(some_study(), std::filesystem::path(CAROM_SOURCE_DIR) / "reports/web");
  pugi::xml_document document;
  const std::size_t body = text.find("<body");
  EXPECT_TRUE(document.load_string(text.substr(body, text.find("</html>") - body).c_str()));
  EXPECT_THAT(text, HasSubstr("How to read a work–precision diagram"));
}

TEST(StudyPage, IsAChapterOfTheReport_WhereThereIsAStudy) {
  const std::filesystem::path web = std::filesystem::path(CAROM_SOURCE_DIR) / "reports/web";
  const Study study = some_study();
  EXPECT_THAT(render_page({}, web, {}, &study),
              AllOf(HasSubstr("href=\"#study\""), HasSubstr("id=\"study\"")));
  EXPECT_THAT(render_page({}, web), AllOf(Not(HasSubstr("href=\"#study\"")), Not(HasSubstr("id=\"study\""))));
}

TEST(Axis, OfPowers_NamesNoZero) {
  const page::Axis axis = page::Axis::powers(3e-7, 2e-2);
  std::vector<std::string> labels;
  for (const page::Tick& tick : axis.ticks(9)) labels.push_back(tick.label);
  EXPECT_THAT(labels, ElementsAre("1e-7", "1e-6", "1e-5", "1e-4", "1e-3", "1e-2", "1e-1"));
  EXPECT_EQ(axis.fraction(1e-7), 0.0);
  EXPECT_EQ(axis.fraction(0.1), 1.0);
}

}  // namespace
}  // namespace carom::test
