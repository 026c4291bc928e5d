#include "comparison/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "comparison/conserved.h"
#include "comparison/overlap.h"

namespace carom {

namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// Two trajectories have parted once a ball is off by this share of the smallest radius: less than the width
/// of a line in a drawing of the scene.
constexpr double kDivergedShareOfRadius = 1e-3;
/// The same for energy and momentum, relative to their scales: no drawing of them would show it.
constexpr double kDivergedConserved = 1e-3;

/// The largest of the values that are known; nothing where none is.
std::optional<double> largest(const std::vector<double>& values) {
  std::optional<double> result;
  for (const double value : values) {
    if (!std::isnan(value)) result = std::max(result.value_or(value), value);
  }
  return result;
}

std::optional<double> above_zero(std::optional<double> value) {
  // In this order -0 becomes 0.
  return value ? std::optional(std::max(0.0, *value)) : value;
}

bool moving_immovable(const Scenario& s) {
  return std::any_of(s.balls.begin(), s.balls.end(),
                     [](const Ball& ball) { return std::isinf(ball.mass) && !ball.velocity.isZero(0.0); });
}

/// Whether something in the scene can turn energy into heat.
bool dissipates(const Scenario& s) {
  const auto loses = [](const Contact& c) { return c.restitution < 1.0 || c.friction > 0.0; };
  return s.effects.drag || (s.effects.collisions && loses(s.ball_contact)) ||
         (!s.walls.empty() && loses(s.wall_contact));
}

/// Compares everything in one scene; holds what all of its runs share.
class Comparer {
 public:
  Comparer(const Scenario& scene, const Truth& truth, double tolerance_m)
      : scene_(scene), truth_(truth), tolerance_m_(tolerance_m), reference_(scene) {
    if (!truth.known()) return;
    truth_conserved_.push_back(conserved_of(truth.trajectory));
    for (const Trajectory& around : truth.around) truth_conserved_.push_back(conserved_of(around));
  }

  void judge(RunComparison& result) const {
    if (result.run.status != RunStatus::ok) return;
    const std::vector<Conserved> conserved = conserved_of(result.run.trajectory);
    measure_energy(conserved, result);
    measure_momentum(conserved, result);
    result.metrics[Metric::angular_momentum] = largest(angular_momentum_errors(conserved, result.run));
    measure_positions(result);
    measure_contact(result);
    result.first_divergence = first_divergence(result);
  }

  PairComparison pair(std::size_t a, std::size_t b, const std::vector<RunComparison>& runs) const {
    const Run& run_a = runs[a].run;
    const Run& run_b = runs[b].run;
    const std::vector<Conserved> conserved_a = conserved_of(run_a.trajectory);
    const std::vector<Conserved> conserved_b = conserved_of(run_b.trajectory);
    PairComparison result;
    result.a = a;
    result.b = b;
    std::vector<double> positions;
    std::vector<double> energies;
    std::vector<double> momenta;
    std::vector<double> angular_momenta;
    double squares = 0.0;
    for (std::size_t k = 0; k < conserved_a.size(); ++k) {
      const Vec3 angular = conserved_a[k].angular_momentum_Nms - conserved_b[k].angular_momentum_Nms;
      angular_momenta.push_back(relative(angular.norm(), reference_.angular_momentum_scale_Nms));
      positions.push_back(farthest(run_a.trajectory, run_b.trajectory, k, &squares));
      energies.push_back(by_energy(std::abs(conserved_a[k].energy_J - conserved_b[k].energy_J)));
      momenta.push_back(by_momentum((conserved_a[k].momentum_Ns - conserved_b[k].momentum_Ns).norm()));
    }
    result.position_m = *largest(positions);
    result.position_rms_m = root_mean_square(squares, positions.size() * run_a.trajectory.balls());
    result.energy = largest(energies);
    result.momentum = largest(momenta);
    result.angular_momentum = largest(angular_momenta);
    result.first_divergence = divergence_of(run_a.trajectory, run_b.trajectory, positions, energies, momenta);
    return result;
  }

 private:
  /// A deviation by its scale. Where the scale is zero no deviation is none, and any other cannot be told.
  static double relative(double deviation, double scale) {
    if (scale > 0.0) return deviation / scale;
    return deviation == 0.0 ? 0.0 : kNotKnown;
  }
  double by_energy(double deviation_J) const { return relative(deviation_J, reference_.energy_scale_J); }
  double by_momentum(double deviation_Ns) const {
    return relative(deviation_Ns, reference_.momentum_scale_Ns);
  }

  std::vector<Conserved> conserved_of(const Trajectory& trajectory) const {
    std::vector<Conserved> conserved;
    for (std::size_t k = 0; k < trajectory.frames(); ++k)
      conserved.push_back(reference_.of(trajectory.frame(k)));
    return conserved;
  }

