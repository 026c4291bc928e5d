#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace carom {

// What is measured of a run of many balls where trajectories are chaotic and only statistics can be compared:
// data only, made by measure_statistics() (statistics.h), read by the reports.

enum class StatisticKind {
  speeds,          ///< speed distribution against Maxwell and Boltzmann's, Kolmogorov-Smirnov
  fourth_moment,   ///< a2 of the velocities
  collision_rate,  ///< collisions of ball and ball in a second
  wall_pressure,   ///< force on the walls by their area
  equipartition,   ///< kinetic energy of heavy balls by that of light ones
  cooling,         ///< temperature of an inelastic gas against Haff's law
};

inline constexpr std::array<std::string_view, 6> kStatisticNames = {
    "speeds", "fourth_moment", "collision_rate", "wall_pressure", "equipartition", "cooling"};

constexpr std::string_view name_of(StatisticKind kind) {
  return kStatisticNames[static_cast<std::size_t>(kind)];
}

/// What is compared and how its allowance is derived, in a few sentences for people.
std::string_view explanation_of(StatisticKind kind);

/// One statistic of one run.
struct Statistic {
  StatisticKind kind = StatisticKind::speeds;
  double value = 0.0;
  double expected = 0.0;
  double allowance = 0.0;   ///< one standard deviation of value - expected: of chance and of the theory
  double deviations = 0.0;  ///< how far it is off, in allowances; >= 0
  std::string detail;       ///< what else there is to say: p, sample, when

  bool as_expected() const { return deviations <= kMostDeviations; }

  /// By chance a normal variable is off by this many standard deviations once in 16,000 times: a report holds
  /// some hundred such numbers.
  static constexpr double kMostDeviations = 4.0;
};

/// A statistic that cannot be asked, and why.
struct NotAsked {
  StatisticKind kind = StatisticKind::speeds;
  std::string reason;
};

/// What is asked of every run of a scene.
struct SceneStatistics {
  std::string reason;  ///< why nothing is asked; empty where something is
  std::vector<NotAsked> not_asked;
  double warm_up_s = 0.0;            ///< what is left out in front
  double collisions_per_ball = 0.0;  ///< expected over what is left
  double temperature_J = 0.0;        ///< T, ½ T for each degree of freedom, at the start
  // Speeds in units of each ball's √(T/m), in cells of equal width from 0: the share of balls per cell by its
  // width. Empty where speeds are not asked.
  double cell_width = 0.0;
  std::vector<double> speed_density;  ///< of the exact law
};

struct RunStatistics {
  std::vector<Statistic> all;         ///< in the order of StatisticKind
  std::vector<NotAsked> not_asked;    ///< of this run alone
  std::vector<double> speed_density;  ///< over the frames that are asked, in the scene's cells
};

/// The largest deviation of any, in allowances; nothing where none was asked.
std::optional<double> largest_deviation(const RunStatistics& statistics);

}  // namespace carom
