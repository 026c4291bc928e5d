#include "comparison/baseline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "comparison/conserved.h"
#include "comparison/gates.h"

namespace carom {

namespace {

/// The largest numbers that a run has rounded.
struct Largest {
  double reach_m = 0.0;      ///< coordinate, and speed times duration
  double kinetic_J = 0.0;    ///< Σ ½ m v² + ½ I ω² in one frame
  double momentum_Ns = 0.0;  ///< Σ m|v| in one frame
};

Largest largest_of(const Scenario& scene, const Trajectory& trajectory) {
  Largest largest;
  Cast cast(scene);
  for (std::size_t k = 0; k < trajectory.frames(); ++k) {
    cast.to_frame(static_cast<std::int64_t>(k));
    double kinetic_J = 0.0;
    double momentum_Ns = 0.0;
    const auto balls = trajectory.frame(k);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      if (!cast[i]) continue;
      const double reach_m =
          balls[i].position.lpNorm<Eigen::Infinity>() + balls[i].velocity.norm() * scene.duration_s;
      largest.reach_m = std::max(largest.reach_m, reach_m);
      const Ball& ball = *cast[i];
      if (std::isinf(ball.mass)) continue;
      const double moment = ball.inertia * ball.mass * ball.radius * ball.radius;
      kinetic_J += 0.5 * (ball.mass * balls[i].velocity.squaredNorm() + moment * balls[i].spin.squaredNorm());
      momentum_Ns += ball.mass * balls[i].velocity.norm();
    }
    largest.kinetic_J = std::max(largest.kinetic_J, kinetic_J);
    largest.momentum_Ns = std::max(largest.momentum_Ns, momentum_Ns);
  }
  return largest;
}

/// ε √(3n), see rounding_floor().
double rounding(const Run& run) {
  constexpr double kOperations = 10.0;
  const double epsilon = run.precision == "float32"
                             ? static_cast<double>(std::numeric_limits<float>::epsilon())
                             : std::numeric_limits<double>::epsilon();
  const std::int64_t impacts = run.trajectory.tally(run.trajectory.frames() - 1).impacts;
  const double updates = static_cast<double>(run.steps) + static_cast<double>(impacts) +
                         static_cast<double>(run.trajectory.balls());
  return epsilon * std::sqrt(3.0 * kOperations * updates);
}

/// How many times larger than its scale a rounded number was, at least once.
double share(double largest, double scale) {
  return scale > 0.0 ? std::max(1.0, largest / scale) : 1.0;
}

/// The largest factor by which the scene makes an error grow until the truth's horizon; 1 where nobody knows.
double amplification(const Truth& truth) {
  const std::vector<double>& factors = truth.solution.amplification;
  double largest = 1.0;
  for (std::size_t k = 0; k < std::min(factors.size(), truth.trajectory.frames()); ++k) {
    if (truth.horizon_s && truth.trajectory.time(k) > *truth.horizon_s) break;
    largest = std::max(largest, factors[k]);
  }
  return largest;
}

double smallest_radius(const Scenario& scene) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Ball& ball : scene.balls) smallest = std::min(smallest, ball.radius);
  return smallest;
}

BaselineScene scene_of(const Results& results, const SceneComparison& comparison) {
  return {comparison.scene->sha256, comparison.scene->step_s, results.seed, {}};
}

/// What is said of scenes, engines and metrics that could not be compared, by the reason.
class NotCompared {
 public:
  void add(const std::string& reason, std::string what) {
    const auto found = std::find_if(rows_.begin(), rows_.end(),
                                    [&](const BaselineFindings::Group& row) { return row.reason == reason; });
    if (found != rows_.end()) {
      found->what.push_back(std::move(what));
    } else {
      rows_.push_back({reason, {std::move(what)}});
    }
  }
  std::vector<BaselineFindings::Group> take() { return std::move(rows_); }

 private:
  std::vector<BaselineFindings::Group> rows_;
};

/// One run against the values that it had.
class RunAgainst {
 public:
  RunAgainst(const SceneComparison& scene, const Metrics& was, double factor, BaselineFindings& findings,
             NotCompared& not_compared)
      : scene_(scene), was_(was), factor_(factor), findings_(findings), not_compared_(not_compared) {}

  void hold(RunComparison& run) const {
    for (std::size_t i = 0; i < kMetricNames.size(); ++i) {
      const auto metric = static_cast<Metric>(i);
      if (was_[metric]) {
        hold(metric, *was_[metric], run);
      } else if (run.metrics[metric]) {
        not_compared_.add("the metric is not in the baseline",
                          fmt::format("{} {} {}", scene_.scene->id, run.run.label(), name_of(metric)));
      }
    }
    run.verdict = verdict_of(run);
  }

