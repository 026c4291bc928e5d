#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/files.h"

// A test that no program lists is not built, and could never fail.

namespace carom::test {
namespace {

TEST(Tests, AreAllListedInTheBuild) {
  namespace fs = std::filesystem;
  const fs::path tests = fs::path(CAROM_SOURCE_DIR) / "tests";
  const std::string build = read_file((tests / "CMakeLists.txt").string());
  int found = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(tests)) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with("_test.cpp")) continue;
    EXPECT_THAT(build, testing::ContainsRegex("[ /(]" + name)) << entry.path();
    ++found;
  }
  EXPECT_GT(found, 50);
}

// Tests run side by side: one that writes to a place of a fixed name takes it from under another's feet.
TEST(Tests, WriteToFoldersOfTheirOwn) {
  namespace fs = std::filesystem;
  const fs::path tests = fs::path(CAROM_SOURCE_DIR) / "tests";
  const fs::path makes_them = tests / "support/folder.h";
  const testing::Matcher<const std::string&> asks_for_the_common_folder =
      testing::ContainsRegex("(Temp[D]ir|temp[_]directory_path)\\(");
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(tests)) {
    const fs::path& file = entry.path();
    if ((file.extension() != ".cpp" && file.extension() != ".h") || file == makes_them) continue;
    EXPECT_THAT(read_file(file), testing::Not(asks_for_the_common_folder)) << file << ": see " << makes_them;
  }
  EXPECT_THAT(read_file(makes_them), asks_for_the_common_folder);
}

}  // namespace
}  // namespace carom::test
