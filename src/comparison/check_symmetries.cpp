#include "comparison/check_symmetries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "comparison/comparison.h"
#include "comparison/conserved.h"
#include "comparison/metamorphic.h"
#include "comparison/predictability.h"

namespace carom {

namespace {

double smallest_radius_m(const Scenario& scene) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Ball& ball : scene.balls) smallest = std::min(smallest, ball.radius);
  return smallest;
}

bool same_digits(const BallState& a, const BallState& b) {
  return a.position == b.position && a.velocity == b.velocity && a.spin == b.spin;
}

/// How far two runs of a scene are apart.
struct Distance {
  double position_m = 0.0;
  double energy_J = 0.0;
  bool same = true;  ///< digit for digit, in everything
};

/// Holds the runs of twins against one run of the scene.
class Judge {
 public:
  Judge(const Scenario& scene, const Run& run)
      : reference_(scene), radius_m_(smallest_radius_m(scene)), trajectory_(run.trajectory) {}

  double in_radii(double distance_m) const { return distance_m / radius_m_; }

  Distance distance(const Twin& twin, const Trajectory& of_twin) const {
    Distance distance;
    const std::size_t last = trajectory_.frames() - 1;
    std::vector<BallState> seen(trajectory_.balls());
    Cast cast(*reference_.scenario);
    for (std::size_t k = 0; k <= last; ++k) {
      cast.to_frame(static_cast<std::int64_t>(k));
      const auto twin_states = of_twin.frame(twin.backwards ? last - k : k);
      const auto states = trajectory_.frame(k);
      for (std::size_t i = 0; i < states.size(); ++i) {
        if (!cast[i]) continue;
        seen[i] = twin.back(twin_states, i, trajectory_.time(k));
        distance.position_m = std::max(distance.position_m, (seen[i].position - states[i].position).norm());
        distance.same = distance.same && same_digits(seen[i], states[i]);
      }
      const double change_J = reference_.of(seen, cast).energy_J - reference_.of(states, cast).energy_J;
      distance.energy_J = std::max(distance.energy_J, std::abs(change_J));
    }
    return distance;
  }

  void judge(const Twin& twin, const Run& run, const RunSymmetries& of_run, SymmetryResult& result) const {
    if (run.status != RunStatus::ok) {
      result.verdict = SymmetryVerdict::twin_did_not_run;
      result.reason = fmt::format("{}: {}", name_of(run.status), run.reason);
      return;
    }
    const Distance off = distance(twin, run.trajectory);
    result.position_radii = in_radii(off.position_m);
    if (reference_.energy_scale_J > 0.0) result.energy = off.energy_J / reference_.energy_scale_J;
    if (off.same) {
      result.verdict = SymmetryVerdict::to_the_bit;
    } else if (*result.position_radii <= of_run.floor_radii.value_or(0.0)) {
      result.verdict = SymmetryVerdict::to_rounding;
    } else {
      result.verdict = SymmetryVerdict::broken;
    }
  }

 private:
  Reference reference_;
  double radius_m_;
  const Trajectory& trajectory_;
};

/// The scene, disturbed by what rounding can add up to in a run of it.
Twin rounded_twin(const Scenario& scene, const Run& run) {
  double farthest_m = 0.0;
  double fastest = 0.0;
  for (std::size_t k = 0; k < run.trajectory.frames(); ++k) {
    for (const BallState& state : run.trajectory.frame(k)) {
      farthest_m = std::max(farthest_m, state.position.norm());
      fastest = std::max(fastest, state.velocity.norm());
    }
  }
  if (not_symmetric(scene, Symmetry::boost).empty()) {
    const double boost = make_twin(scene, Symmetry::boost, {}).frame.boost.norm();
    farthest_m += boost * scene.duration_s;
    fastest += boost;
  }
  const std::int64_t impacts = run.trajectory.tally(run.trajectory.frames() - 1).impacts;
  const double share = static_cast<double>(run.steps + impacts) * epsilon_of(run);
  return disturbed_twin(scene, share * farthest_m, share * fastest);
}

