#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/analyse.h"

namespace carom {

// How a study is put into words, in the terminal and on the page alike.

/// "box2d, velocity_iterations = 1": an engine with what is not as its profile has it.
std::string words_of(const Series& series);

/// "box2d, velocity_iterations = 1, step 1.04e-3 s"; an engine without a step has none.
std::string words_of(const StudyScene& scene, const StudyPoint& point);

/// "1.02", "~0.7" where errors scatter too much for a line, "rounding", "–" where there are too few
std::string words_of(const Order& order);

/// "1", "exact", "–" where the engine states none
std::string claim_of(const StudyScene& scene, const std::string& engine);

/// A time with a unit of its own, two or three digits: 413 ns, 3.1 µs, 24 ms, 1.7 s.
std::string time_words(double cpu_s);

/// "m", or "relative" where energy is measured
std::string unit_of(const StudyScene& scene);

/// "box2d (step 1.6e-3 s): 2.1e-5 m in 0.10 ms; carom needs 0.15 ms for that": where a peer is ahead.
std::string words_of(const StudyScene& scene, const std::string& own, const Lead& lead);

/// Whether the family took part and was timed, so that it can be held against its peers.
bool takes_part(const StudyScene& scene, const std::string& family);

}  // namespace carom
