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

}  // namespace
}  // namespace carom::test
