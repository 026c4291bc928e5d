#include "reference/converged/converged.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/random.h"
#include "reference/converged/run.h"

namespace carom {

namespace {

using converged::Real;
using converged::Run;
using converged::State;
using converged::Vector;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// By what the difference of the two runs is multiplied. The coarse one is off by 2^13 as much per step and
/// rounding as the fine one, so that the difference is the coarse one's error, and the fine one's error is
/// far below it. The factor is for the chance that the coarse one's errors cancel.
constexpr double kSafety = 16.0;

bool has_drag(const Scenario& scenario) {
  return scenario.effects.drag && scenario.effects.drag->coefficient > 0.0;
}

bool has_magnus(const Scenario& scenario) {
  return scenario.effects.magnus.value_or(0.0) != 0.0;
}

/// A gap that is negative by no more than this is a touch: two places and two radii, each off by ε/2 of the
/// scene's size as it became a double.
double touch_m(const Scenario& scenario) {
  return 2.0 * kEpsilon * static_cast<double>(converged::scale_of(scenario).length_m);
}

std::string overlap_in(const Scenario& scenario) {
  const double touch = touch_m(scenario);
  const std::vector<State> start = converged::start_of(scenario);
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Real radius = scenario.balls[i].radius;
    for (const Wall& wall : scenario.walls) {
      if (converged::widened(wall.normal).dot(start[i].x) - wall.offset - radius < -touch) {
        return fmt::format("ball {} starts outside a wall", i);
      }
    }
    for (std::size_t j = i + 1; j < start.size() && scenario.effects.collisions; ++j) {
      if ((start[j].x - start[i].x).norm() - radius - scenario.balls[j].radius < -touch) {
        return fmt::format("balls {} and {} start overlapping", i, j);
      }
    }
  }
  return {};
}

/// Why the scene is beyond this source; empty where it is not.
std::string refusal(const Scenario& scenario) {
  if (!scenario.slabs.empty()) return "there are slabs";
  if (!scenario.barriers.empty()) return "there are barriers";
  if (!scenario.events.empty()) return "there are events";
  if (scenario.multi_contact != MultiContact::sequential) return "its impacts are of one pair at a time";
  if (!has_drag(scenario) && !has_magnus(scenario) && scenario.truth != TruthKind::converged) {
    return "without drag or Magnus force it is for scenes that ask for it by name";
  }
  return overlap_in(scenario);
}

/// The start, changed a little: every place and velocity by up to δ and δ/T along each axis that the scene
/// has.
std::vector<State> perturbed(const Scenario& scenario, const Real& delta_m) {
  std::vector<State> start = converged::start_of(scenario);
  constexpr std::uint64_t kSeed = 20;
  Random random(kSeed);
  double largest = 0.0;
  std::vector<std::pair<Vec3, Vec3>> changes;
  for (const Ball& ball : scenario.balls) {
    auto& [place, velocity] = changes.emplace_back(Vec3::Zero(), Vec3::Zero());
    if (std::isinf(ball.mass)) continue;
    for (int axis = 0; axis < scenario.dimension; ++axis) {
      place[axis] = random.normal();
      velocity[axis] = random.normal();
    }
    largest = std::max({largest, place.norm(), velocity.norm()});
  }
  if (largest == 0.0) return start;
  for (std::size_t i = 0; i < start.size(); ++i) {
    start[i].x += converged::widened(changes[i].first) * (delta_m / largest);
    start[i].v += converged::widened(changes[i].second) * (delta_m / (largest * scenario.duration_s));
  }
  return start;
}

/// The scene solved twice, and a third time from a start that is changed a little.
class Twins {
 public:
  Twins(const Scenario& scenario, const ConvergedSettings& settings, const Real& end_s)
      : size_m_(converged::scale_of(scenario).length_m),
        tolerance_m_(settings.tolerance * static_cast<double>(size_m_)),
        delta_m_(ldexp(size_m_, -settings.coarse.bits + kTwinUnits)),
        fine_(scenario, converged::start_of(scenario), settings.fine, end_s, settings.most_work),
        coarse_(scenario, converged::start_of(scenario), settings.coarse, end_s, settings.most_work),
        twin_(scenario, perturbed(scenario, delta_m_), settings.fine, end_s, settings.most_work),
        places_(scenario.balls.size()),
        states_(scenario.balls.size()) {}

