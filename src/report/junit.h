#pragma once

#include <string>

#include "comparison/results.h"

namespace carom {

/// The gates as JUnit XML for a CI server: a test suite for each scene, a test case for each engine and
/// metric that is gated, by the scene, by a baseline or by both. Engines that are only shown are skipped test
/// cases.
std::string results_junit(const Results& results);

}  // namespace carom
