#include "scenario/catalog.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/support/folder.h"

namespace carom {

namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A catalog of four scenes, with things around them that are none.
class CatalogTest : public ::testing::Test {
 protected:
  CatalogTest() {
    for (const char* file : {"wall/bounce.toml", "impact/head-on.toml", "impact/head-on-hard.toml",
                             "impact/b.toml", "impact/notes.md", "README.md", "stray.toml"}) {
      touch(file);
    }
    fs::create_directories(folder_ / "empty");
    fs::create_directories(folder_ / "wall" / "folder.toml");
  }

  void touch(const fs::path& file) const {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << "\n";
  }

  std::vector<std::string> names(const std::vector<fs::path>& files) const {
    std::vector<std::string> names;
    names.reserve(files.size());
    for (const fs::path& file : files) names.push_back(fs::relative(file, folder_.path()).string());
    return names;
  }

  std::string error_of(const std::string& word) const {
    try {
      catalog_.resolve(word);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  test::TestFolder folder_;
  Catalog catalog_{folder_.path()};
};

// An id that begins with another one comes after it: impact/head-on, impact/head-on-hard.
TEST_F(CatalogTest, All_IsInTheOrderOfTheIds) {
  EXPECT_THAT(names(catalog_.all()), ElementsAre("impact/b.toml", "impact/head-on.toml",
                                                 "impact/head-on-hard.toml", "wall/bounce.toml"));
  EXPECT_EQ(catalog_.resolve("all"), catalog_.all());
}

TEST_F(CatalogTest, Id_IsItsFile) {
  EXPECT_THAT(names(catalog_.resolve("impact/head-on")), ElementsAre("impact/head-on.toml"));
}

TEST_F(CatalogTest, Group_IsItsFilesInTheOrderOfTheIds) {
  EXPECT_THAT(names(catalog_.resolve("impact/")),
              ElementsAre("impact/b.toml", "impact/head-on.toml", "impact/head-on-hard.toml"));
  EXPECT_EQ(catalog_.resolve("impact"), catalog_.resolve("impact/"));
}

TEST_F(CatalogTest, Path_IsTheFileWhateverItIsCalled) {
  EXPECT_THAT(names(catalog_.resolve((folder_ / "stray.toml").string())), ElementsAre("stray.toml"));
  EXPECT_THAT(names(catalog_.resolve((folder_ / "README.md").string())), ElementsAre("README.md"));
}

TEST_F(CatalogTest, FolderElsewhere_IsItsFiles) {
  EXPECT_THAT(names(Catalog("/nowhere").resolve((folder_ / "impact").string())),
              ElementsAre("impact/b.toml", "impact/head-on.toml", "impact/head-on-hard.toml"));
}

TEST_F(CatalogTest, UnknownWord_IsAnErrorThatSaysWhatThereIs) {
  for (const std::string word :
       {"impact/nothing", "nothing/", "", "/", "empty/", "impact/head-on.toml", "ALL"}) {
    const std::string message = error_of(word);
    EXPECT_THAT(message, HasSubstr("no scene \"" + word + "\""));
    EXPECT_THAT(message, HasSubstr("impact/, wall/"));
    EXPECT_THAT(message, HasSubstr("carom list scenarios"));
  }
}

TEST_F(CatalogTest, MissingFolder_IsAnErrorThatNamesIt) {
  try {
    Catalog("/nowhere").all();
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere"));
  }
}

TEST(CatalogOfTheCheckout, EveryScene_IsFoundByItsId) {
  const Catalog catalog(CAROM_SOURCE_DIR "/scenarios");
  EXPECT_FALSE(catalog.all().empty());
  for (const fs::path& file : catalog.all()) {
    const std::string id = file.parent_path().filename().string() + "/" + file.stem().string();
    EXPECT_THAT(catalog.resolve(id), ElementsAre(file));
  }
}

}  // namespace

}  // namespace carom
