#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "tests/engines/plain/plain.h"

namespace carom::plain {

/// A way in which an engine can be wrong.
struct Defect {
  std::string_view name;  ///< the profile by which it is asked for: plain@<name>
  std::string_view what;  ///< what is broken, as part of a sentence
  std::unique_ptr<Simulation> (*make)(const Scenario& scene);
};

/// All of them. Which gate catches which stands in tests/gates/catches.h; one that nothing catches fails a
/// test.
const std::vector<Defect>& defects();

}  // namespace carom::plain
