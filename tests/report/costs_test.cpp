#include "report/page/costs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "core/files.h"
#include "tests/report/cells.h"
#include "tests/support/folder.h"

namespace carom::test {
namespace {

namespace fs = std::filesystem;

using page::Node;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// 1000 instructions per ball and step, three quarters more with walls, as many with spin; alone half a
// percent less; 40 bytes a ball, and 50 where it runs. A stepless evolver: 4000 instructions for each of 50
// impacts.
constexpr const char* kCosts = R"({
  "compiler": "a compiler", "build": "Fast",
  "instructions": [
    {"scene": "bare", "evolver": "toi", "balls": 10, "steps": 2, "impacts": 3, "instructions": 20000},
    {"scene": "bare", "evolver": "event", "balls": 10, "steps": 2, "impacts": 50, "instructions": 200000},
    {"scene": "walls", "evolver": "toi", "balls": 10, "steps": 2, "impacts": 3, "instructions": 35000},
    {"scene": "spin", "evolver": "toi", "balls": 10, "steps": 2, "impacts": 3, "instructions": 20000}
  ],
  "alone": [
    {"scene": "bare", "evolver": "toi", "balls": 10, "steps": 2, "impacts": 3, "instructions": 19900}
  ],
  "memory": [
    {"scene": "bare", "evolver": "toi", "balls": 10, "bytes": 400, "bytes_in_use": 500}
  ],
  "broad_phases": {"packing": 0.1, "growth": [
    {"broad_phase": "brute-force", "dimension": 3, "size_ratio": 1.0, "exponent_of_pair_tests": 2.0022,
     "exponent_of_total": 1.9878, "work": [
      {"balls": 100, "pair_tests": 4950, "total": 4951},
      {"balls": 1000, "pair_tests": 499500, "total": 499501}]},
    {"broad_phase": "octree", "dimension": 2, "size_ratio": 20.0, "exponent_of_pair_tests": 1.1,
     "exponent_of_total": 1.2, "work": [{"balls": 100, "pair_tests": 7, "total": 9}]}
  ]}
})";

/// A file in a folder of the test's own, gone with it.
class CostsChapter : public testing::Test {
 protected:
  void write(const std::string& text) { write_file(file(), text); }
  fs::path file() const { return folder_ / "costs.json"; }

  std::string chapter() const {
    pugi::xml_document document;
    Node body = document.append_child("body");
    page::add_costs(body, file());
    return page::markup(body);
  }

 private:
  test::TestFolder folder_;
};

TEST_F(CostsChapter, ShowsInstructionsPerBallAndStep_AndByThoseOfTheBareScene) {
  write(kCosts);
  EXPECT_THAT(chapter(), AllOf(HasSubstr("walls</th>" + cell("1750") + cell("1.750")),
                               HasSubstr("spin</th>" + cell("1000") + cell("1.000")),
                               HasSubstr("to the last one: spin in toi.")));
}

TEST_F(CostsChapter, CountsByTheImpact_WhereThereAreNoSteps) {
  write(kCosts);
  EXPECT_THAT(chapter(),
              AllOf(HasSubstr("bare</th>" + cell("1000") + cell("1.000") + cell("4000") + cell("1.000")),
                    HasSubstr("walls</th>" + cell("1750") + cell("1.750") + cell("–"))));
}

TEST_F(CostsChapter, HoldsTheWholeEngine_AgainstTheBareProgram) {
  write(kCosts);
  EXPECT_THAT(chapter(), HasSubstr("toi</th>" + cell("1000.0") + cell("995.0") + cell("0.503 %")));
}

TEST_F(CostsChapter, ShowsBytesPerBall_AsSetUpAndRunning) {
  write(kCosts);
  EXPECT_THAT(chapter(), HasSubstr("bare</th>" + cell("40.0") + cell("50.0")));
}

TEST_F(CostsChapter, ShowsTheGrowthOfBroadPhases_WithTheirExponents) {
  write(kCosts);
  EXPECT_THAT(chapter(), AllOf(HasSubstr("brute-force</td>" + cell("2.00") + cell("1.99") +
                                         cell("4.95e3 / 4.95e3") + cell("5e5 / 5e5")),
                               HasSubstr("plane, radii 1:20</th><td>octree</td>" + cell("1.10") +
                                         cell("1.20") + cell("7 / 9")),
                               HasSubstr("Work of a step, space, equal balls")));
}

TEST_F(CostsChapter, SaysWhereItsNumbersComeFrom) {
  write(kCosts);
  EXPECT_THAT(chapter(), AllOf(HasSubstr("tests/benchmarks/run; a compiler, build Fast"),
                               HasSubstr("not by the run that made this page")));
}

TEST_F(CostsChapter, IsLeftOut_WhereNothingWasMeasured) {
  EXPECT_THAT(chapter(), Not(HasSubstr("costs")));
}

TEST_F(CostsChapter, NamesTheFile_ThatItCannotUse) {
  for (const char* bad : {"{", "[]", "{\"compiler\": 1}", R"({"compiler": "a", "build": "b"})"}) {
    write(bad);
    try {
      chapter();
      ADD_FAILURE() << bad << " was taken";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(file().string()));
    }
  }
}

// What is committed is what the chapter takes.
TEST(Costs, AreThere_ForThePageOfThisProgram) {
  pugi::xml_document document;
  Node body = document.append_child("body");
  page::add_costs(body, fs::path(CAROM_SOURCE_DIR) / "reports/measured/costs.json");
  EXPECT_THAT(page::markup(body), AllOf(HasSubstr("quadratic-drag"), HasSubstr("octree")));
}

}  // namespace
}  // namespace carom::test