  /// What is left of a difference from the truth, the nearest of its values around this frame being taken.
  template <class Difference>
  auto nearest(std::size_t frame, const Difference& difference) const {
    auto least = difference(truth_conserved_.front()[frame]);
    for (const std::vector<Conserved>& values : truth_conserved_) {
      const auto other = difference(values[frame]);
      if (size_of(other) < size_of(least)) least = other;
    }
    return least;
  }
  static double size_of(double difference) { return std::abs(difference); }
  static double size_of(const Vec3& difference) { return difference.norm(); }

  double energy_off_truth(const Conserved& now, std::size_t frame) const {
    return nearest(frame, [&](const Conserved& truth) { return now.energy_J - truth.energy_J; });
  }

  bool truth_known_at(std::size_t frame) const {
    return truth_.known() && truth_.trajectory.time(frame) <= truth_.horizon_s.value_or(scene_.duration_s);
  }

  // --- energy

  void measure_energy(const std::vector<Conserved>& conserved, RunComparison& result) const {
    std::vector<double> gains;
    std::vector<double> losses;
    double lowest = reference_.start.energy_J;
    for (std::size_t k = 0; k < conserved.size(); ++k) {
      const double energy = conserved[k].energy_J;
      result.series.energy.push_back(by_energy(energy - reference_.start.energy_J));
      if (truth_known_at(k)) {
        gains.push_back(by_energy(energy_off_truth(conserved[k], k)));
        losses.push_back(-gains.back());
      } else if (!moving_immovable(scene_) && scene_.events.empty()) {
        if (dissipates(scene_)) {
          gains.push_back(by_energy(energy - lowest));
        } else {
          gains.push_back(by_energy(energy - reference_.start.energy_J));
          losses.push_back(-gains.back());
        }
      }
      lowest = std::min(lowest, energy);
    }
    const std::optional<double> gain = above_zero(largest(gains));
    const std::optional<double> loss = above_zero(largest(losses));
    result.metrics[Metric::energy_gain] = gain;
    result.metrics[Metric::energy_loss] = loss;
    if (gain || loss) result.metrics[Metric::energy] = std::max(gain.value_or(0.0), loss.value_or(0.0));
  }

  // --- momentum

  void measure_momentum(const std::vector<Conserved>& conserved, RunComparison& result) const {
    for (std::size_t k = 0; k < conserved.size(); ++k) {
      result.series.momentum.push_back(by_momentum(momentum_error(conserved[k], result.run, k)));
    }
    result.metrics[Metric::momentum] = largest(result.series.momentum);
  }

  double momentum_error(const Conserved& now, const Run& run, std::size_t frame) const {
    const Tally& tally = run.trajectory.tally(frame);
    // What these take from the momentum depends on the whole path.
    const bool quadratic = scene_.effects.drag && scene_.effects.drag->kind == Drag::Kind::quadratic;
    if (quadratic || scene_.effects.magnus || !tally.external_known || !scene_.events.empty()) {
      if (!truth_known_at(frame)) return kNotKnown;
      const Vec3 off =
          nearest(frame, [&](const Conserved& truth) -> Vec3 { return now.momentum_Ns - truth.momentum_Ns; });
      return off.norm();
    }
    Vec3 expected = reference_.start.momentum_Ns + tally.external_impulse;
    if (scene_.effects.gravity) {
      expected += reference_.mass_kg * run.trajectory.time(frame) * *scene_.effects.gravity;
    }
    if (scene_.effects.drag) expected -= scene_.effects.drag->coefficient * displacement(run, frame);
    return (now.momentum_Ns - expected).norm();
  }

  /// Σ Δx of the movable balls, m: linear drag takes c times this from the momentum, whatever happens on the
  /// way.
  Vec3 displacement(const Run& run, std::size_t frame) const {
    Vec3 sum = Vec3::Zero();
    const auto balls = run.trajectory.frame(frame);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      if (std::isfinite(scene_.balls[i].mass)) sum += balls[i].position - scene_.balls[i].position;
    }
    return sum;
  }

  // --- angular momentum

  std::vector<double> angular_momentum_errors(const std::vector<Conserved>& conserved, const Run& run) const {
    std::vector<double> errors;
    for (std::size_t k = 0; k < conserved.size(); ++k) {
      errors.push_back(
          relative(angular_momentum_error(conserved[k], run, k), reference_.angular_momentum_scale_Nms));
    }
    return errors;
  }

