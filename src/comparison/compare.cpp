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

/// Two runs against each other, frame by frame.
class Meeting {
 public:
  /// @param a, b  indices of the runs
  /// @param conserved  of each run
  Meeting(const Yardstick& yardstick, std::size_t a, std::size_t b, const std::vector<RunComparison>& runs,
          const std::vector<std::vector<Conserved>>& conserved)
      : yardstick_(yardstick),
        trajectory_a_(runs[a].run.trajectory),
        trajectory_b_(runs[b].run.trajectory),
        conserved_a_(conserved[a]),
        conserved_b_(conserved[b]) {
    result_.a = a;
    result_.b = b;
  }

  void add(std::size_t frame) {
    const Conserved& in_a = conserved_a_[frame];
    const Conserved& in_b = conserved_b_[frame];
    apart_.position_m.push_back(distances_.add(trajectory_a_, trajectory_b_, frame));
    apart_.energy.push_back(yardstick_.by_energy(std::abs(in_a.energy_J - in_b.energy_J)));
    apart_.momentum.push_back(yardstick_.by_momentum((in_a.momentum_Ns - in_b.momentum_Ns).norm()));
    angular_momenta_.push_back(
        yardstick_.by_angular_momentum((in_a.angular_momentum_Nms - in_b.angular_momentum_Nms).norm()));
  }

  /// @pre all frames were added, in order
  PairComparison result(double tolerance_m) const {
    PairComparison result = result_;
    result.position_m = *largest(apart_.position_m);
    result.position_rms_m = distances_.root_mean_square();
    result.energy = largest(apart_.energy);
    result.momentum = largest(apart_.momentum);
    result.angular_momentum = largest(angular_momenta_);
    result.first_divergence = first_divergence(trajectory_a_, trajectory_b_, apart_, tolerance_m);
    return result;
  }

 private:
  const Yardstick& yardstick_;
  const Trajectory& trajectory_a_;
  const Trajectory& trajectory_b_;
  const std::vector<Conserved>& conserved_a_;
  const std::vector<Conserved>& conserved_b_;
  PairComparison result_;
  Apart apart_;
  std::vector<double> angular_momenta_;
  Distances distances_;
};

/// Every two runs that ended well.
std::vector<PairComparison> compare_pairs(const Yardstick& yardstick, double tolerance_m,
                                          const std::vector<RunComparison>& runs,
                                          const std::vector<std::vector<Conserved>>& conserved) {
  const auto ok = [&](std::size_t run) { return runs[run].run.status == RunStatus::ok; };
  std::vector<Meeting> meetings;
  for (std::size_t a = 0; a < runs.size(); ++a) {
    for (std::size_t b = a + 1; b < runs.size(); ++b) {
      if (ok(a) && ok(b)) meetings.emplace_back(yardstick, a, b, runs, conserved);
    }
  }
  // Frame after frame, not pair after pair: one frame of all runs fits into the near caches.
  const auto frames = static_cast<std::size_t>(yardstick.scene().frames) + 1;
  for (std::size_t k = 0; k < frames; ++k) {
    for (Meeting& meeting : meetings) meeting.add(k);
  }
  std::vector<PairComparison> pairs;
  pairs.reserve(meetings.size());
  for (const Meeting& meeting : meetings) pairs.push_back(meeting.result(tolerance_m));
  return pairs;
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
  result.pairs = compare_pairs(yardstick, result.position_tolerance_m, result.runs, conserved);
  return result;
}

}  // namespace carom
