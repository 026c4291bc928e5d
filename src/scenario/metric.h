#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace carom {

/// What is measured of a run, and what a gate can limit; all are >= 0 and better when smaller.
enum class Metric {
  energy,            ///< max |E - E_expected| / E_0
  energy_gain,       ///< max (E - E_expected) / E_0
  energy_loss,       ///< max (E_expected - E) / E_0
  momentum,          ///< max |P - P_expected| / Σ m|v| at t = 0
  angular_momentum,  ///< max |L - L_expected| / L_scale
  position,          ///< m, max over balls and frames against the truth
  position_rms,      ///< m, root mean square over balls and frames against the truth
  penetration,       ///< max overlap / smaller radius
  escaped,           ///< balls whose centre was behind a wall
  symmetry,          ///< max over [symmetry] checks of the distance from the twin / smallest radius
  statistics,        ///< the largest deviation of a gas from what theory expects of it, in allowances
};

inline constexpr std::array<std::string_view, 11> kMetricNames = {
    "energy",       "energy_gain", "energy_loss", "momentum", "angular_momentum", "position",
    "position_rms", "penetration", "escaped",     "symmetry", "statistics"};

constexpr std::string_view name_of(Metric metric) {
  return kMetricNames[static_cast<std::size_t>(metric)];
}

/// The values of one run; a metric that does not apply has none.
struct Metrics {
  std::array<std::optional<double>, kMetricNames.size()> values;

  std::optional<double>& operator[](Metric metric) { return values[static_cast<std::size_t>(metric)]; }
  const std::optional<double>& operator[](Metric metric) const {
    return values[static_cast<std::size_t>(metric)];
  }
};

}  // namespace carom