  double angular_momentum_error(const Conserved& now, const Run& run, std::size_t frame) const {
    if (truth_known_at(frame)) {
      const Vec3 off = nearest(frame, [&](const Conserved& truth) -> Vec3 {
        return now.angular_momentum_Nms - truth.angular_momentum_Nms;
      });
      return off.norm();
    }
    const Tally& tally = run.trajectory.tally(frame);
    const bool bounded = !scene_.walls.empty() || has_immovable();
    if (scene_.effects.drag || !scene_.events.empty() || !tally.external_known) return kNotKnown;
    Vec3 error = now.angular_momentum_Nms - reference_.start.angular_momentum_Nms -
                 (tally.external_angular_impulse - reference_.origin.cross(tally.external_impulse));
    if (!scene_.effects.gravity) return error.norm();
    const Vec3& gravity = *scene_.effects.gravity;
    if (bounded) {
      if (scene_.dimension == 2) return kNotKnown;  // gravity lies in the plane, angular momentum across it
      return std::abs(error.dot(gravity.normalized()));
    }
    const double t = run.trajectory.time(frame);
    error -= reference_.mass_kg * (0.5 * t * t) * reference_.origin_velocity.cross(gravity);
    return error.norm();
  }

  bool has_immovable() const {
    return std::any_of(scene_.balls.begin(), scene_.balls.end(),
                       [](const Ball& ball) { return std::isinf(ball.mass); });
  }

  // --- positions

  void measure_positions(RunComparison& result) const {
    double squares = 0.0;
    for (std::size_t k = 0; k < result.run.trajectory.frames(); ++k) {
      result.series.position.push_back(
          truth_known_at(k) ? farthest(result.run.trajectory, truth_.trajectory, k, &squares) : kNotKnown);
    }
    result.metrics[Metric::position] = largest(result.series.position);
    if (truth_.known()) {
      const std::vector<double>& errors = result.series.position;
      const auto known =
          std::count_if(errors.begin(), errors.end(), [](double error) { return !std::isnan(error); });
      result.metrics[Metric::position_rms] =
          root_mean_square(squares, static_cast<std::size_t>(known) * result.run.trajectory.balls());
    }
  }

  /// The largest distance of a ball in `a` from itself in `b`, m; adds all of them squared.
  static double farthest(const Trajectory& a, const Trajectory& b, std::size_t frame, double* squares) {
    double farthest_square = 0.0;
    const auto balls_a = a.frame(frame);
    const auto balls_b = b.frame(frame);
    for (std::size_t i = 0; i < balls_a.size(); ++i) {
      const double square = (balls_a[i].position - balls_b[i].position).squaredNorm();
      farthest_square = std::max(farthest_square, square);
      *squares += square;
    }
    return std::sqrt(farthest_square);
  }

  static double root_mean_square(double squares, std::size_t count) {
    return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(count, 1)));
  }

  void measure_contact(RunComparison& result) const {
    const Trajectory& trajectory = result.run.trajectory;
    double deepest = 0.0;
    std::vector<bool> outside(trajectory.balls(), false);
    for (std::size_t k = 0; k < trajectory.frames(); ++k) {
      const auto balls = trajectory.frame(k);
      deepest = std::max(deepest, deepest_overlap(scene_, balls));
      for (std::size_t i = 0; i < balls.size(); ++i) {
        for (const Wall& wall : scene_.walls) {
          if (wall.normal.dot(balls[i].position) < wall.offset) outside[i] = true;
        }
        for (const Slab& slab : scene_.slabs) {
          const auto side = [&slab](const Vec3& x) { return slab.normal.dot(x) > slab.offset; };
          if (side(balls[i].position) != side(scene_.balls[i].position)) outside[i] = true;
        }
      }
    }
    result.metrics[Metric::penetration] = deepest;
    if (!scene_.walls.empty() || !scene_.slabs.empty()) {
      result.metrics[Metric::escaped] = static_cast<double>(std::count(outside.begin(), outside.end(), true));
    }
  }

  // --- divergence

  std::optional<Divergence> first_divergence(const RunComparison& result) const {
    if (!truth_.known()) return std::nullopt;
    const std::vector<Conserved> conserved = conserved_of(result.run.trajectory);
    std::vector<double> energies;
    for (std::size_t k = 0; k < conserved.size(); ++k) {
      const bool known = truth_known_at(k);
      energies.push_back(known ? by_energy(std::abs(energy_off_truth(conserved[k], k))) : kNotKnown);
    }
    return divergence_of(result.run.trajectory, truth_.trajectory, result.series.position, energies,
                         result.series.momentum);
  }

  /// The first frame in which one of the series passes its tolerance. Of those that pass in the same frame
  /// the position is named first: it says which balls.
  std::optional<Divergence> divergence_of(const Trajectory& a, const Trajectory& b,
                                          const std::vector<double>& positions,
                                          const std::vector<double>& energies,
                                          const std::vector<double>& momenta) const {
    for (std::size_t k = 0; k < positions.size(); ++k) {
      Divergence divergence{a.time(k), most_different(a, b, k), Metric::position};
      if (positions[k] > tolerance_m_) return divergence;
      if (energies[k] > kDivergedConserved) divergence.metric = Metric::energy;
      if (momenta[k] > kDivergedConserved) divergence.metric = Metric::momentum;
      if (divergence.metric != Metric::position) return divergence;
    }
    return std::nullopt;
  }

  /// The ball that is off the most, and the second where it is off by at least a tenth as much.
  static std::vector<std::size_t> most_different(const Trajectory& a, const Trajectory& b,
                                                 std::size_t frame) {
    constexpr double kAsFarOff = 0.1;
    std::vector<std::pair<double, std::size_t>> distances;
    for (std::size_t i = 0; i < a.balls(); ++i) {
      distances.emplace_back((a.frame(frame)[i].position - b.frame(frame)[i].position).norm(), i);
    }
    const std::size_t named = std::min<std::size_t>(2, distances.size());
    std::partial_sort(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(named),
                      distances.end(), [](const auto& x, const auto& y) {
                        return x.first > y.first || (x.first == y.first && x.second < y.second);
                      });
    std::vector<std::size_t> balls;
    for (std::size_t rank = 0; rank < named; ++rank) {
      if (rank == 0 || distances[rank].first >= kAsFarOff * distances[0].first) {
        balls.push_back(distances[rank].second);
      }
    }
    std::sort(balls.begin(), balls.end());
    return balls;
  }

  const Scenario& scene_;
  const Truth& truth_;
  double tolerance_m_;
  Reference reference_;
  std::vector<std::vector<Conserved>> truth_conserved_;  ///< at the frames, then at times around them
};

