#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comparison/energy_split.h"
#include "comparison/statistics/statistic.h"
#include "comparison/symmetry.h"
#include "scenario/metric.h"
#include "scenario/scenario.h"
#include "trajectory/trajectory.h"
#include "trajectory/truth.h"

namespace carom {

// The result of comparing the runs of one scene: data only, made by compare() (compare.h), read by the
// reports.

/// Where a run first leaves what it is compared with.
struct Divergence {
  double time_s = 0.0;
  std::vector<std::size_t> balls;  ///< those that are off the most, at most two
  Metric metric = Metric::position;
  /// The impact of the true motion by which the ball that is off the most went wrong; nothing where it did in
  /// flight, or the truth does not tell its impacts.
  std::optional<TrueImpact> cause = std::nullopt;
};

/// How right a run is where the truth is known.
enum class Accuracy {
  exact,             ///< within the truth's uncertainty and what rounding makes of its precision
  within_tolerance,  ///< off by more, but by less than would show
  chaos,      ///< parted from the truth as rounding alone explains, grown by the scene's own instability
  systematic  ///< parted from the truth for another reason
};

struct Judgement {
  Accuracy accuracy = Accuracy::exact;
  std::optional<double> beyond_rounding_s;  ///< when the error first was more than rounding explains
};

/// How fast errors grow in a scene, from its truth.
struct Predictability {
  std::optional<double> growth_rate_per_s;  ///< λ: an error δ becomes δ e^{λt}
  double growth_r_squared = 0.0;            ///< of the fit of λ
  std::optional<double> horizon_s;  ///< until when double precision can follow; nothing: the whole duration
};

/// One limit held against one value.
struct GateResult {
  Metric metric = Metric::energy;
  double limit = 0.0;
  std::optional<double> value;  ///< nothing: the metric does not apply, and a gate on it cannot hold
  bool holds = false;
  std::optional<double> baseline;  ///< what the limit was made from; nothing: the scene sets it
};

enum class Verdict { pass, fail, shown, unsupported, error };

/// A quantity over the frames of a run, for the plots; NaN where it does not apply.
struct RunSeries {
  std::vector<double> energy;    ///< (E - E_0 - what events brought) / E_scale
  std::vector<double> momentum;  ///< |P - P_expected| / P_scale
  std::vector<double> position;  ///< m, max over balls against the truth
};

struct RunComparison {
  Run run;
  bool under_test = false;
  Metrics metrics;
  std::optional<Divergence> first_divergence;  ///< from the truth
  std::optional<Judgement> judgement;          ///< nothing without a truth
  std::optional<EnergySplit> energy_split;     ///< nothing where the engine cannot tell
  std::vector<GateResult> gates;
  Verdict verdict = Verdict::shown;
  RunSymmetries symmetries;  ///< what the scene's [symmetry] came to
  RunSeries series;
  std::optional<RunStatistics> statistics;  ///< nothing where none is asked

  /// Whether this run makes the check fail.
  bool violates() const {
    return verdict == Verdict::fail || (verdict == Verdict::error && counts()) || refused();
  }
  bool counts() const { return under_test || !gates.empty(); }
  bool refused() const { return verdict == Verdict::unsupported && !gates.empty(); }
};

/// Two engines against each other.
struct PairComparison {
  std::size_t a = 0;  ///< index into SceneComparison::runs
  std::size_t b = 0;
  double position_m = 0.0;  ///< max over balls and frames of |x_a - x_b|
  double position_rms_m = 0.0;
  std::optional<double> energy;            ///< max |E_a - E_b| / E_scale
  std::optional<double> momentum;          ///< max |P_a - P_b| / P_scale
  std::optional<double> angular_momentum;  ///< max |L_a - L_b| / L_scale
  std::optional<Divergence> first_divergence;
};

struct SceneComparison {
  ScenarioPtr scene;
  Truth truth;
  Predictability predictability;
  double position_tolerance_m = 0.0;  ///< beyond it two trajectories count as diverged
  std::vector<RunComparison> runs;
  std::vector<PairComparison> pairs;
  std::optional<SceneStatistics> statistics;  ///< nothing where the balls are too few to be a gas
};

/// The plain word for each state, as it stands in results.
std::string_view name_of(Verdict verdict);
std::string_view name_of(RunStatus status);
std::string_view name_of(Accuracy accuracy);

}  // namespace carom