/// Everything there is to do for one scene.
class Checker {
 public:
  Checker(const Scenario& scene, const std::vector<Run>& runs, const std::vector<EngineChoice>& engines,
          const ProcessLimits& limits, int parallel)
      : scene_(scene), runs_(runs), engines_(engines), limits_(limits), parallel_(parallel) {
    results_.resize(runs.size());
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (runs[i].status == RunStatus::ok) taking_part_.push_back(i);
    }
  }

  std::vector<RunSymmetries> check() {
    for (const std::size_t i : taking_part_) measure_floor(i);
    for (const Symmetry symmetry : scene_.symmetries) {
      const std::string reason = not_symmetric(scene_, symmetry);
      if (!reason.empty()) {
        for (const std::size_t i : taking_part_) {
          results_[i].checks.push_back({symmetry, SymmetryVerdict::does_not_apply, reason, {}, {}});
        }
      } else if (symmetry == Symmetry::reverse) {
        // Each engine turns back from where it itself has come to.
        for (const std::size_t i : taking_part_) {
          const Trajectory& forth = runs_[i].trajectory;
          judge_twin(symmetry, make_twin(scene_, symmetry, forth.frame(forth.frames() - 1)), {i});
        }
      } else {
        judge_twin(symmetry, make_twin(scene_, symmetry, {}), taking_part_);
      }
    }
    return std::move(results_);
  }

 private:
  void measure_floor(std::size_t i) {
    const Twin twin = rounded_twin(scene_, runs_[i]);
    const Run run = run_engines(twin.scenario, {engines_[i]}, limits_, parallel_).front();
    if (run.status != RunStatus::ok) return;
    const Judge judge(scene_, runs_[i]);
    results_[i].floor_radii = judge.in_radii(judge.distance(twin, run.trajectory).position_m);
  }

  void judge_twin(Symmetry symmetry, const Twin& twin, const std::vector<std::size_t>& which) {
    std::vector<EngineChoice> engines;
    engines.reserve(which.size());
    for (const std::size_t i : which) engines.push_back(engines_[i]);
    const std::vector<Run> runs = run_engines(twin.scenario, engines, limits_, parallel_);
    for (std::size_t k = 0; k < which.size(); ++k) {
      RunSymmetries& of_run = results_[which[k]];
      SymmetryResult& result = of_run.checks.emplace_back();
      result.symmetry = symmetry;
      Judge(scene_, runs_[which[k]]).judge(twin, runs[k], of_run, result);
    }
  }

  const Scenario& scene_;
  const std::vector<Run>& runs_;
  const std::vector<EngineChoice>& engines_;
  const ProcessLimits& limits_;
  int parallel_;
  std::vector<std::size_t> taking_part_;
  std::vector<RunSymmetries> results_;
};

}  // namespace

std::vector<RunSymmetries> check_symmetries(const Scenario& scene, const std::vector<Run>& runs,
                                            const std::vector<EngineChoice>& engines,
                                            const ProcessLimits& limits, int parallel) {
  if (scene.symmetries.empty()) return std::vector<RunSymmetries>(runs.size());
  return Checker(scene, runs, engines, limits, parallel).check();
}

std::optional<double> RunSymmetries::worst_radii() const {
  std::optional<double> worst;
  for (const SymmetryResult& result : checks) {
    if (result.verdict == SymmetryVerdict::twin_did_not_run) return std::nullopt;
    if (result.position_radii) worst = std::max(worst.value_or(0.0), *result.position_radii);
  }
  return worst;
}

std::string_view name_of(SymmetryVerdict verdict) {
  switch (verdict) {
    case SymmetryVerdict::to_the_bit:
      return "to the bit";
    case SymmetryVerdict::to_rounding:
      return "to rounding";
    case SymmetryVerdict::broken:
      return "broken";
    case SymmetryVerdict::does_not_apply:
      return "does not apply";
    case SymmetryVerdict::twin_did_not_run:
      return "twin did not run";
  }
  return "?";
}

}  // namespace carom
