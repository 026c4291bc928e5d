#pragma once

#include <filesystem>

#include "core/files.h"
#include "scenario/catalog.h"

namespace carom {

// Where the program finds what belongs to it: the same places below a build folder and an installed prefix.

inline std::filesystem::path engine_folder() {
  return program_prefix() / "lib/carom/engines";
}
inline std::filesystem::path scenario_folder() {
  return program_prefix() / "share/carom/scenarios";
}
inline std::filesystem::path law_folder() {
  return scenario_folder() / kLawGroup;
}
inline std::filesystem::path web_folder() {
  return program_prefix() / "share/carom/reports/web";
}

/// The viewer, made by the build from the web folder's sources; not there where the build has no node.
inline std::filesystem::path viewer_folder() {
  return program_prefix() / "lib/carom/web";
}

}  // namespace carom
