#include "study/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "comparison/compare.h"
#include "comparison/predictability.h"
#include "study/budget.h"
#include "study/foresee.h"
#include "study/impact_times.h"
#include "study/plan.h"
#include "study/timing.h"

namespace carom {

namespace {

/// A run of so many times its limit and a while is taken to hang. Not sooner: the limit is one of CPU time,
/// and other programs may hold a run up.
constexpr double kHangFactor = 10.0;
constexpr double kHangWhile_s = 5.0;
/// Runs at a time that keep their trajectories until they are measured.
constexpr std::size_t kAtOnce = 16;

bool is_same(const StudyPoint& a, const StudyPoint& b) {
  return a.engine == b.engine && a.setting == b.setting && a.steps_per_frame == b.steps_per_frame;
}

/// The last finite value; nothing where there is none.
std::optional<double> last_known(const std::vector<double>& series) {
  const auto last = std::find_if(series.rbegin(), series.rend(), [](double v) { return std::isfinite(v); });
  return last == series.rend() ? std::nullopt : std::optional(*last);
}

class SceneStudy {
 public:
  SceneStudy(ScenarioPtr scene, const StudyLimits& limits, int parallel, const StudyWatch& watch,
             StudyScene& into)
      : scene_(std::move(scene)),
        asked_(limits),
        budget_(limits.budget_s),
        limits_{kHangFactor * limits.timeout_s + kHangWhile_s, limits.memory_mib},
        parallel_(parallel),
        watch_(watch),
        into_(into) {}

  void describe() {
    into_.id = scene_->id;
    into_.title = scene_->title;
    into_.sha256 = scene_->sha256;
    into_.dimension = scene_->dimension;
    into_.balls = scene_->balls.size();
    into_.duration_s = scene_->duration_s;
    into_.frames = scene_->frames;
    into_.smallest_radius_m = std::numeric_limits<double>::infinity();
    for (const Ball& ball : scene_->balls) {
      into_.smallest_radius_m = std::min(into_.smallest_radius_m, ball.radius);
    }
  }

  /// The truth is solved with a time limit of its own, however short that of a run is, and beside the budget.
  /// It is not asked where all errors are known.
  void solve(const std::vector<std::shared_ptr<const TruthSource>>& sources) {
    if (unmeasured() == 0) return;
    SceneComparison solved = compare(
        scene_, record_truth(*scene_, sources, {ProcessLimits().wall_seconds, limits_.memory_mib}), {}, {});
    truth_ = std::move(solved.truth);
    into_.truth = truth_.kind;
    into_.no_truth = truth_.reason;
    into_.uncertainty_m = truth_.uncertainty_m;
    into_.horizon_s = truth_.horizon_s;
    into_.reach_m = truth_.known() ? reach_of_truth_m() : 0.0;
    budget_ = CpuBudget(asked_.budget_s);
  }

  void plan(const std::vector<EngineChoice>& engines) {
    const std::vector<Answer> answers =
        ask_engines(*scene_, engines, {ProcessLimits().wall_seconds, limits_.memory_mib}, parallel_);
    into_.engines.clear();
    for (const Answer& answer : answers) into_.engines.push_back(answer.engine);
    const std::vector<StudyPoint> before = std::exchange(into_.points, {});
    for (PlannedPoint& each : plan_scene(*scene_, engines, answers)) {
      const auto known = std::find_if(before.begin(), before.end(),
                                      [&](const StudyPoint& point) { return is_same(point, each.point); });
      into_.points.push_back(known == before.end() ? each.point : *known);
      choices_.push_back(std::move(each.choice));
    }
  }

  void measure_errors() {
    watch_.more(unmeasured());
    for (std::size_t from = 0; from < into_.points.size();) {
      const std::int64_t steps = into_.points[from].steps_per_frame;
      std::size_t to = from;
      while (to < into_.points.size() && into_.points[to].steps_per_frame == steps) ++to;
      // Those of one step, for a finer one is foreseen by it; and what is tuned by the engine as it comes.
      for (const bool tuned : {false, true}) {
        std::vector<std::size_t> which;
        for (std::size_t i = from; i < to; ++i) {
          const StudyPoint& point = into_.points[i];
          if (!point.status && point.setting.empty() != tuned) which.push_back(i);
        }
        if (watch_.stopped()) return;
        run_level(admitted(which), with_steps(*scene_, steps));
      }
      from = to;
    }
  }

