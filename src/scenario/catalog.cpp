#include "scenario/catalog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/error.h"

namespace carom {

namespace fs = std::filesystem;

namespace {

/// In the order of ids: impact/head-on before impact/head-on-hard, although '-' stands before the '.' of
/// ".toml".
void sort_by_id(std::vector<fs::path>& files) {
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return std::pair(a.parent_path(), a.stem()) < std::pair(b.parent_path(), b.stem());
  });
}

std::vector<fs::path> toml_files_in(const fs::path& group) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(group)) {
    if (entry.is_regular_file() && entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  sort_by_id(files);
  return files;
}

}  // namespace

std::vector<fs::path> Catalog::all() const {
  if (!fs::is_directory(folder_))
    throw InputError(fmt::format("{}: no such folder of scenes", folder_.string()));
  std::vector<fs::path> files;
  for (const fs::directory_entry& group : fs::directory_iterator(folder_)) {
    if (!group.is_directory() || group.path().filename() == kLawGroup) continue;
    const std::vector<fs::path> in_group = toml_files_in(group);
    files.insert(files.end(), in_group.begin(), in_group.end());
  }
  sort_by_id(files);
  return files;
}

std::vector<fs::path> Catalog::resolve(const std::string& scene) const {
  if (scene == "all") return all();
  if (const fs::path file = folder_ / (scene + ".toml"); fs::is_regular_file(file)) return {file};
  if (fs::is_regular_file(scene)) return {fs::path(scene)};
  const std::string group = scene.ends_with('/') ? scene.substr(0, scene.size() - 1) : scene;
  for (const fs::path& folder : {folder_ / group, fs::path(scene)}) {
    if (group.empty() || !fs::is_directory(folder)) continue;
    if (std::vector<fs::path> files = toml_files_in(folder); !files.empty()) return files;
  }
  std::set<std::string> groups;
  for (const fs::path& file : all()) groups.insert(file.parent_path().filename().string() + "/");
  throw InputError(fmt::format(
      "no scene \"{}\"; allowed: an id (carom list scenarios shows them), a path to a .toml file, a group "
      "({}), or all",
      scene, fmt::join(groups, ", ")));
}

}  // namespace carom
