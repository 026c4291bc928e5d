#pragma once

#include <string>
#include <vector>

#include "comparison/coefficients.h"
#include "comparison/comparison.h"
#include "engine/engine.h"

namespace carom {

/// Where the program runs and how it was built.
struct Machine {
  std::string cpu;
  int cores = 1;
  std::string compiler;
  std::string build;  ///< CMake's build type
};

/// A reference engine that this build of the program lacks.
struct MissingEngine {
  std::string name;
  std::string package;  ///< the Debian package that it is built from
};

/// Everything that one invocation of the program found out. All reports are made from this.
struct Results {
  std::string version;  ///< of Carom
  Machine machine;
  std::vector<EngineInfo> engines;  ///< those that took part
  std::vector<MissingEngine> missing;
  std::vector<SceneComparison> scenes;
  std::vector<CoefficientPanel> coefficients;  ///< empty where they were not measured

  /// Whether every gate holds and every engine under test did what was asked of it.
  bool holds() const {
    for (const SceneComparison& scene : scenes) {
      for (const RunComparison& run : scene.runs) {
        if (run.violates()) return false;
      }
    }
    return true;
  }
};

}  // namespace carom
