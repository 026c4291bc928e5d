#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "comparison/comparison.h"
#include "engine/engine.h"

namespace carom {

// Which of an engine's settings explains its divergence: the search, apart from what runs the engine.
//
// The divergence D of a run is one number >= 0, a metric against the truth. D_0 is that of the profile asked
// for, D_all that with every setting as in the engine's other profile. Divergences span many powers of ten
// and saturate (a ball that is lost is off by the size of the scene, whatever lost it), so what settings
// explain is measured on a logarithmic scale: the share of a set of switched settings with divergence D is
//   share(D) = (ln D_0 - ln D) / (ln D_0 - ln D_all)      (1)
// 0 where they change nothing, 1 where they do what all of them do together; it can be below 0 or above 1. It
// reads the same in both directions: from a default that is off to a faithful profile, or the other way.

/// A run that the search asks for.
struct Trial {
  std::vector<std::string>
      switched;            ///< settings as in the other profile, in the order of the engine's switches
  bool half_step = false;  ///< at half the scene's step
};

/// Runs all trials, and gives the divergence of each; nothing for a run that did not end well.
using RunTrials = std::function<std::vector<std::optional<double>>(const std::vector<Trial>&)>;

/// What the search must know of the divergence.
struct DivergenceScale {
  double floor = 0.0;     ///< > 0; what is smaller is as good as nothing and counts as this much
  double rounding = 0.0;  ///< what the engine's rounding could add up to over the run
};

/// One setting, in the order in which they were accumulated.
struct SettingEffect {
  std::string name;
  std::string meaning;
  std::optional<double> alone;        ///< divergence with only this one switched; nothing: that run fails
  std::optional<double> cumulative;   ///< with this one and all above it switched
  std::optional<double> alone_share;  ///< (1); nothing where there is nothing to explain
  std::optional<double> share;  ///< what it adds to the share of those above it; all of them add up to 1
};

/// Two settings that only together explain what neither does alone.
struct PairEffect {
  std::string first;
  std::string second;
  std::optional<double> divergence;
  double share = 0.0;
};

/// Why something is left when every setting is switched.
enum class RemainderCause {
  nothing,   ///< what is left is as good as nothing
  step,      ///< it falls with the step
  rounding,  ///< it does not, and is no more than rounding can add up to
  method,    ///< neither: it is how the engine works
  failure,   ///< that run fails
};

struct Explanation {
  std::optional<double> start;            ///< D_0; nothing: that run fails
  std::optional<double> start_half_step;  ///< the same at half the step
  std::optional<double> all;              ///< D_all
  std::optional<double> all_half_step;
  /// Whether D_0 and D_all are far enough apart (a factor of two) for shares to mean something.
  bool settings_matter = false;
  std::optional<double> step_share;  ///< (1) for half the step alone
  std::vector<SettingEffect> settings;
  std::optional<PairEffect> pair;  ///< the best pair, where no single setting explains half
  RemainderCause remainder = RemainderCause::nothing;
  double remainder_order = 0.0;  ///< p in D ~ h^p, between the step and its half; where the cause is the step
};

/// Switches each setting alone, then accumulates them: the best first (or the best pair, where no single one
/// explains half), then each time the one that explains the most on top, and in the end those that explain
/// nothing more, in the order of what they do alone. Deterministic: of equals the first in the engine's order
/// is taken.
Explanation explain(const std::vector<Switch>& switches, const DivergenceScale& scale, const RunTrials& run);

/// An explanation with what it is about, for the reports.
struct ExplainedScene {
  ScenarioPtr scene;
  Metric metric = Metric::position;  ///< whose value is the divergence
  std::string truth;                 ///< its kind; "none" where the metric is held against what is conserved
  Run run;                           ///< of the profile asked for
  Run other;                         ///< of the engine's other profile; nothing in it where there is none
  Explanation explanation;
};

/// The metric by which this run is explained: position where there is a truth, else the first of energy, its
/// gain and momentum that is known. Nothing where none is, or where the run did not end well.
std::optional<Metric> telling_metric(const RunComparison& run);

/// The scale of a metric's values. ε is the machine epsilon of a precision.
/// - floor: for positions the truth's uncertainty, and at least ε of double precision times the smallest
/// radius;
///   for what is relative that ε.
/// - rounding: one rounding of the engine's precision per step, all in one direction: ε × steps, for
/// positions
///   times the largest coordinate that a ball reaches.
DivergenceScale divergence_scale(Metric metric, const Scenario& scene, const Truth& truth, const Run& run);

}  // namespace carom
