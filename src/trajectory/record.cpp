#include "trajectory/record.h"

#include <fmt/format.h>

#include <deque>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "scenario/cast.h"
#include "trajectory/cpu_time.h"
#include "trajectory/staged_run.h"

namespace carom {

namespace {

using Json = nlohmann::json;

/// What an engine's process records into.
struct Recording {
  explicit Recording(const Scenario& scenario)
      : states(Trajectory::memory_for_states(scenario)), trajectory(scenario, states) {}

  SharedMemory states;  ///< what the trajectory's states lie in
  Trajectory trajectory;
};

/// Writes frames as they come, each from the same room.
class FrameWriter {
 public:
  explicit FrameWriter(Recording& recording) : recording_(recording), balls_(recording.trajectory.balls()) {}

  void write(const StagedRun& run, std::size_t frame) {
    run.snapshot(balls_);
    recording_.states.write(frame * balls_.size() * sizeof(BallState), std::as_bytes(std::span(balls_)));
    recording_.trajectory.tally(frame) = run.tally();
  }

 private:
  Recording& recording_;
  std::vector<BallState> balls_;
};

/// A simulation of the scene, or of what an event has made of it. @throws NotTaken
std::unique_ptr<Simulation> create(const Engine& engine, const EngineChoice& choice, const Scenario& scene) {
  const std::string unsupported = unsupported_reason(engine, scene, choice.profile);
  if (!unsupported.empty()) throw NotTaken(unsupported);
  return create_simulation(engine, scene, choice);
}

/// Simulates, records into the shared trajectory, adds the rest to the result. @throws NotTaken
void simulate(const Scenario& scenario, const StagedRun::Create& create, Recording& recording, Json& result) {
  // Left standing: the process that records ends with it, and an engine of many balls is long in taking down.
  // What it recorded is there by then, whatever an engine would do in its destructor.
  StagedRun& run = *std::make_unique<StagedRun>(scenario, create).release();
  double cpu_seconds = 0.0;
  std::int64_t steps = 0;
  FrameWriter frames(recording);
  frames.write(run, 0);
  for (std::size_t frame = 1; frame < recording.trajectory.frames(); ++frame) {
    const double before = cpu_now();
    steps += run.to_next_frame();
    cpu_seconds += cpu_now() - before;
    frames.write(run, frame);
  }
  result["cpu_seconds"] = cpu_seconds;
  result["steps"] = steps;
  result["uncertainty_m"] = run.uncertainty_m();
  result["interferences"] = packed(run.interferences());
  for (const auto& [name, value] : run.settings()) {
    std::visit([&, &key = name](const auto& v) { result["settings"][key] = v; }, value);
  }
}

/// The body of a recording process: what it does not record it returns as JSON.
std::string record(const Scenario& scenario, const EngineChoice& choice, Recording& recording) {
  const Engine& engine = choice.source.open();
  const EngineInfo info = engine.info();
  Json result = {{"version", info.version}, {"precision", info.precision}};
  const auto lacking = info.cannot.find(Feature::events);
  if (!scenario.events.empty() && lacking != info.cannot.end()) {
    result["unsupported"] = fmt::format("{}: {}", name_of(Feature::events), lacking->second);
    return result.dump();
  }
  try {
    simulate(
        scenario, [&](const Scenario& stage) { return create(engine, choice, stage); }, recording, result);
  } catch (const NotTaken& reason) {
    result["unsupported"] = reason.what();
  }
  return result.dump(-1, ' ', false, Json::error_handler_t::replace);
}

SettingValue setting_value(const Json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  return std::string("not finite");
}

/// Whether all states are surely finite: the sum of numbers is not where one of them is not.
bool surely_finite(std::span<const BallState> balls) {
  Vec3 sum = Vec3::Zero();
  for (const BallState& ball : balls) sum += ball.position + ball.velocity + ball.spin;
  return sum.allFinite();
}

/// The first state that is not finite, in words; empty where all are.
std::string not_finite(const Trajectory& trajectory) {
  for (std::size_t frame = 0; frame < trajectory.frames(); ++frame) {
    const Tally& tally = trajectory.tally(frame);
    if (!tally.external_impulse.allFinite() || !tally.external_angular_impulse.allFinite()) {
      return fmt::format("the account of the walls' impulses is not finite at t = {:.6g} s",
                         trajectory.time(frame));
    }
    const auto balls = trajectory.frame(frame);
    if (surely_finite(balls)) continue;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      if (!trajectory.present(frame, i)) continue;
      if (balls[i].position.allFinite() && balls[i].velocity.allFinite() && balls[i].spin.allFinite())
        continue;
      return fmt::format("the state of ball {} is not finite at t = {:.6g} s", i, trajectory.time(frame));
    }
  }
  return {};
}

void take_result(const std::string& payload, Run& run) {
  const Json result = Json::parse(payload);
  run.version = result.at("version");
  run.precision = result.at("precision");
  if (result.contains("unsupported")) {
    run.status = RunStatus::unsupported;
    run.reason = result.at("unsupported");
    return;
  }
  run.cpu_seconds = result.at("cpu_seconds");
  run.steps = result.at("steps");
  run.uncertainty_m = result.at("uncertainty_m");
  run.interferences = unpacked_interferences(result.at("interferences"));
  if (result.contains("settings")) {
    for (const auto& [name, value] : result.at("settings").items()) run.settings[name] = setting_value(value);
  }
  run.reason = not_finite(run.trajectory);
  if (!run.reason.empty()) run.status = RunStatus::invalid;
}

}  // namespace