  void measure_times() {
    std::size_t runs = 0;
    for (const StudyPoint& point : into_.points) runs += static_cast<std::size_t>(missing_times(point));
    watch_.more(runs);
    for (int round = 0; round < asked_.repeats; ++round) {
      for (std::size_t i = 0; i < into_.points.size(); ++i) {
        StudyPoint& point = into_.points[i];
        const int done = static_cast<int>(point.cpu_s.size());
        if (done > round || missing_times(point) == 0) continue;
        if (watch_.stopped()) return;
        if (round > 0 && budget_.left_s() <= 0.0) {
          point.untimed = fmt::format("the scene's budget of {:g} s was used up", asked_.budget_s);
        } else {
          time_once(point, choices_[i]);
        }
      }
    }
  }

 private:
  double reach_of_truth_m() const {
    double reach_m = 0.0;
    const Trajectory& trajectory = truth_.trajectory;
    for (std::size_t k = 0; k < trajectory.frames(); ++k) {
      if (trajectory.time(k) > truth_.horizon_s.value_or(scene_->duration_s)) break;
      for (std::size_t i = 0; i < trajectory.balls(); ++i) {
        reach_m =
            std::max(reach_m, (trajectory.frame(k)[i].position - trajectory.frame(0)[i].position).norm());
      }
    }
    return reach_m;
  }

  std::size_t unmeasured() const {
    return static_cast<std::size_t>(std::count_if(into_.points.begin(), into_.points.end(),
                                                  [](const StudyPoint& point) { return !point.status; }));
  }

  void leave_out(std::size_t index, std::string reason) {
    StudyPoint& point = into_.points[index];
    point.status = RunStatus::timeout;
    point.reason = std::move(reason);
    watch_.done(point.engine);
  }

