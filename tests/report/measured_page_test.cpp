#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "core/files.h"
#include "report/page/measured.h"
#include "tests/support/folder.h"

namespace carom::test {
namespace {

using page::Node;
using testing::AllOf;
using testing::HasSubstr;

std::string measured_chapter_of(const std::string& text) {
  const TestFolder folder;
  const std::filesystem::path file = folder / "published.json";
  write_file(file, text);
  pugi::xml_document document;
  Node body = document.append_child("body");
  page::add_measured(body, file);
  return page::markup(body);
}

TEST(MeasuredChapter, ShowsValuesVerdictsAndTheSourceWithItsDoi) {
  const std::string text = measured_chapter_of(R"([{"key": "k", "title": "On spheres", "authors": "A. Author",
    "journal": "Journal 1, 2", "year": 1999, "doi": "10.1/x", "note": "A note.", "values": [
    {"name": "first", "unit": "m/s", "published": 0.5, "uncertainty": 0.01, "uncertainty_from": "stated",
     "measured": 0.501, "measured_uncertainty": 0.002, "meets": true, "why": ""},
    {"name": "second", "unit": "", "published": 1.0, "uncertainty": 0.01, "uncertainty_from": "stated",
     "measured": 1.5, "measured_uncertainty": 0.0, "meets": false, "why": "because"},
    {"name": "third", "unit": "", "published": null, "uncertainty": null, "uncertainty_from": "",
     "measured": 2.0, "measured_uncertainty": 0.0, "meets": false, "why": "no law"}]}])");
  EXPECT_THAT(text, AllOf(HasSubstr("0.5 ± 0.01 m/s"), HasSubstr("0.501 ± 0.002 m/s"), HasSubstr("✓"),
                          HasSubstr("within"), HasSubstr("outside"), HasSubstr("because"),
                          HasSubstr("cannot"), HasSubstr("no law"), HasSubstr("A. Author: On spheres."),
                          HasSubstr("Journal 1, 2 (1999)")));
  EXPECT_THAT(text, AllOf(HasSubstr("href=\"https://doi.org/10.1/x\""), HasSubstr("A note.")));
}

TEST(MeasuredChapter, IsAbsentWithoutTheFile_AndNamesABadOne) {
  pugi::xml_document document;
  page::add_measured(document.append_child("body"), "/nowhere/published.json");
  EXPECT_TRUE(document.child("body").first_child().empty());
  EXPECT_THAT([] { measured_chapter_of("[{}]"); },
              testing::ThrowsMessage<InputError>(HasSubstr("tests/benchmarks/run writes it anew")));
}

}  // namespace
}  // namespace carom::test
