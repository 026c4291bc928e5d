#include "comparison/predictability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/least_squares.h"

namespace carom {

namespace {

constexpr double kRoundingsOfImpact = 8.0;  ///< κ of (1)
/// Growth by which a random direction has turned into the one that grows.
constexpr double kTurned = 10.0;

bool known_at(const Truth& truth, std::size_t frame) {
  return !truth.solution.known_until_s || truth.trajectory.time(frame) <= *truth.solution.known_until_s;
}

/// X and L of (1), m.
struct Lengths {
  double place = 0.0;
  double reach = 0.0;
};

Lengths lengths_of(const Truth& truth, double duration_s) {
  Lengths lengths;
  for (std::size_t k = 0; k < truth.trajectory.frames() && known_at(truth, k); ++k) {
    for (const BallState& ball : truth.trajectory.frame(k)) {
      lengths.place = std::max(lengths.place, ball.position.norm());
      lengths.reach = std::max({lengths.reach, lengths.place, duration_s * ball.velocity.norm()});
    }
  }
  return lengths;
}

/// Of the ball that has the most, up to each frame; half of all impacts where they are not told one by one.
std::vector<double> most_impacts_of_a_ball(const Truth& truth) {
  std::vector<double> most(truth.trajectory.frames(), 0.0);
  std::vector<double> of_ball(truth.trajectory.balls(), 0.0);
  std::size_t next = 0;
  double largest = 0.0;
  for (std::size_t k = 0; k < most.size(); ++k) {
    const std::vector<TrueImpact>& impacts = truth.solution.impacts;
    for (; next < impacts.size() && impacts[next].time_s <= truth.trajectory.time(k); ++next) {
      largest = std::max(largest, ++of_ball[impacts[next].ball]);
      if (!impacts[next].wall) largest = std::max(largest, ++of_ball[impacts[next].partner]);
    }
    most[k] = impacts.empty() ? static_cast<double>(truth.trajectory.tally(k).impacts) : largest;
  }
  return most;
}

}  // namespace

double epsilon_of(const Run& run) {
  return run.precision == "float32" ? double{std::numeric_limits<float>::epsilon()}
                                    : std::numeric_limits<double>::epsilon();
}

std::vector<double> rounding_growth_m(const Scenario& scene, const Truth& truth, double epsilon,
                                      std::int64_t steps) {
  const Lengths lengths = lengths_of(truth, scene.duration_s);
  const std::vector<double> impacts = most_impacts_of_a_ball(truth);
  const std::vector<double>& amplification = truth.solution.amplification;
  const double directions = amplification.empty()
                                ? 1.0
                                : std::sqrt(2.0 * scene.dimension * static_cast<double>(scene.balls.size()));
  std::vector<double> growth;
  double largest = 1.0;
  for (std::size_t k = 0; k < truth.trajectory.frames() && known_at(truth, k); ++k) {
    if (k < amplification.size()) largest = std::max(largest, amplification[k]);
    const double share = static_cast<double>(k) / static_cast<double>(truth.trajectory.frames() - 1);
    const double taken = share * static_cast<double>(steps);
    const double rounded_m = (kRoundingsOfImpact * (1.0 + impacts[k]) + std::sqrt(taken)) * lengths.reach +
                             0.5 * taken * lengths.place;
    growth.push_back(directions * largest * epsilon * rounded_m);
  }
  return growth;
}

Predictability predictability_of(const Scenario& scene, const Truth& truth, double tolerance_m) {
  Predictability result;
  const std::vector<double>& amplification = truth.solution.amplification;
  if (!truth.known() || amplification.empty()) return result;
  std::vector<double> times;
  std::vector<double> logarithms;
  for (std::size_t k = 0; k < amplification.size() && known_at(truth, k); ++k) {
    if (!(amplification[k] >= kTurned)) continue;
    times.push_back(truth.trajectory.time(k));
    logarithms.push_back(std::log(amplification[k]));
  }
  constexpr std::size_t kFewest = 3;  // two points always lie on a line
  const bool spread =
      logarithms.size() >= kFewest && std::any_of(logarithms.begin(), logarithms.end(),
                                                  [&](double value) { return value != logarithms.front(); });
  if (spread) {
    const FittedLine line = line_through(times, logarithms);
    result.growth_rate_per_s = line.slope;
    result.growth_r_squared = line.r_squared;
  }
  const std::vector<double> growth =
      rounding_growth_m(scene, truth, std::numeric_limits<double>::epsilon(), 0);
  const auto past = std::find_if(growth.begin(), growth.end(), [&](double e) { return e > tolerance_m; });
  if (past != growth.end()) {
    // Up to the last frame before.
    const auto frame = static_cast<std::size_t>(past - growth.begin());
    result.horizon_s = truth.trajectory.time(frame - std::min<std::size_t>(frame, 1));
  }
  return result;
}

Judgement judge(const Scenario& scene, const Truth& truth, double tolerance_m,
                const RunComparison& measured) {
  Judgement judgement;
  const std::vector<double>& errors = measured.series.position;
  const std::vector<double> growth =
      rounding_growth_m(scene, truth, epsilon_of(measured.run), measured.run.steps);
  double largest = 0.0;
  for (std::size_t k = 0; k < std::min(errors.size(), growth.size()); ++k) {
    if (std::isnan(errors[k])) break;
    largest = std::max(largest, errors[k]);
    if (!judgement.beyond_rounding_s && errors[k] > truth.uncertainty_m + growth[k]) {
      judgement.beyond_rounding_s = truth.trajectory.time(k);
    }
  }
  const bool far = largest > tolerance_m;
  if (judgement.beyond_rounding_s) {
    judgement.accuracy = far ? Accuracy::systematic : Accuracy::within_tolerance;
  } else {
    judgement.accuracy = far ? Accuracy::chaos : Accuracy::exact;
  }
  return judgement;
}

}  // namespace carom
