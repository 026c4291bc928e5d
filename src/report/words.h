#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "comparison/results.h"

namespace carom {

/// A number for people: three significant digits, "n/a" where there is none.
std::string short_number(std::optional<double> value);

/// The width of a terminal that every text is made for.
inline constexpr std::size_t kColumns = 80;

/// Words after an indented heading, broken into lines of a terminal's width, each with its end.
std::string wrapped(std::string_view heading, std::string_view text);

/// When and by what a run left the truth: "left the truth at t = 1.23 s, when balls 3 and 7 met"; that it did
/// not, where it did not; empty without a judgement.
std::string departure(const Scenario& scene, const RunComparison& run);

/// What is wrong with one limit that does not hold: "energy = 0.1 is above its limit 0.01".
std::string violation(const GateResult& gate);

/// What makes the check fail, one line each: scene, engine, metric, value and limit, or the reason of a run
/// that ended badly. Empty where everything holds.
std::vector<std::string> violations(const Results& results);

/// The violations of one run; empty where it violates nothing.
std::vector<std::string> violations(const SceneComparison& scene, const RunComparison& run);

/// What a baseline had to say beside violations, a line each: what was not compared and why, what became
/// better and how to take it over.
std::vector<std::string> baseline_lines(const Results& results);

/// One sentence on what was checked, for results in which nothing is violated.
std::string all_is_well(const Results& results);

}  // namespace carom