// --- gates

/// [gate] for the engines under test, and over it what [gate.<engine>] says of one engine.
Limits limits_for(const Gate& gate, const RunComparison& result) {
  Limits limits = result.under_test ? gate.under_test : Limits{};
  const auto own = gate.per_engine.find(result.run.label());
  if (own == gate.per_engine.end()) return limits;
  for (const auto& [metric, limit] : own->second) limits[metric] = limit;
  return limits;
}

void hold_gates(const Limits& limits, RunComparison& result) {
  for (const auto& [metric, limit] : limits) {
    const std::optional<double> value = result.metrics[metric];
    result.gates.push_back({metric, limit, value, value && *value <= limit});
  }
  switch (result.run.status) {
    case RunStatus::unsupported:
      result.verdict = Verdict::unsupported;
      return;
    case RunStatus::crashed:
    case RunStatus::timeout:
    case RunStatus::invalid:
      result.verdict = Verdict::error;
      return;
    case RunStatus::ok:
      break;
  }
  const bool all_hold = std::all_of(result.gates.begin(), result.gates.end(),
                                    [](const GateResult& gate) { return gate.holds; });
  result.verdict = limits.empty() ? Verdict::shown : all_hold ? Verdict::pass : Verdict::fail;
}

double position_tolerance(const Scenario& scene) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Ball& ball : scene.balls) smallest = std::min(smallest, ball.radius);
  return kDivergedShareOfRadius * smallest;
}

}  // namespace

SceneComparison compare(ScenarioPtr scene, Truth truth, std::vector<Run> runs,
                        const std::vector<std::string>& under_test) {
  SceneComparison result;
  result.scene = std::move(scene);
  result.truth = std::move(truth);
  result.position_tolerance_m = position_tolerance(*result.scene);
  const Comparer comparer(*result.scene, result.truth, result.position_tolerance_m);
  for (Run& run : runs) {
    RunComparison& each = result.runs.emplace_back();
    each.run = std::move(run);
    each.under_test = std::find(under_test.begin(), under_test.end(), each.run.label()) != under_test.end();
    comparer.judge(each);
    hold_gates(limits_for(result.scene->gate, each), each);
  }
  for (std::size_t a = 0; a < result.runs.size(); ++a) {
    for (std::size_t b = a + 1; b < result.runs.size(); ++b) {
      if (result.runs[a].run.status != RunStatus::ok || result.runs[b].run.status != RunStatus::ok) continue;
      result.pairs.push_back(comparer.pair(a, b, result.runs));
    }
  }
  return result;
}

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::shown:
      return "shown";
    case Verdict::unsupported:
      return "unsupported";
    case Verdict::error:
      return "error";
  }
  return "?";
}

std::string_view name_of(RunStatus status) {
  switch (status) {
    case RunStatus::ok:
      return "ok";
    case RunStatus::unsupported:
      return "unsupported";
    case RunStatus::crashed:
      return "crashed";
    case RunStatus::timeout:
      return "timeout";
    case RunStatus::invalid:
      return "invalid";
  }
  return "?";
}

}  // namespace carom
