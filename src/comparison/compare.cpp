#include "comparison/compare.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "comparison/divergence.h"
#include "comparison/gates.h"
#include "comparison/metrics/contact.h"
#include "comparison/metrics/energy.h"
#include "comparison/metrics/momentum.h"
#include "comparison/metrics/positions.h"
#include "comparison/metrics/yardstick.h"
#include "comparison/predictability.h"
#include "comparison/statistics/statistics.h"

namespace carom {

namespace {

/// One run against the truth and against what physics conserves.
void measure(const Yardstick& yardstick, double tolerance_m, const std::vector<Conserved>& conserved,
             RunComparison& result) {
  measure_energy(yardstick, conserved, result);
  measure_momentum(yardstick, conserved, result);
  measure_angular_momentum(yardstick, conserved, result);
  measure_positions(yardstick, result);
  measure_contact(yardstick, result);
  result.energy_split = split_energy(yardstick.scene(), result.run);
  result.first_divergence = divergence_from_truth(yardstick, conserved, result, tolerance_m);
  if (yardstick.truth().known()) {
    result.judgement = judge(yardstick.scene(), yardstick.truth(), tolerance_m, result);
  }
}

void measure_statistics(const std::optional<Gas>& gas, RunComparison& result) {
  if (!gas || !gas->asked.reason.empty() || result.run.status != RunStatus::ok) return;
  result.statistics = measure_statistics(*gas, result.run.trajectory);
  result.metrics[Metric::statistics] = largest_deviation(*result.statistics);
}

/// Of two moments; nothing is never.
std::optional<double> earlier(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

/// Two runs against each other.
/// @param conserved  of each run
PairComparison pair_of(const Yardstick& yardstick, double tolerance_m, std::size_t a, std::size_t b,
                       const std::vector<RunComparison>& runs,
                       const std::vector<std::vector<Conserved>>& conserved) {
  const Trajectory& trajectory_a = runs[a].run.trajectory;
  const Trajectory& trajectory_b = runs[b].run.trajectory;
  const std::vector<Conserved>& conserved_a = conserved[a];
  const std::vector<Conserved>& conserved_b = conserved[b];
  PairComparison result;
  result.a = a;
  result.b = b;
  Apart apart;
  std::vector<double> angular_momenta;
  Distances distances;
  for (std::size_t k = 0; k < conserved_a.size(); ++k) {
    const Conserved& in_a = conserved_a[k];
    const Conserved& in_b = conserved_b[k];
    apart.position_m.push_back(distances.add(trajectory_a, trajectory_b, k));
    apart.energy.push_back(yardstick.by_energy(std::abs(in_a.energy_J - in_b.energy_J)));
    apart.momentum.push_back(yardstick.by_momentum((in_a.momentum_Ns - in_b.momentum_Ns).norm()));
    angular_momenta.push_back(
        yardstick.by_angular_momentum((in_a.angular_momentum_Nms - in_b.angular_momentum_Nms).norm()));
  }
  result.position_m = *largest(apart.position_m);
  result.position_rms_m = distances.root_mean_square();
  result.energy = largest(apart.energy);
  result.momentum = largest(apart.momentum);
  result.angular_momentum = largest(angular_momenta);
  result.first_divergence = first_divergence(trajectory_a, trajectory_b, apart, tolerance_m);
  return result;
}

}  // namespace

SceneComparison compare(ScenarioPtr scene, Truth truth, std::vector<Run> runs,
                        const std::vector<std::string>& under_test, std::vector<RunSymmetries> symmetries) {
  symmetries.resize(runs.size());
  SceneComparison result;
  result.scene = std::move(scene);
  result.truth = std::move(truth);
  result.position_tolerance_m = position_tolerance_m(*result.scene);
  result.predictability = predictability_of(*result.scene, result.truth, result.position_tolerance_m);
  result.truth.horizon_s = earlier(result.truth.horizon_s, result.predictability.horizon_s);
  const std::optional<Gas> gas = gas_of(*result.scene);
  if (gas) result.statistics = gas->asked;
  const Yardstick yardstick(*result.scene, result.truth);
  std::vector<std::vector<Conserved>> conserved(runs.size());
  for (Run& run : runs) {
    RunComparison& each = result.runs.emplace_back();
    each.run = std::move(run);
    each.under_test = std::find(under_test.begin(), under_test.end(), each.run.label()) != under_test.end();
    if (each.run.status == RunStatus::ok) {
      std::vector<Conserved>& own = conserved[result.runs.size() - 1];
      own = yardstick.conserved_of(each.run.trajectory);
      measure(yardstick, result.position_tolerance_m, own, each);
    }
    each.symmetries = std::move(symmetries[result.runs.size() - 1]);
    each.metrics[Metric::symmetry] = each.symmetries.worst_radii();
    measure_statistics(gas, each);
    hold_gates(result.scene->gate, each);
  }
  for (std::size_t a = 0; a < result.runs.size(); ++a) {
    for (std::size_t b = a + 1; b < result.runs.size(); ++b) {
      if (result.runs[a].run.status != RunStatus::ok || result.runs[b].run.status != RunStatus::ok) continue;
      result.pairs.push_back(pair_of(yardstick, result.position_tolerance_m, a, b, result.runs, conserved));
    }
  }
  return result;
}

}  // namespace carom