  /// Goes to a moment. False where the motion is not known for so long.
  bool go_to(const Real& time_s) {
    const bool known = fine_.follow(time_s) && coarse_.follow(time_s);
    if (!known) return false;
    Real apart = 0;
    Real farthest = 0;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const State state = fine_.at(i, time_s);
      states_[i] = {converged::rounded(state.x), converged::rounded(state.v), converged::rounded(state.spin)};
      places_[i] = state.x;
      apart = std::max(apart, Real((coarse_.place_at(i, time_s) - state.x).norm()));
      farthest = std::max(farthest, Real(state.x.cwiseAbs().maxCoeff()));
    }
    // Each coordinate is rounded to double, by ε/2: √3/2 ε < ε together.
    const double unsure_m = kSafety * static_cast<double>(apart) + kEpsilon * static_cast<double>(farthest);
    lost_ = kSafety * apart > tolerance_m_;
    if (lost_) return false;
    uncertainty_m_ = std::max(uncertainty_m_, unsure_m);
    follow_twin(time_s);
    reached_s_ = time_s;
    impact_count_ = fine_.tally().impacts;
    return true;
  }

  std::span<const BallState> states() const { return states_; }
  Tally tally() const { return fine_.tally(); }

  /// What is known when the last moment that go_to() was asked for has been reached, or not.
  Solution solution(bool to_the_end) const {
    Solution solution;
    solution.uncertainty_m = uncertainty_m_;
    solution.digits = 34;
    solution.impact_count = impact_count_;
    solution.ties = fine_.ties();
    solution.impacts = fine_.impacts();
    solution.amplification = amplification_;
    if (to_the_end) return solution;
    const bool fine_first = coarse_.limit().empty() ||
                            (!fine_.limit().empty() && fine_.known_until_s() <= coarse_.known_until_s());
    const Run& first = fine_first ? fine_ : coarse_;
    const Real until_s = lost_ ? reached_s_ : first.known_until_s();
    solution.limit = lost_ ? fmt::format("beyond it the two integrations differ by more than {:.2g} m",
                                         tolerance_m_ / kSafety)
                           : first.limit();
    solution.known_until_s = static_cast<double>(until_s);
    std::erase_if(solution.impacts, [&](const TrueImpact& i) { return i.time_s > *solution.known_until_s; });
    return solution;
  }

 private:
  // As a power of two: the change is far above the coarse run's roundings and far below anything else.
  static constexpr int kTwinUnits = 20;

  void follow_twin(const Real& time_s) {
    twin_known_ = twin_known_ && twin_.follow(time_s);
    if (!twin_known_) return;
    Real apart = 0;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      apart = std::max(apart, Real((twin_.place_at(i, time_s) - places_[i]).norm()));
    }
    amplification_.push_back(static_cast<double>(apart / delta_m_));
  }

  Real size_m_;
  double tolerance_m_;
  Real delta_m_;
  Run fine_;
  Run coarse_;
  Run twin_;
  std::vector<Vector> places_;  ///< of the fine run, at the moment
  std::vector<BallState> states_;
  std::vector<double> amplification_;
  double uncertainty_m_ = 0.0;
  Real reached_s_ = 0;
  std::int64_t impact_count_ = 0;
  bool lost_ = false;
  bool twin_known_ = true;
};

class ConvergedTruth final : public TruthSource {
 public:
  explicit ConvergedTruth(const ConvergedSettings& settings) : settings_(settings) {}

  std::string_view kind() const override { return "converged"; }

  std::string refuses(const Scenario& scenario) const override {
    const std::string reason = refusal(scenario);
    return reason.empty() ? reason : "no converged integration: " + reason;
  }

  Solution solve(const Scenario& scenario, std::span<const Moment> moments,
                 const Taker& take) const override {
    const auto time_of = [](const Moment& moment) { return Real(moment.step_s) * Real(moment.steps); };
    if (moments.empty()) return {};
    Twins twins(scenario, settings_, time_of(moments.back()));
    for (std::size_t k = 0; k < moments.size(); ++k) {
      if (!twins.go_to(time_of(moments[k]))) return twins.solution(false);
      take(k, twins.states(), twins.tally());
    }
    return twins.solution(true);
  }

 private:
  ConvergedSettings settings_;
};

}  // namespace

std::unique_ptr<TruthSource> make_converged_truth(const ConvergedSettings& settings) {
  return std::make_unique<ConvergedTruth>(settings);
}

}  // namespace carom
