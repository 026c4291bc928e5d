#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "comparison/results.h"
#include "trajectory/trajectory.h"

namespace carom {

// What a study of accuracy against time finds out: data only, filled by measure.h and growth.h, read and
// written as JSON by study_json.h, judged by analyse.h.

/// By how much a run is off; nothing where it cannot be told. Places and impacts up to the truth's horizon;
/// what is conserved over the whole duration, for beyond the horizon the laws still tell it.
struct StudyErrors {
  std::optional<double> position_m;        ///< the largest of any ball in any frame
  std::optional<double> final_position_m;  ///< the largest of any ball in the last frame before the horizon
  std::optional<double> energy;            ///< relative, as the metrics of that name
  std::optional<double> momentum;
  std::optional<double> angular_momentum;
  std::optional<double> impact_time_s;  ///< the largest of the impacts that can be told, see impact_times.h
};

/// One engine with one setting at one step.
struct StudyPoint {
  std::string engine;      ///< its label: "carom:toi", "box2d@default"
  std::string setting;     ///< what is not as the profile has it: "velocity_iterations = 8"; empty: nothing
  bool everywhere = true;  ///< false where one step stands for all, as of a broad phase
  std::int64_t steps_per_frame = 1;  ///< k, the step being the k-th part of the interval between frames
  double step_s = 0.0;

  std::optional<RunStatus> status;  ///< of the run that errors are from; nothing: it was not run yet
  std::string reason;               ///< why the status is not ok
  StudyErrors errors;
  double rounding_m = 0.0;  ///< what rounding alone may make of position_m, see rounding_growth_m()
  std::int64_t steps = 0;   ///< over the whole duration
  std::int64_t impacts = 0;
  double recorded_cpu_s = 0.0;  ///< of the stepping in the run that errors are from
  std::vector<double> cpu_s;    ///< of the stepping alone, of each timed run
  std::string untimed;          ///< why there are fewer of them than were asked for
  std::string version;          ///< of the engine
  std::string precision;
};

/// What an engine says of itself in a scene.
struct StudyEngine {
  std::string label;
  bool takes_steps = true;
  bool claims = false;               ///< whether it states an order at all
  std::optional<int> claimed_order;  ///< p in error ~ stepᵖ; nothing where it claims to be exact
};

struct StudyScene {
  std::string id;
  std::string title;
  std::string sha256;
  std::optional<std::uint64_t> seed;  ///< of its generators, where it is not the scene's own
  int dimension = 2;
  std::size_t balls = 0;
  double duration_s = 0.0;
  std::int64_t frames = 1;
  double smallest_radius_m = 0.0;
  double reach_m = 0.0;              ///< the farthest that the truth knows a ball from where it started
  std::string truth = "none";        ///< its kind
  std::string no_truth;              ///< why there is none
  double uncertainty_m = 0.0;        ///< of the truth
  std::optional<double> horizon_s;   ///< until when errors are measured; nothing: the whole duration
  std::vector<StudyEngine> engines;  ///< in the order of the command line
  std::vector<StudyPoint> points;
};

/// Some balls in one engine, for the growth of the cost.
struct GrowthPoint {
  std::int64_t balls = 0;
  std::optional<RunStatus> status;
  std::string reason;
  std::int64_t steps = 0;
  std::int64_t impacts = 0;
  std::vector<double> cpu_s;
};

/// How the cost of one engine grows with the number of balls of a gas.
struct StudyGrowth {
  int dimension = 2;
  double packing = 0.0;
  std::string engine;
  std::vector<GrowthPoint> points;
};

/// How runs are made.
struct StudyLimits {
  double timeout_s = 2.0;  ///< CPU time of one run; one that is foreseen to take longer is not started
  double memory_mib = 4096.0;
  int repeats = 5;         ///< timed runs of each setting
  double budget_s = 30.0;  ///< CPU time of one scene, beside that of its truth, and of one kind of gas

  bool operator==(const StudyLimits&) const = default;
};

struct Study {
  std::string version;  ///< of Carom
  Machine machine;
  std::string own;  ///< the family of the engine under test, whose front is held against those of its peers
  StudyLimits limits;
  std::vector<StudyScene> scenes;
  std::vector<StudyGrowth> growths;
};

}  // namespace carom
