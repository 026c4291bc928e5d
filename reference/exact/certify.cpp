#include "reference/exact/certify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "reference/exact/run.h"

namespace carom::exact {

namespace {

/// An amplification beyond this is not handed out: it nears what a double can hold.
constexpr double kMostAmplification = 1e300;

/// What it takes to compare a ball's states in three runs at a moment, in steps of 10 ns.
constexpr std::int64_t kCompare = 400;

/// Whom a ball met.
struct Met {
  std::uint32_t ball;
  std::uint32_t partner;
  bool wall;

  bool operator==(const Met&) const = default;
};

/// The impacts of each ball in their order, ball by ball. Impacts of different balls at one moment have no
/// order.
std::vector<Met> by_ball(std::span<const TrueImpact> impacts) {
  std::vector<Met> met;
  for (const TrueImpact& impact : impacts) {
    met.push_back({impact.ball, impact.partner, impact.wall});
    if (!impact.wall) met.push_back({impact.partner, impact.ball, false});
  }
  std::stable_sort(met.begin(), met.end(), [](const Met& a, const Met& b) { return a.ball < b.ball; });
  return met;
}

bool same_impacts(const Run& a, const Run& b, std::size_t from) {
  if (a.impacts().size() != b.impacts().size()) return false;
  return by_ball(std::span(a.impacts()).subspan(from)) == by_ball(std::span(b.impacts()).subspan(from));
}

/// The states of all balls at a run's moment.
std::vector<Body> states_of(const Run& run, std::size_t balls) {
  std::vector<Body> states;
  states.reserve(balls);
  for (std::size_t i = 0; i < balls; ++i) states.push_back(run.state(i));
  return states;
}

Real largest(const Vector& a) {
  return std::max({Real(abs(a.c[0])), Real(abs(a.c[1])), Real(abs(a.c[2]))});
}

class Certifier {
 public:
  Certifier(const Scenario& scene, double end_s, const Demands& demands)
      : scene_(scene), demands_(demands), end_s_(end_s), budget_{demands.budget} {
    low_ = run(demands.digits);
    raise();
  }

  /// Whether the states at a moment are certified, and so can be handed out; the last one is.
  bool reach(const Moment& moment) {
    while (true) {
      const bool low_there = low_->follow(moment);
      const bool high_there = high_->follow(moment);
      if (stopped_by_budget(*low_) || stopped_by_budget(*high_)) {
        return end(fmt::format("the budget of arithmetic is used up, at {} digits", high_->digits()));
      }
      if (same_impacts(*low_, *high_, compared_)) {
        if (low_there && high_there && agree()) return accept(moment);
        if (low_there == high_there && !low_there && low_->stop()->reason == high_->stop()->reason) {
          return end_together();
        }
      }
      if (2 * high_->digits() > demands_.most_digits) {
        return end(fmt::format("arithmetic of {} and of {} digits do not agree any longer", low_->digits(),
                               high_->digits()));
      }
      low_ = std::move(high_);
      compared_ = 0;
      raise();
    }
  }

  void take(std::vector<BallState>& balls) const {
    for (std::size_t i = 0; i < balls.size(); ++i) {
      balls[i] = {rounded(states_[i].position_m), rounded(states_[i].velocity_mps),
                  rounded(states_[i].spin_radps)};
    }
  }

  Tally tally() const { return high_->tally(); }

  Solution solution() {
    Solution& s = solution_;
    s.digits = low_->digits();
    s.impact_count = static_cast<std::int64_t>(impacts_);
    const std::size_t told = std::min(impacts_, Solution::kMostImpactsTold);
    // The run with P digits has them all: it is the one that they were certified with, or the one that took
    // its place and has more.
    s.impacts.assign(low_->impacts().begin(), low_->impacts().begin() + static_cast<std::ptrdiff_t>(told));
    for (const Tie& tie : low_->ties()) {
      if (!s.known_until_s || tie.time_s <= std::nextafter(*s.known_until_s, end_s_)) s.ties.push_back(tie);
    }
    // √3 of what a coordinate is off by: the difference of the runs, and ε/2 as it is rounded to a double.
    s.uncertainty_m = 2.0 * difference_m_ + kEpsilon * farthest_m_;
    return s;
  }

 private:
  std::unique_ptr<Run> run(int count) {
    const Digits digits(count);
    return std::make_unique<Run>(scene_, digits, end_s_, budget_);
  }

