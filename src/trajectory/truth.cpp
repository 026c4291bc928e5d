#include "trajectory/truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <nlohmann/json.hpp>

#include "scenario/cast.h"
#include "trajectory/cpu_time.h"
#include "trajectory/record.h"

namespace carom {

namespace {

using Json = nlohmann::json;

/// How far, relative to the time, "just before" and "just after" a frame are: far above the rounding of an
/// impact time, far below what anything but an impact changes.
constexpr double kAround = 1e-9;
/// The moments of a frame, in order of time; the frame itself is the middle one.
constexpr std::array kShares = {1.0 - kAround, 1.0, 1.0 + kAround};
constexpr std::size_t kMiddle = 1;

/// The last frame that shows none of what events do; nothing where the first frame does.
std::optional<std::int64_t> last_frame_before_events(const Scenario& scenario) {
  if (scenario.events.empty()) return scenario.frames;
  const std::int64_t first = first_frame_after(scenario, scenario.events.front());
  return first > 0 ? std::optional(first - 1) : std::nullopt;
}

/// The moments of the frames up to the last, as the engines step to them: kShares.size() for each.
std::vector<Moment> moments_of(const Scenario& scenario, std::int64_t last_frame) {
  const std::int64_t steps = steps_per_frame(scenario);
  const double step_s =
      scenario.duration_s / static_cast<double>(scenario.frames) / static_cast<double>(steps);
  std::vector<Moment> moments;
  for (std::int64_t frame = 0; frame <= last_frame; ++frame) {
    for (const double share : kShares) moments.push_back({share * step_s, frame * steps});
  }
  return moments;
}

bool asks_for(TruthKind asked, std::string_view kind) {
  switch (asked) {
    case TruthKind::automatic:
      return true;
    case TruthKind::closed_form:
      return kind == "closed-form";
    case TruthKind::exact:
      return kind == "exact";
    case TruthKind::converged:
      return kind == "converged";
    case TruthKind::none:
      return false;
  }
  return false;
}

Json to_json(const Solution& solution) {
  Json json = {{"uncertainty_m", solution.uncertainty_m},
               {"limit", solution.limit},
               {"digits", solution.digits},
               {"impact_count", solution.impact_count},
               {"amplification", solution.amplification},
               {"impacts", Json::array()},
               {"ties", Json::array()}};
  if (solution.known_until_s) json["known_until_s"] = *solution.known_until_s;
  for (const TrueImpact& impact : solution.impacts) {
    json["impacts"].push_back({impact.time_s, impact.ball, impact.partner, impact.wall});
  }
  for (const Tie& tie : solution.ties) json["ties"].push_back({tie.time_s, tie.balls, tie.shares_ball});
  return json;
}

Solution solution_from(const Json& json) {
  Solution solution;
  solution.uncertainty_m = json.at("uncertainty_m");
  solution.limit = json.at("limit");
  solution.digits = json.at("digits");
  solution.impact_count = json.at("impact_count");
  solution.amplification = json.at("amplification").get<std::vector<double>>();
  if (json.contains("known_until_s")) solution.known_until_s = json.at("known_until_s").get<double>();
  for (const Json& row : json.at("impacts")) {
    solution.impacts.push_back({row.at(0), row.at(1), row.at(2), row.at(3)});
  }
  for (const Json& row : json.at("ties")) solution.ties.push_back({row.at(0), row.at(1), row.at(2)});
  return solution;
}

/// More impacts than this another source is not asked to tell over again.
constexpr std::int64_t kMostRetold = 2000;

/// Which impacts there were, from the first source that tells, where the one that solved the scene does not
/// (a closed form). Nothing else is taken from it: what has a closed form is regular, and how a change across
/// its symmetry would grow (of balls on a line, off the line) is no measure of what an engine can follow.
void tell_impacts(const Scenario& scenario, const std::vector<std::shared_ptr<const TruthSource>>& sources,
                  const std::vector<Moment>& moments, Solution& solution) {
  if (!solution.impacts.empty() || solution.impact_count == 0 || solution.impact_count > kMostRetold) return;
  for (const auto& source : sources) {
    if (source->kind() == "closed-form" || !source->refuses(scenario).empty()) continue;
    try {
      solution.impacts = source->solve(scenario, moments, [](auto, auto, const auto&) {}).impacts;
      return;
    } catch (const std::exception&) {
      // The solution stands without them; the next source may tell.
    }
  }
}

/// The scene as if nobody interfered, as far as that is how it goes.
Scenario undisturbed(const Scenario& scenario, std::int64_t last_frame) {
  Scenario scene = scenario;
  scene.events.clear();
  scene.duration_s = frame_time_s(scenario, last_frame);
  return scene;
}

/// What is left of a solution where events happen after this frame.
void end_at_events(const Scenario& scenario, std::int64_t last_frame, Solution& solution) {
  const double until_s = frame_time_s(scenario, last_frame);
  if (solution.known_until_s && *solution.known_until_s <= until_s) return;
  solution.known_until_s = until_s;
  solution.limit = fmt::format("somebody interferes at t = {} s", scenario.events.front().time);
}

/// The body of the solving process: the first source that takes the scene, or why none does.
std::string solve(const Scenario& whole, std::int64_t last_frame,
                  const std::vector<std::shared_ptr<const TruthSource>>& sources,
                  std::array<Trajectory, kShares.size()> trajectories) {
  const Scenario scenario = whole.events.empty() ? whole : undisturbed(whole, last_frame);
  std::string reasons;
  for (const auto& source : sources) {
    if (!asks_for(scenario.truth, source->kind())) continue;
    const std::string reason = source->refuses(scenario);
    if (!reason.empty()) {
      reasons += (reasons.empty() ? "" : "; ") + reason;
      continue;
    }
    const std::vector<Moment> moments = moments_of(whole, last_frame);
    const double before = cpu_now();
    Solution solution = source->solve(
        scenario, moments, [&](std::size_t k, std::span<const BallState> balls, const Tally& tally) {
          Trajectory& trajectory = trajectories[k % kShares.size()];
          const std::size_t frame = k / kShares.size();
          std::copy(balls.begin(), balls.end(), trajectory.frame(frame).begin());
          trajectory.tally(frame) = tally;
        });
    const double cpu_seconds = cpu_now() - before;
    tell_impacts(scenario, sources, moments, solution);
    if (!whole.events.empty()) end_at_events(whole, last_frame, solution);
    Json json = to_json(solution);
    json["kind"] = source->kind();
    json["cpu_seconds"] = cpu_seconds;
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  if (reasons.empty()) reasons = "no source of the kind that the scene asks for";
  return Json{{"reason", reasons}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Truth record_truth(const Scenario& scenario, const std::vector<std::shared_ptr<const TruthSource>>& sources,
                   const ProcessLimits& limits) {
  Truth truth;
  if (scenario.truth == TruthKind::none) {
    truth.reason = "the scene asks for none";
    return truth;
  }
  const std::optional<std::int64_t> last_frame = last_frame_before_events(scenario);
  if (!last_frame || *last_frame == 0) {
    truth.reason = fmt::format("somebody interferes at t = {} s", scenario.events.front().time);
    return truth;
  }
  std::array<Trajectory, kShares.size()> trajectories;
  for (Trajectory& trajectory : trajectories) trajectory = Trajectory(scenario);
  const ProcessOutcome outcome =
      run_isolated({[&] { return solve(scenario, *last_frame, sources, trajectories); }}, limits, 1).front();
  if (outcome.end != ProcessEnd::finished) {
    truth.reason = outcome.reason;
    return truth;
  }
  const Json json = Json::parse(outcome.payload);
  if (json.contains("reason")) {
    truth.reason = json.at("reason");
    return truth;
  }
  truth.kind = json.at("kind");
  truth.cpu_seconds = json.at("cpu_seconds");
  truth.solution = solution_from(json);
  truth.uncertainty_m = truth.solution.uncertainty_m;
  truth.horizon_s = truth.solution.known_until_s;
  truth.trajectory = trajectories[kMiddle];
  truth.around = {trajectories.front(), trajectories.back()};
  // Of each frame, not of the moments around it.
  std::vector<double>& amplification = truth.solution.amplification;
  for (std::size_t k = kMiddle; k < amplification.size(); k += kShares.size()) {
    amplification[k / kShares.size()] = amplification[k];
  }
  amplification.resize(amplification.size() / kShares.size());
  return truth;
}

}  // namespace carom
