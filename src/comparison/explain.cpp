#include "comparison/explain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "comparison/predictability.h"

namespace carom {

namespace {

/// A run that fails counts as this much: more than any error, and its logarithm is finite.
constexpr double kFailed = 1e300;
/// D_0 and D_all closer than this factor have nothing between them to share out.
constexpr double kTellApart = 2.0;
/// Below this share of the best single setting pairs are tried.
constexpr double kExplainsMuch = 0.5;
/// Settings that add less than this to the share explain nothing more.
constexpr double kAddsSomething = 0.01;
/// Half the step must divide what is left by more than this for the step to be its cause: an error of order 1
/// halves, and of order ½, the weakest that is seen, falls by √2; less than halfway to that is noise.
constexpr double kFallsWithStep = 1.19;  // 2^(1/4)

using Indices = std::vector<std::size_t>;

/// The search and what it has found so far.
class Search {
 public:
  Search(const std::vector<Switch>& switches, const DivergenceScale& scale, const RunTrials& run)
      : switches_(switches), scale_(scale), run_(run) {}

  Explanation result() {
    run_ends();
    run_alone();
    accumulate();
    name_remainder();
    return std::move(result_);
  }

 private:
  Indices all_indices() const {
    Indices all(switches_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    return all;
  }

  Trial trial(Indices which, bool half_step = false) const {
    std::sort(which.begin(), which.end());
    Trial trial;
    for (const std::size_t i : which) trial.switched.push_back(switches_[i].name);
    trial.half_step = half_step;
    return trial;
  }

  /// ln D, of what counts.
  double log_of(const std::optional<double>& divergence) const {
    return std::log(std::clamp(divergence.value_or(kFailed), scale_.floor, kFailed));
  }

  /// (1); where D_0 and D_all are the same, how far D falls in units of the least that can be told apart.
  double share(const std::optional<double>& divergence) const {
    const double whole = log_of(result_.start) - log_of(result_.all);
    const double part = log_of(result_.start) - log_of(divergence);
    return result_.settings_matter ? part / whole : part / std::log(kTellApart);
  }
  std::optional<double> share_if_any(const std::optional<double>& divergence) const {
    return result_.settings_matter ? std::optional(share(divergence)) : std::nullopt;
  }

  /// From the profile asked for to the other one, each at the step and at half of it.
  void run_ends() {
    const auto ends = run_({trial({}), trial({}, true), trial(all_indices()), trial(all_indices(), true)});
    result_.start = ends[0];
    result_.start_half_step = ends[1];
    result_.all = ends[2];
    result_.all_half_step = ends[3];
    result_.settings_matter = std::abs(log_of(result_.start) - log_of(result_.all)) >= std::log(kTellApart);
    result_.step_share = share_if_any(result_.start_half_step);
  }

  void run_alone() {
    std::vector<Trial> trials;
    for (std::size_t i = 0; i < switches_.size(); ++i) trials.push_back(trial({i}));
    if (!trials.empty()) alone_ = run_(trials);
  }

  /// Where (1) is defined the largest share comes first; else what moves the divergence most, either way.
  double effect(const std::optional<double>& divergence) const {
    return result_.settings_matter ? share(divergence) : std::abs(share(divergence));
  }

  /// The first of those with the largest effect. @pre not empty
  std::size_t best_of(const std::vector<std::optional<double>>& divergences) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < divergences.size(); ++i) {
      if (effect(divergences[i]) > effect(divergences[best])) best = i;
    }
    return best;
  }

  void accumulate() {
    Indices left = all_indices();
    if (left.empty()) return;
    const std::size_t best = best_of(alone_);
    add(best, alone_[best], left);
    if (result_.settings_matter && share(alone_[best]) < kExplainsMuch) start_from_best_pair(left);
    while (result_.settings_matter && add_best_on_top(left)) {
    }
    add_rest(left);
  }

  void start_from_best_pair(Indices& left) {
    std::vector<Trial> trials;
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < switches_.size(); ++i) {
      for (std::size_t k = i + 1; k < switches_.size(); ++k) {
        trials.push_back(trial({i, k}));
        pairs.emplace_back(i, k);
      }
    }
    if (trials.empty()) return;
    const auto divergences = run_(trials);
    const std::size_t best = best_of(divergences);
    auto [first, second] = pairs[best];
    // The single one that was taken may be worth less than this pair.
    if (share(divergences[best]) <= share(alone_[order_.front()]) + kAddsSomething) return;
    if (share(alone_[second]) > share(alone_[first])) std::swap(first, second);
    result_.pair = {switches_[first].name, switches_[second].name, divergences[best],
                    share(divergences[best])};
    order_.clear();
    result_.settings.clear();
    left = all_indices();
    add(first, alone_[first], left);
    add(second, divergences[best], left);
  }

