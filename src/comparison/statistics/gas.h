#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "comparison/statistics/hard_ball_fluid.h"
#include "comparison/statistics/statistic.h"
#include "scenario/scenario.h"

namespace carom {

/// Fewer balls are no gas: of 50 the energies of single frames already fluctuate by a seventh of the
/// temperature, √(2/(dN)), and the asymptotic laws of distributions.h begin to hold.
inline constexpr std::size_t kFewestBalls = 50;

/// A scene as a gas: many balls in a box, in free flight between impacts. What theory expects of it.
struct Gas {
  const Scenario* scene = nullptr;
  int dimension = 2;
  std::size_t balls = 0;
  double energy_J = 0.0;       ///< kinetic, at the start
  double temperature_J = 0.0;  ///< 2E/(dN) at the start
  double packing = 0.0;        ///< of the whole box
  double mean_diameter_m = 0.0;
  std::vector<std::size_t> heavy;     ///< the balls of the heavier group; empty where all are alike
  std::optional<fluid::Boxed> boxed;  ///< where the fluid's theory holds
  std::string no_theory;              ///< why it does not
  /// Collisions of ball and ball in the whole box in a second, at the start's temperature: from `boxed`, by
  /// (7) there with the mean impulse of a pair J = √(2πTμ), μ its reduced mass, and a rate proportional to
  /// μ^{-1/2}; without it Enskog's for the mean diameter, to judge times with.
  double collisions_per_s = 0.0;
  double mass_delay =
      1.0;  ///< (m + M)²/(4 m M) of the extreme masses: how much longer energy takes to spread
  SceneStatistics asked;

  double collisions_per_ball_per_s() const { return 2.0 * collisions_per_s / static_cast<double>(balls); }
};

/// The scene as a gas; nothing where it has too few balls to be one. `asked` says what can be asked of it.
std::optional<Gas> gas_of(const Scenario& scene);

/// Whether this statistic is asked of the scene's runs.
bool is_asked(const Gas& gas, StatisticKind kind);

}  // namespace carom
