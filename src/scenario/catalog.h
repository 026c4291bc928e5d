#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace carom {

/// The folder among the groups that holds laws of impact (carom/laws/law_file.h), and no scenes.
inline constexpr std::string_view kLawGroup = "laws";

/// The scene files below a folder laid out as <group>/<name>.toml, in the order of their ids.
class Catalog {
 public:
  explicit Catalog(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::vector<std::filesystem::path> all() const;

  /// The files that a word of the command line means: an id "group/name", a group "group/", a path to a file,
  /// or "all". @throws InputError where it means none, with what there is.
  std::vector<std::filesystem::path> resolve(const std::string& scene) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace carom
