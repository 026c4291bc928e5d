#include "report/page/catches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "core/files.h"
#include "tests/support/folder.h"

namespace carom::test {
namespace {

namespace fs = std::filesystem;

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string chapter(const fs::path& file) {
  pugi::xml_document document;
  page::Node body = document.append_child("body");
  page::add_catches(body, file);
  return page::markup(body);
}

class CatchesChapter : public testing::Test {
 protected:
  std::string of(const std::string& text) const {
    write_file(file_, text);
    return chapter(file_);
  }
  test::TestFolder folder_;
  fs::path file_ = folder_ / "catches.json";
};

TEST_F(CatchesChapter, ShowsWhatIsBroken_AndWhatCatchesIt) {
  EXPECT_THAT(of(R"({"catches": [{"engine": "plain@leak", "broken": "a <leak>", "scene": "gas/hundred-2d",
                     "metric": "momentum", "value": 1e-3, "limit": 1e-12, "caught": true},
                    {"engine": "plain@twist", "broken": "a twist", "scene": "x/y", "metric": "energy",
                     "value": 0.0, "limit": 1.0, "caught": false}]})"),
              AllOf(HasSubstr("leak</th><td>A &lt;leak&gt;.</td><td>gas/hundred-2d</td><td>momentum</td>"),
                    HasSubstr("<td>not caught</td>")));
}

TEST_F(CatchesChapter, IsLeftOut_WhereNothingWasFoundOut) {
  EXPECT_THAT(chapter(file_), Not(HasSubstr("catches")));
}

TEST_F(CatchesChapter, NamesTheFile_ThatItCannotUse) {
  for (const char* bad : {"{", "[]", "{}", R"({"catches": [{"engine": "a"}]})"}) {
    EXPECT_THROW(of(bad), InputError) << bad;
  }
}

// What is committed is what the chapter takes.
TEST(Catches, AreThere_ForThePageOfThisProgram) {
  EXPECT_THAT(chapter(fs::path(CAROM_SOURCE_DIR) / "reports/measured/gates.json"),
              AllOf(HasSubstr("momentum-leak"), Not(HasSubstr("not caught"))));
}

}  // namespace
}  // namespace carom::test
