#include "comparison/statistics/statistics.h"

#include <algorithm>

#include "comparison/statistics/cooling.h"
#include "comparison/statistics/equilibrium.h"

namespace carom {

RunStatistics measure_statistics(const Gas& gas, const Trajectory& trajectory) {
  RunStatistics statistics;
  measure_equilibrium(gas, trajectory, statistics);
  measure_cooling(gas, trajectory, statistics);
  return statistics;
}

std::optional<double> largest_deviation(const RunStatistics& statistics) {
  std::optional<double> largest;
  for (const Statistic& each : statistics.all) largest = std::max(largest.value_or(0.0), each.deviations);
  return largest;
}

std::string_view explanation_of(StatisticKind kind) {
  switch (kind) {
    case StatisticKind::speeds:
      return "The distribution of the speeds, by the largest distance D of its sum curve from the exact law "
             "of "
             "N balls with this energy (Maxwell and Boltzmann's, for N without end). Each frame is asked for "
             "every eighth ball, the next for others, so that the sample is as good as independent; expected "
             "and "
             "allowance are the mean and the scatter of D by Kolmogorov's law, and the deviation is that of "
             "a "
             "normal variable as rare as this D.";
    case StatisticKind::fourth_moment:
      return "How heavy the tails of the velocities are: a2 = ⟨v⁴⟩/((1 + 2/d)⟨v²⟩²) − 1, 0 in Maxwell's law "
             "and "
             "−2/(dN + 2) in the exact one of N balls. The allowance is its exact scatter in one moment, "
             "over as "
             "many moments as the run has, eight collisions of a ball apart.";
    case StatisticKind::collision_rate:
      return "Collisions of a ball with others in a second, against Enskog's rate with Carnahan and "
             "Starling's equation of state (in the plane Henderson's) for the box as it is: its walls keep "
             "the centres a radius away and press the gas together. The allowance is the scatter of the "
             "count between ten spans of the run, and the error of the theory.";
    case StatisticKind::wall_pressure:
      return "The push of the walls by time and area, against the same theory, with the wall's tension.";
    case StatisticKind::equipartition:
      return "The mean kinetic energy of heavy balls by that of light ones. The allowance is the scatter of "
             "their "
             "share of the energy between ten spans, and no less than the exact one of one moment over as "
             "many "
             "moments as the run has.";
    case StatisticKind::cooling:
      return "The temperature by that at the start, against Haff's law with Enskog's rate, while it is above "
             "a "
             "tenth: the frame that is off the most. The allowance is the chance in how hard balls meet, and "
             "the "
             "error of the theory, both growing with what has been lost.";
  }
  return {};
}

}  // namespace carom
