#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

// Data flows one way, and so do the includes: a folder includes only folders that stand before it.

namespace carom::test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kOrder = {"core",       "scenario", "engine", "carom", "trajectory",
                                         "comparison", "study",    "report", "lab",   "app"};

/// What reference engines and oracles may include of ours: a scene comes in, states go out, nothing is shared
/// with what they judge.
const std::set<std::string> kOpenToReferences = {"core", "scenario", "engine", "reference"};

std::vector<fs::path> sources_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".h" || extension == ".cpp") files.push_back(entry.path());
  }
  return files;
}

/// The first folder of every quoted include of a file.
std::vector<std::string> included_folders(const fs::path& file) {
  static const std::regex include("^\\s*#include \"([^/\"]+)/");
  std::vector<std::string> folders;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (std::regex_search(line, match, include)) folders.push_back(match[1]);
  }
  return folders;
}

std::ptrdiff_t place_of(const std::string& folder) {
  return std::find(kOrder.begin(), kOrder.end(), folder) - kOrder.begin();
}

TEST(Includes, RunOneWay_InSrc) {
  const fs::path src = fs::path(CAROM_SOURCE_DIR) / "src";
  std::set<std::string> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(src)) {
    if (entry.is_directory()) folders.insert(entry.path().filename().string());
  }
  EXPECT_EQ(folders, std::set<std::string>(kOrder.begin(), kOrder.end()))
      << "a folder without a place in the order";
  for (const fs::path& file : sources_below(src)) {
    const std::string own = fs::relative(file, src).begin()->string();
    for (const std::string& folder : included_folders(file)) {
      if (folder == "reference") {
        EXPECT_EQ(own, "app") << file << " includes what Carom is measured against";
        continue;
      }
      EXPECT_LE(place_of(folder), place_of(own)) << file << " includes " << folder;
    }
  }
}

TEST(Includes, OfReferences_ShareNothingWithWhatTheyJudge) {
  for (const fs::path& file : sources_below(fs::path(CAROM_SOURCE_DIR) / "reference")) {
    for (const std::string& folder : included_folders(file)) {
      if (place_of(folder) == static_cast<std::ptrdiff_t>(kOrder.size()) && folder != "reference") continue;
      EXPECT_TRUE(kOpenToReferences.contains(folder)) << file << " includes " << folder;
    }
  }
}

}  // namespace
}  // namespace carom::test