 private:
  void hold(Metric metric, double was, RunComparison& run) const {
    const bool ok = run.run.status == RunStatus::ok;
    const double floor = ok ? rounding_floor(scene_, run, metric) : 0.0;
    const std::optional<double> value = run.metrics[metric];
    const double limit = factor_ * std::max(was, floor);
    run.gates.push_back({metric, limit, value, value && *value <= limit, was});
    ++findings_.compared;
    if (value && factor_ * std::max(*value, floor) < was) {
      findings_.better.push_back({scene_.scene->id, run.run.label(), metric, *value, was});
    }
  }

  const SceneComparison& scene_;
  const Metrics& was_;
  double factor_;
  BaselineFindings& findings_;
  NotCompared& not_compared_;
};

/// Why a scene's values cannot be held against those of the baseline; empty where they can.
std::string changed(const BaselineScene& was, const BaselineScene& is) {
  if (was.sha256 != is.sha256) return "the scene's file has changed since (its sha256)";
  if (was.step_s != is.step_s) return "the step is another one than the baseline's";
  if (was.seed != is.seed) return "the seed is another one than the baseline's";
  return {};
}

}  // namespace

Baseline baseline_of(const Results& results) {
  Baseline baseline;
  for (const SceneComparison& comparison : results.scenes) {
    BaselineScene scene = scene_of(results, comparison);
    for (const RunComparison& run : comparison.runs) {
      if (run.run.status == RunStatus::ok) scene.engines[run.run.label()] = run.metrics;
    }
    baseline.scenes[comparison.scene->id] = std::move(scene);
  }
  return baseline;
}

Baseline merged(Baseline older, const Baseline& newer) {
  for (const auto& [id, scene] : newer.scenes) {
    BaselineScene& into = older.scenes[id];
    if (!into.same_scene(scene)) {
      into = scene;
      continue;
    }
    for (const auto& [engine, metrics] : scene.engines) into.engines[engine] = metrics;
  }
  return older;
}

double rounding_floor(const SceneComparison& scene, const RunComparison& run, Metric metric) {
  const double relative = rounding(run.run);
  const Largest largest = largest_of(*scene.scene, run.run.trajectory);
  const Reference reference(*scene.scene);
  const double position_m = relative * largest.reach_m;
  switch (metric) {
    case Metric::energy:
    case Metric::energy_gain:
    case Metric::energy_loss:
      return relative * share(largest.kinetic_J, reference.energy_scale_J);
    case Metric::momentum:
      return relative * share(largest.momentum_Ns, reference.momentum_scale_Ns);
    case Metric::angular_momentum:
      return relative * amplification(scene.truth) *
             share(largest.momentum_Ns * largest.reach_m, reference.angular_momentum_scale_Nms);
    case Metric::position:
    case Metric::position_rms:
      return position_m * amplification(scene.truth) + scene.truth.uncertainty_m;
    case Metric::penetration:
      return position_m / smallest_radius(*scene.scene);
    case Metric::escaped:
      return 0.0;
    case Metric::symmetry:
      return run.symmetries.floor_radii.value_or(0.0);
    case Metric::statistics:
      return 1.0;
  }
  return 0.0;
}

void hold_against(const Baseline& baseline, double factor, Results& results) {
  BaselineFindings findings;
  findings.file = baseline.file;
  findings.factor = factor;
  NotCompared not_compared;
  for (SceneComparison& comparison : results.scenes) {
    const std::string& id = comparison.scene->id;
    const auto was = baseline.scenes.find(id);
    if (was == baseline.scenes.end()) {
      not_compared.add("the scene is not in the baseline", id);
      continue;
    }
    const std::string reason = changed(was->second, scene_of(results, comparison));
    if (!reason.empty()) {
      not_compared.add(reason, id);
      continue;
    }
    std::map<std::string, Metrics> absent = was->second.engines;
    for (RunComparison& run : comparison.runs) {
      const std::string label = run.run.label();
      absent.erase(label);
      const auto values = was->second.engines.find(label);
      if (values != was->second.engines.end()) {
        RunAgainst(comparison, values->second, factor, findings, not_compared).hold(run);
      } else if (run.run.status == RunStatus::ok) {
        not_compared.add(label + " is not in the baseline for", id);
      }
    }
    for (const auto& [label, values] : absent) {
      not_compared.add(label + " is in the baseline and did not take part in", id);
    }
  }
  findings.not_compared = not_compared.take();
  results.baseline = std::move(findings);
}

}  // namespace carom
