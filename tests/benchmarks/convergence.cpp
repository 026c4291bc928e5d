#include "tests/benchmarks/convergence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "carom/compose.h"
#include "carom/evolvers/list.h"
#include "core/least_squares.h"
#include "reference/closed_form/closed_form.h"
#include "scenario/parse.h"

namespace carom {

namespace {

constexpr int kHalvings = 5;
/// An impact comes when it comes within a step, and an error depends on when. So it is averaged over
/// numbers of steps spread evenly from N to 2 N: the impact comes at every share of a step. All of them
/// double with N, so the average has the order that each has.
constexpr std::int64_t kStepsInBand = 64;

struct MeasuredScene {
  const char* id;
  std::int64_t fewest_steps;  ///< such that a step is short against everything in the scene
};

// No impact here comes at a simple fraction of the scene: at the border of two steps rounding would say to
// which of them it belongs.
constexpr std::array kScenes = {
    MeasuredScene{"impact/oblique", 128},           MeasuredScene{"wall/drop-elastic", 3840},
    MeasuredScene{"friction/slide-then-roll", 128}, MeasuredScene{"flight/linear-drag", 128},
    MeasuredScene{"flight/quadratic-drag", 128},    MeasuredScene{"flight/magnus-gravity", 128}};
constexpr std::array kEvolvers = {"step", "toi", "event"};

struct End {
  std::vector<BallState> balls;
  double uncertainty_m = 0.0;
};

End true_end(const Scenario& scene) {
  const auto truth = make_closed_form_truth();
  if (const std::string reason = truth->refuses(scene); !reason.empty()) {
    throw std::runtime_error(scene.id + ": " + reason);
  }
  End end;
  const Moment moment{scene.duration_s, 1};
  const Solution solution =
      truth->solve(scene, {&moment, 1}, [&](std::size_t, std::span<const BallState> balls, const Tally&) {
        end.balls.assign(balls.begin(), balls.end());
      });
  end.uncertainty_m = solution.uncertainty_m;
  return end;
}

double error_at_end_m(const Scenario& scene, const std::string& evolver, std::int64_t steps, const End& end) {
  const auto simulation = compose(scene, {evolver, ""});
  simulation->advance(scene.duration_s / static_cast<double>(steps), steps);
  std::vector<BallState> balls(scene.balls.size());
  simulation->snapshot(balls);
  double error_m = 0.0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    error_m = std::max(error_m, (balls[i].position - end.balls[i].position).norm());
  }
  return error_m;
}

/// How far a ball may be, or may come by its speed, in the whole scene.
double reach_m(const Scenario& scene, const End& end) {
  double place_m = 0.0;
  double speed_mps = 0.0;
  for (std::size_t i = 0; i < end.balls.size(); ++i) {
    place_m = std::max({place_m, scene.balls[i].position.norm(), end.balls[i].position.norm()});
    speed_mps = std::max({speed_mps, scene.balls[i].velocity.norm(), end.balls[i].velocity.norm()});
  }
  // Where it falls, or rises, it is faster meanwhile by the square root of 2 g × the way at most.
  const double g_mps2 = scene.effects.gravity.value_or(Vec3::Zero()).norm();
  speed_mps += std::sqrt(2.0 * g_mps2 * place_m);
  return place_m + speed_mps * scene.duration_s;
}

StepError mean_error(const Scenario& scene, const std::string& evolver, std::int64_t fewest_steps,
                     const End& end) {
  double sum_m = 0.0;
  for (std::int64_t k = 0; k < kStepsInBand; ++k) {
    sum_m += error_at_end_m(scene, evolver, fewest_steps + fewest_steps * k / kStepsInBand, end);
  }
  // Every step rounds a velocity, which the rest of the scene carries on, and a place, each twice by ε/2. A
  // place's error at an oblique impact turns the way that follows by its share of the radii; in these scenes
  // that is six times the error of 0.4 of the steps, of the place alone, and within the same bound.
  const double most_steps = 2.0 * static_cast<double>(fewest_steps);
  return {scene.duration_s / static_cast<double>(fewest_steps), sum_m / kStepsInBand,
          most_steps * std::numeric_limits<double>::epsilon() * reach_m(scene, end) + end.uncertainty_m};
}

void fit(Convergence& result) {
  std::vector<double> log_step;
  std::vector<double> log_error;
  for (const StepError& error : result.errors) {
    log_step.push_back(std::log(error.step_s));
    log_error.push_back(std::log(error.error_m));
  }
  const FittedLine line = line_through(log_step, log_error);
  result.order = line.slope;
  result.r_squared = line.r_squared;
}

Convergence converge(const Scenario& scene, const std::string& evolver, std::int64_t fewest_steps,
                     const End& end) {
  Convergence result;
  result.scene = scene.id;
  result.evolver = evolver;
  result.refuses = refusal(scene, {evolver, ""});
  if (!result.refuses.empty()) return result;
  result.claimed = claimed_order(evolver, scene);
  for (int halving = 0; halving <= kHalvings; ++halving) {
    result.errors.push_back(mean_error(scene, evolver, fewest_steps << halving, end));
  }
  if (!result.is_rounding()) fit(result);
  return result;
}

}  // namespace

bool Convergence::is_rounding() const {
  return std::all_of(errors.begin(), errors.end(),
                     [](const StepError& error) { return error.error_m <= error.rounding_m; });
}

std::optional<int> claimed_order(const std::string& evolver, const Scenario& scene) {
  for (const Evolver& each : all_evolvers()) {
    if (each.name == evolver && each.claimed_order != nullptr) return each.claimed_order(scene);
  }
  return std::nullopt;
}

std::vector<Convergence> measure_convergence(const std::filesystem::path& scenes) {
  std::vector<Convergence> all;
  for (const MeasuredScene& measured : kScenes) {
    const ScenarioPtr scene = load_scene(scenes / (std::string(measured.id) + ".toml"));
    const End end = true_end(*scene);
    for (const char* evolver : kEvolvers) {
      all.push_back(converge(*scene, evolver, measured.fewest_steps, end));
    }
  }
  return all;
}

}  // namespace carom