  /// Gives the run with P digits one with 2 P, and that one a twin, changed by 10^-P of the scale: much more
  /// than rounding does, and still so little that what becomes of it is proportional to it, as 10^P is more
  /// than any growth that P digits can follow.
  void raise() {
    high_ = run(2 * low_->digits());
    twin_.reset();
    twin_impacts_ = 0;
    if (!amplifies_) return;
    twin_ = run(high_->digits());
    const Digits digits(high_->digits());
    twin_->perturb(pow(Real(10), -low_->digits()) * high_->setting().scale_m);
  }

  static bool stopped_by_budget(const Run& run) { return run.stop() && run.stop()->budget; }

  /// Compares the states at the moment that both runs have reached, coordinate by coordinate, and keeps those
  /// with more digits.
  bool agree() {
    const Digits digits(high_->digits());
    const Real within_mps = demands_.tolerance * high_->top_speed_mps();
    budget_.left -= kCompare * static_cast<std::int64_t>(scene_.balls.size());
    states_ = states_of(*high_, scene_.balls.size());
    Real farthest = 0;
    Real difference = 0;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const Body low = low_->state(i);
      if (largest(low.velocity_mps - states_[i].velocity_mps) > within_mps) return false;
      if (largest(low.spin_radps - states_[i].spin_radps) * scene_.balls[i].radius > within_mps) return false;
      difference = std::max(difference, largest(low.position_m - states_[i].position_m));
      farthest = std::max(farthest, largest(states_[i].position_m));
    }
    if (difference > demands_.tolerance * std::max(farthest, Real(high_->setting().scale_m))) return false;
    difference_m_ = std::max(difference_m_, difference.convert_to<double>());
    farthest_m_ = std::max(farthest_m_, farthest.convert_to<double>());
    return true;
  }

  bool accept(const Moment& moment) {
    impacts_ = compared_ = high_->impacts().size();
    known_s_ = moment.step_s * static_cast<double>(moment.steps);
    amplify(moment);
    return true;
  }

  /// Once other balls meet in the twin, nothing is proportional any longer.
  void amplify(const Moment& moment) {
    if (!twin_) return;
    amplifies_ = twin_->follow(moment) && same_impacts(*twin_, *high_, twin_impacts_);
    if (!amplifies_) return;
    twin_impacts_ = impacts_;
    const Digits digits(high_->digits());
    Real square = 0;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const Vector change = twin_->state(i).position_m - states_[i].position_m;
      square = std::max(square, dot(change, change));
    }
    const double factor = Real(sqrt(square) / twin_->perturbation_m()).convert_to<double>();
    amplifies_ = factor < kMostAmplification;
    if (amplifies_) solution_.amplification.push_back(factor);
  }

  bool end(std::string limit) {
    if (!known_s_) throw std::runtime_error("no exact solution: " + limit);
    solution_.known_until_s = known_s_;
    solution_.limit = std::move(limit);
    return false;
  }

  /// Both runs stop at the same event, and up to it all is known.
  bool end_together() {
    end(high_->stop()->reason);
    impacts_ = high_->impacts().size();
    const double stop_s = std::min(low_->stop()->time_s, high_->stop()->time_s);
    solution_.known_until_s = std::max(*known_s_, std::nextafter(stop_s, 0.0));
    return false;
  }

  const Scenario& scene_;
  Demands demands_;
  double end_s_;
  Budget budget_;
  std::unique_ptr<Run> low_;
  std::unique_ptr<Run> high_;
  std::unique_ptr<Run> twin_;
  std::vector<Body> states_;
  std::size_t impacts_ = 0;       ///< so many are certified
  std::size_t compared_ = 0;      ///< so many are the same in these two runs
  std::size_t twin_impacts_ = 0;  ///< so many are compared with those of the twin
  bool amplifies_ = true;
  double difference_m_ = 0.0;
  double farthest_m_ = 0.0;
  std::optional<double> known_s_;
  Solution solution_;
};

}  // namespace

Solution certify(const Scenario& scene, std::span<const Moment> moments, const TruthSource::Taker& take,
                 const Demands& demands) {
  if (moments.empty()) return {};
  const double end_s = moments.back().step_s * static_cast<double>(moments.back().steps);
  Certifier certifier(scene, end_s * (1.0 + 4.0 * kEpsilon), demands);
  std::vector<BallState> balls(scene.balls.size());
  for (std::size_t k = 0; k < moments.size() && certifier.reach(moments[k]); ++k) {
    certifier.take(balls);
    take(k, balls, certifier.tally());
  }
  return certifier.solution();
}

}  // namespace carom::exact