  /// Of these runs those that are to be made; the others are left out.
  std::vector<std::size_t> admitted(const std::vector<std::size_t>& which) {
    struct Candidate {
      double run_s = 0.0;
      std::size_t index = 0;
    };
    std::vector<Candidate> candidates;
    for (const std::size_t i : which) {
      const Foresight foresight = foresee(into_.points, i);
      const std::string reason = too_long(foresight, asked_.timeout_s);
      if (reason.empty()) {
        candidates.push_back({foresight.cpu_s.value_or(0.0), i});
      } else {
        leave_out(i, reason);
      }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.run_s < b.run_s; });
    double left_s = budget_.left_s();
    for (const StudyPoint& point : into_.points) {
      left_s -= timing_cost_s(point.recorded_cpu_s, missing_times(point));
    }
    std::vector<std::size_t> result;
    for (const Candidate& each : candidates) {
      left_s -= each.run_s + timing_cost_s(each.run_s, repeats_for(each.run_s, asked_.repeats));
      if (left_s >= 0.0) {
        result.push_back(each.index);
      } else {
        leave_out(each.index, beyond_budget());
      }
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  std::string beyond_budget() const {
    return fmt::format("too little was left of the scene's budget of {:g} s", asked_.budget_s);
  }

  /// Some at a time; what was not foreseen may use the budget up.
  void run_level(const std::vector<std::size_t>& which, const Scenario& scene) {
    for (std::size_t from = 0; from < which.size(); from += kAtOnce) {
      if (watch_.stopped()) return;
      const auto first = which.begin() + static_cast<std::ptrdiff_t>(from);
      const auto last = which.begin() + static_cast<std::ptrdiff_t>(std::min(from + kAtOnce, which.size()));
      if (budget_.left_s() > 0.0) {
        run_some({first, last}, scene);
      } else {
        std::for_each(first, last, [&](std::size_t i) { leave_out(i, beyond_budget()); });
      }
    }
  }

  void run_some(const std::vector<std::size_t>& which, const Scenario& scene) {
    std::vector<EngineChoice> choices;
    choices.reserve(which.size());
    for (const std::size_t i : which) choices.push_back(choices_[i]);
    std::vector<Run> runs = run_engines(scene, choices, limits_, parallel_, [&](std::size_t done) {
      watch_.done(fmt::format("{}: errors of {}", scene_->id, into_.points[which[done]].engine));
    });
    for (std::size_t k = 0; k < which.size(); ++k) take(std::move(runs[k]), into_.points[which[k]]);
    watch_.changed();
  }

  void take(Run run, StudyPoint& point) const {
    point.status = run.status;
    point.reason = run.reason;
    point.version = run.version;
    point.precision = run.precision;
    point.steps = run.steps;
    point.recorded_cpu_s = run.cpu_seconds;
    if (run.status != RunStatus::ok) return;
    if (run.cpu_seconds > asked_.timeout_s) {
      point.untimed = fmt::format("took {:.2g} s, longer than {:g} s", run.cpu_seconds, asked_.timeout_s);
    }
    point.impacts = run.trajectory.tally(run.trajectory.frames() - 1).impacts;
    if (truth_.known()) {
      point.errors.impact_time_s = impact_time_error_s(*scene_, truth_, run);
      point.rounding_m = rounding_until_horizon_m(run);
    }
    const SceneComparison compared = compare(scene_, truth_, one(std::move(run)), {});
    const RunComparison& result = compared.runs.front();
    point.errors.position_m = result.metrics[Metric::position];
    point.errors.final_position_m = last_known(result.series.position);
    point.errors.energy =
        result.metrics[Metric::energy] ? result.metrics[Metric::energy] : result.metrics[Metric::energy_gain];
    point.errors.momentum = result.metrics[Metric::momentum];
    point.errors.angular_momentum = result.metrics[Metric::angular_momentum];
  }

  static std::vector<Run> one(Run run) {
    std::vector<Run> runs;
    runs.push_back(std::move(run));
    return runs;
  }

  double rounding_until_horizon_m(const Run& run) const {
    const std::vector<double> growth = rounding_growth_m(*scene_, truth_, epsilon_of(run), run.steps);
    double largest_m = 0.0;
    for (std::size_t k = 0; k < growth.size(); ++k) {
      if (truth_.trajectory.time(k) > truth_.horizon_s.value_or(scene_->duration_s)) break;
      largest_m = std::max(largest_m, growth[k]);
    }
    return largest_m;
  }

  /// Timed runs that are still to be done.
  int missing_times(const StudyPoint& point) const {
    if (point.status != RunStatus::ok || !point.untimed.empty()) return 0;
    const int asked = repeats_for(point.recorded_cpu_s, asked_.repeats);
    return std::max(asked - static_cast<int>(point.cpu_s.size()), 0);
  }

  void time_once(StudyPoint& point, const EngineChoice& choice) {
    const Scenario scene = with_steps(*scene_, point.steps_per_frame);
    const ProcessOutcome outcome = time_isolated(scene, choice, limits_);
    if (outcome.end == ProcessEnd::finished) {
      point.cpu_s.push_back(timing_from(outcome.payload).cpu_s);
    } else {
      point.untimed = outcome.reason;
    }
    watch_.done(fmt::format("{}: time of {}", scene_->id, point.engine));
    watch_.changed();
  }

  ScenarioPtr scene_;
  StudyLimits asked_;
  CpuBudget budget_;
  ProcessLimits limits_;
  int parallel_;
  const StudyWatch& watch_;
  StudyScene& into_;
  Truth truth_;
  std::vector<EngineChoice> choices_;  // of each point
};

}  // namespace

void measure_scene(const ScenarioPtr& scene, const std::vector<EngineChoice>& engines,
                   const std::vector<std::shared_ptr<const TruthSource>>& sources, const StudyLimits& limits,
                   int parallel, const StudyWatch& watch, StudyScene& into) {
  SceneStudy study(scene, limits, parallel, watch, into);
  study.describe();
  study.plan(engines);
  study.solve(sources);
  study.measure_errors();
  if (!watch.stopped()) study.measure_times();
}

}  // namespace carom
