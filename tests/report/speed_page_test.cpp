#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "core/files.h"
#include "report/page/speed.h"
#include "tests/report/cells.h"
#include "tests/support/folder.h"

namespace carom::test {
namespace {

using page::Node;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string speed_chapter_of(const std::filesystem::path& file) {
  pugi::xml_document document;
  Node body = document.append_child("body");
  page::add_speed(body, file);
  return page::markup(body);
}

std::string speed_chapter_of_text(const std::string& text) {
  const test::TestFolder folder;
  write_file(folder / "speed-of-a-test.json", text);
  return speed_chapter_of(folder / "speed-of-a-test.json");
}

constexpr const char* kSpeed = R"({
  "machine": {"cpu": "a <chip>", "cores": 3, "compiler": "a compiler", "build": "Fast"}, "rounds": 7,
  "goals": [
    {"what": "faster", "unit": "", "at_least": 100, "measured": {"median": 120, "low": 110, "high": 130}, "met": true},
    {"what": "smaller", "unit": "bytes", "at_most": 200,
     "measured": {"median": 250, "low": 250, "high": 251}, "met": false}],
  "costs": [
    {"layout": "space", "per": "ball and step", "balls": 1000, "engine": "peer",
     "ns": {"median": 700, "low": 690, "high": 720}},
    {"layout": "space", "per": "ball and step", "balls": 1000, "engine": "own",
     "ns": {"median": 9, "low": 8, "high": 10}},
    {"layout": "space", "per": "ball and step", "balls": 10000, "engine": "own",
     "ns": {"median": 10, "low": 9, "high": 11}},
    {"layout": "dense", "per": "collision", "balls": 1000, "engine": "own",
     "ns": {"median": 1300, "low": 1200, "high": 1400}}]
})";

TEST(SpeedChapter, ShowsEachGoal_WithItsSpread_AndWhetherItIsReached) {
  EXPECT_THAT(speed_chapter_of_text(kSpeed),
              AllOf(HasSubstr("faster</td>" + cell("at least 100") + cell("120 (110 … 130)") +
                              "<td class=\"holds\">✓ yes</td>"),
                    HasSubstr("smaller</td>" + cell("at most 200 bytes") + cell("250 (250 … 251)") +
                              "<td class=\"broken\">✗ no</td>")));
}

TEST(SpeedChapter, ShowsEachEngineOverTheBalls_LeavingOpenWhatWasNotMeasured) {
  EXPECT_THAT(speed_chapter_of_text(kSpeed),
              AllOf(HasSubstr("peer</th>" + cell("700 (690 … 720)") + cell("–")),
                    HasSubstr("own</th>" + cell("9 (8 … 10)") + cell("10 (9 … 11)")),
                    HasSubstr("CPU time of one ball and step, ns: space"),
                    HasSubstr("CPU time of one collision, ns: dense")));
}

TEST(SpeedChapter, NamesTheMachine) {
  EXPECT_THAT(speed_chapter_of_text(kSpeed),
              HasSubstr("on a &lt;chip&gt; with 3 cores (a compiler, build Fast)"));
}

TEST(SpeedChapter, IsAbsentWithoutTheFile) {
  EXPECT_THAT(speed_chapter_of("/nowhere/speed.json"), Not(HasSubstr("speed")));
}

TEST(SpeedChapter, NamesTheFile_ThatItCannotUse) {
  for (const char* bad :
       {"{", "[]", "{}", R"({"machine": {"cpu": "a", "cores": 1, "compiler": "b", "build": "c"}})"}) {
    EXPECT_THAT([&] { speed_chapter_of_text(bad); },
                testing::ThrowsMessage<InputError>(AllOf(HasSubstr("speed-of-a-test.json"),
                                                         HasSubstr("tests/benchmarks/run writes it anew"))))
        << bad;
  }
}

}  // namespace
}  // namespace carom::test