std::unique_ptr<Simulation> create_simulation(const Engine& engine, const Scenario& scenario,
                                              const EngineChoice& choice) {
  if (choice.tuned) {
    return dynamic_cast<const Tunable&>(engine).create_tuned(scenario, choice.profile, *choice.tuned);
  }
  if (choice.switched.empty()) return engine.create(scenario, choice.profile);
  return engine.create_switched(scenario, choice.profile, choice.switched);
}

std::vector<Run> run_engines(const Scenario& scenario, const std::vector<EngineChoice>& engines,
                             const ProcessLimits& limits, int parallel,
                             const std::function<void(std::size_t)>& done) {
  std::vector<Run> runs;
  std::vector<Job> jobs;
  std::deque<Recording> recordings;
  const double trajectory_mib = static_cast<double>(sizeof(BallState)) *
                                static_cast<double>(numbered_balls(scenario)) *
                                static_cast<double>(scenario.frames + 1) / (1024.0 * 1024.0);
  if (trajectory_mib > limits.memory_mib) {
    throw MachineError(fmt::format("{}: {} balls in {} frames take {:.0f} MiB, more than --memory {:g}",
                                   scenario.file, numbered_balls(scenario), scenario.frames + 1,
                                   trajectory_mib, limits.memory_mib));
  }
  for (const EngineChoice& choice : engines) {
    Run& run = runs.emplace_back();
    run.engine = choice.source.name;
    run.profile = choice.profile;
    Recording& recording = recordings.emplace_back(scenario);
    run.trajectory = recording.trajectory;
    jobs.emplace_back([&scenario, &choice, &recording] { return record(scenario, choice, recording); });
  }
  const std::vector<ProcessOutcome> outcomes = run_isolated(jobs, limits, parallel, done);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (outcomes[i].end == ProcessEnd::finished) {
      take_result(outcomes[i].payload, runs[i]);
    } else {
      runs[i].status = outcomes[i].end == ProcessEnd::timed_out ? RunStatus::timeout : RunStatus::crashed;
      runs[i].reason = outcomes[i].reason;
    }
  }
  return runs;
}

std::vector<EngineInfo> describe_engines(const std::vector<EngineSource>& engines,
                                         const ProcessLimits& limits, int parallel) {
  std::vector<Job> jobs;
  jobs.reserve(engines.size());
  for (const EngineSource& source : engines) {
    jobs.emplace_back([&source] {
      const EngineInfo info = source.open().info();
      Json json = {{"about", info.about},
                   {"version", info.version},
                   {"precision", info.precision},
                   {"limits", info.limits}};
      for (const Profile& profile : info.profiles) json["profiles"].push_back({profile.name, profile.about});
      for (const Switch& each : info.switches) json["switches"].push_back({each.name, each.meaning});
      for (const auto& [feature, reason] : info.cannot) {
        json["cannot"].push_back({static_cast<int>(feature), reason});
      }
      return json.dump();
    });
  }
  const std::vector<ProcessOutcome> outcomes = run_isolated(jobs, limits, parallel);
  std::vector<EngineInfo> infos;
  for (std::size_t i = 0; i < engines.size(); ++i) {
    EngineInfo& info = infos.emplace_back();
    info.name = engines[i].name;
    info.version = outcomes[i].reason;
    if (outcomes[i].end != ProcessEnd::finished) continue;
    const Json json = Json::parse(outcomes[i].payload);
    info.about = json.at("about");
    info.version = json.at("version");
    info.precision = json.at("precision");
    info.limits = json.at("limits").get<std::vector<std::string>>();
    for (const Json& profile : json.value("profiles", Json::array())) {
      info.profiles.push_back({profile.at(0), profile.at(1)});
    }
    for (const Json& row : json.value("switches", Json::array())) {
      info.switches.push_back({row.at(0), row.at(1)});
    }
    for (const Json& row : json.value("cannot", Json::array())) {
      info.cannot.emplace(static_cast<Feature>(row.at(0).get<int>()), row.at(1));
    }
  }
  return infos;
}

}  // namespace carom