  /// @return whether one of those left explained something more
  bool add_best_on_top(Indices& left) {
    std::vector<Trial> trials;
    for (const std::size_t i : left) trials.push_back(with(i));
    if (trials.empty()) return false;
    const auto divergences = run_(trials);
    const std::size_t best = best_of(divergences);
    if (share(divergences[best]) - share(result_.settings.back().cumulative) < kAddsSomething) return false;
    add(left[best], divergences[best], left);
    return true;
  }

  void add_rest(Indices left) {
    std::stable_sort(left.begin(), left.end(),
                     [this](std::size_t a, std::size_t b) { return effect(alone_[a]) > effect(alone_[b]); });
    std::vector<Trial> trials;
    Indices which = order_;
    for (const std::size_t i : left) {
      which.push_back(i);
      trials.push_back(trial(which));
    }
    if (trials.empty()) return;
    const auto divergences = run_(trials);
    const Indices rest = left;
    for (std::size_t k = 0; k < rest.size(); ++k) add(rest[k], divergences[k], left);
  }

  Trial with(std::size_t one_more) const {
    Indices which = order_;
    which.push_back(one_more);
    return trial(which);
  }

  void add(std::size_t i, const std::optional<double>& cumulative, Indices& left) {
    SettingEffect effect{switches_[i].name, switches_[i].meaning,    alone_[i],
                         cumulative,        share_if_any(alone_[i]), share_if_any(cumulative)};
    if (effect.share && !result_.settings.empty()) {
      *effect.share -= share(result_.settings.back().cumulative);
    }
    result_.settings.push_back(std::move(effect));
    order_.push_back(i);
    left.erase(std::remove(left.begin(), left.end(), i), left.end());
  }

  void name_remainder() {
    const std::optional<double>& rest = result_.all;
    result_.remainder_order = (log_of(rest) - log_of(result_.all_half_step)) / std::log(2.0);
    if (!rest) {
      result_.remainder = RemainderCause::failure;
    } else if (*rest <= scale_.floor) {
      result_.remainder = RemainderCause::nothing;
    } else if (result_.remainder_order > std::log2(kFallsWithStep)) {
      result_.remainder = RemainderCause::step;
    } else {
      result_.remainder = *rest <= scale_.rounding ? RemainderCause::rounding : RemainderCause::method;
    }
  }

  const std::vector<Switch>& switches_;
  const DivergenceScale& scale_;
  const RunTrials& run_;
  std::vector<std::optional<double>> alone_;
  Indices order_;  // of the settings that were accumulated
  Explanation result_;
};

}  // namespace

Explanation explain(const std::vector<Switch>& switches, const DivergenceScale& scale, const RunTrials& run) {
  return Search(switches, scale, run).result();
}

std::optional<Metric> telling_metric(const RunComparison& run) {
  if (run.run.status != RunStatus::ok) return std::nullopt;
  for (const Metric metric : {Metric::position, Metric::energy, Metric::energy_gain, Metric::momentum}) {
    if (run.metrics[metric]) return metric;
  }
  return std::nullopt;
}

DivergenceScale divergence_scale(Metric metric, const Scenario& scene, const Truth& truth, const Run& run) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const double rounding = epsilon_of(run) * static_cast<double>(run.steps);
  if (metric != Metric::position && metric != Metric::position_rms) return {kEpsilon, rounding};
  double smallest_m = std::numeric_limits<double>::infinity();
  for (const Ball& ball : scene.balls) smallest_m = std::min(smallest_m, ball.radius);
  double largest_m = 0.0;
  for (std::size_t frame = 0; frame < truth.trajectory.frames(); ++frame) {
    for (const BallState& ball : truth.trajectory.frame(frame)) {
      largest_m = std::max(largest_m, ball.position.lpNorm<Eigen::Infinity>());
    }
  }
  return {std::max(truth.uncertainty_m, kEpsilon * smallest_m), rounding * largest_m};
}

}  // namespace carom
