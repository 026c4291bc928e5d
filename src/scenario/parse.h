#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.h"

namespace carom {

/// What the command line changes in a scene, what it knows that a scene may name, and what it refuses.
struct SceneOptions {
  std::optional<double> step_s;       ///< instead of `step`
  std::optional<std::uint64_t> seed;  ///< instead of the seed of every generator
  std::vector<std::string> engines;   ///< names allowed in [gate.<engine>]; none given: any name
  /// Of all tables together, and those that events add; more are refused before any is placed.
  std::size_t most_balls = std::numeric_limits<std::size_t>::max();
};

/// Reads a scene from TOML text. `file` is named in errors.
/// @throws InputError "file:line:column: key: what is wrong, what is allowed".
ScenarioPtr parse_scene(std::string_view toml_text, const std::string& file,
                        const SceneOptions& options = {});

/// Reads a scene from a file; its id is "<folder>/<name>".
/// @throws InputError as parse_scene(), and where the file cannot be read.
ScenarioPtr load_scene(const std::filesystem::path& file, const SceneOptions& options = {});

}  // namespace carom
