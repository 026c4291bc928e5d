#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "comparison/coefficients.h"
#include "comparison/comparison.h"
#include "comparison/examine_textbook.h"
#include "comparison/law_report.h"
#include "engine/engine.h"

namespace carom {

/// Where the program runs and how it was built.
struct Machine {
  std::string cpu;
  int cores = 1;
  std::string compiler;
  std::string build;       ///< CMake's build type
  std::string flags = {};  ///< of the compiler, beside those that every build has

  bool operator==(const Machine&) const = default;
};

/// A reference engine that this build of the program lacks.
struct MissingEngine {
  std::string name;
  std::string package;  ///< the Debian package that it is built from
};

/// What came of holding the results against a baseline, beside the gates that stand with the runs.
struct BaselineFindings {
  /// What was not compared, with the reason.
  struct Group {
    std::string reason;
    std::vector<std::string> what;
  };
  /// A value that fell below the baseline's by more than the factor.
  struct Better {
    std::string scene;
    std::string engine;
    Metric metric = Metric::energy;
    double value = 0.0;
    double baseline = 0.0;
  };

  std::string file;
  double factor = 1.0;
  std::size_t compared = 0;  ///< values
  std::vector<Group> not_compared;
  std::vector<Better> better;
};

/// Everything that one invocation of the program found out. All reports are made from this.
struct Results {
  std::string version;  ///< of Carom
  Machine machine;
  std::vector<EngineInfo> engines;  ///< those that took part
  std::vector<MissingEngine> missing;
  std::vector<SceneComparison> scenes;
  std::vector<CoefficientPanel> coefficients;  ///< empty where they were not measured
  std::optional<TextbookFindings> textbook;    ///< where the course program was examined
  std::vector<LawReport> laws;                 ///< the right one first; empty where none were examined
  std::optional<std::uint64_t> seed;           ///< given instead of the scenes' own
  std::optional<BaselineFindings> baseline;    ///< where there was one to hold against

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
