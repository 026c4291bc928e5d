#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace carom {

/// By how much an evolver is off at the end of a scene.
struct StepError {
  double step_s = 0.0;      ///< the longest of the steps that the error is averaged over
  double error_m = 0.0;     ///< the largest distance of a ball from its true place, averaged
  double rounding_m = 0.0;  ///< what rounding alone may bring it to
};

/// How the error of an evolver falls with its step.
struct Convergence {
  std::string scene;              ///< "impact/oblique"
  std::string evolver;            ///< "step"
  std::string refuses;            ///< why it does not take the scene; nothing else is known then
  std::optional<int> claimed;     ///< the order; none: exact, but for rounding
  std::vector<StepError> errors;  ///< the step halved from each to the next
  std::optional<double> order;    ///< p in error ~ stepᵖ by least squares; none where all is rounding
  double r_squared = 0.0;         ///< of that fit

  bool is_rounding() const;
};

/// The order that an evolver states in the list of evolvers. None: exact, but for rounding.
std::optional<int> claimed_order(const std::string& evolver, const Scenario& scene);

/// Every evolver in every scene that is measured, against the closed form.
/// @param scenes  the folder of scene files. @throws InputError where one cannot be read
std::vector<Convergence> measure_convergence(const std::filesystem::path& scenes);

}  // namespace carom
