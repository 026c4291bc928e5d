#include "report/json.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <variant>

#include "comparison/conserved.h"
#include "comparison/metrics/brought.h"
#include "report/json_number.h"

namespace carom {

namespace {

// Keys in the order in which people read them.
using Json = nlohmann::ordered_json;

Json vector(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json impact(const TrueImpact& impact) {
  return {
      {"time", impact.time_s}, {"ball", impact.ball}, {impact.wall ? "wall" : "other_ball", impact.partner}};
}

Json judgement(const std::optional<Judgement>& judgement) {
  if (!judgement) return nullptr;
  return {{"verdict", name_of(judgement->accuracy)},
          {"beyond_rounding_from", number_or_null(judgement->beyond_rounding_s)}};
}

Json truth_json(const SceneComparison& comparison) {
  const Truth& truth = comparison.truth;
  const bool known = truth.known();
  Json json = {{"kind", truth.kind},
               {"reason", truth.reason},
               {"uncertainty", known ? Json(truth.uncertainty_m) : Json(nullptr)},
               {"horizon", number_or_null(truth.horizon_s)}};
  if (!known) return json;
  const Solution& solution = truth.solution;
  json["known_until"] = number_or_null(solution.known_until_s);
  json["limit"] = solution.limit;
  json["digits"] = solution.digits > 0 ? Json(solution.digits) : Json(nullptr);
  json["impacts"] = solution.impact_count;
  json["ties"] = solution.ties.size();
  json["growth_rate"] = number_or_null(comparison.predictability.growth_rate_per_s);
  json["predictable_until"] = number_or_null(comparison.predictability.horizon_s);
  json["cpu_seconds"] = truth.cpu_seconds;
  return json;
}

Json divergence(const std::optional<Divergence>& first) {
  if (!first) return nullptr;
  Json json = {{"time", first->time_s}, {"balls", first->balls}, {"metric", name_of(first->metric)}};
  json["cause"] = first->cause ? impact(*first->cause) : Json(nullptr);
  return json;
}

Json metrics(const RunComparison& result) {
  Json json = Json::object();
  for (std::size_t i = 0; i < kMetricNames.size(); ++i) {
    const auto metric = static_cast<Metric>(i);
    const std::optional<double> value = result.metrics[metric];
    // A count is written as one.
    json[kMetricNames[i]] =
        metric == Metric::escaped && value ? Json(static_cast<std::int64_t>(*value)) : number_or_null(value);
  }
  return json;
}

Json symmetries(const RunComparison& result) {
  Json json = Json::array();
  for (const SymmetryResult& check : result.symmetries.checks) {
    json.push_back({{"check", name_of(check.symmetry)},
                    {"verdict", name_of(check.verdict)},
                    {"reason", check.reason},
                    {"position_radii", number_or_null(check.position_radii)},
                    {"energy", number_or_null(check.energy)},
                    {"floor_radii", number_or_null(result.symmetries.floor_radii)}});
  }
  return json;
}

Json energy_by_cause(const std::optional<EnergySplit>& split) {
  if (!split) return nullptr;
  return {{"flight", number_or_null(split->flight_J)},
          {"ball_impacts", number_or_null(split->ball_impacts_J)},
          {"wall_impacts", number_or_null(split->wall_impacts_J)},
          {"friction", number_or_null(split->friction_J)},
          {"position_correction", number_or_null(split->correction_J)},
          {"events", number_or_null(split->events_J)}};
}

/// What each event of the scene did in this run.
Json interferences(const Scenario& scene, const Run& run) {
  Json json = Json::array();
  const Reference reference(scene);
  for (const Interference& each : run.interferences) {
    const Conserved brought = brought_by(reference, each);
    Json balls = Json::array();
    for (const BallChange& change : each.changes) balls.push_back(change.ball);
    json.push_back({{"time", each.time_s},
                    {"balls", std::move(balls)},
                    {"energy", number_or_null(brought.energy_J)},
                    {"momentum", vector(brought.momentum_Ns)},
                    {"angular_momentum", vector(brought.angular_momentum_Nms)},
                    {"overlap", number_or_null(each.overlap_radii)}});
  }
  return json;
}

Json gates(const RunComparison& result) {
  Json json = Json::array();
  for (const GateResult& gate : result.gates) {
    json.push_back({{"metric", name_of(gate.metric)},
                    {"limit", gate.limit},
                    {"value", number_or_null(gate.value)},
                    {"holds", gate.holds},
                    {"from", gate.baseline ? "baseline" : "scene"}});
    if (gate.baseline) json.back()["baseline"] = *gate.baseline;
  }
  return json;
}

Json not_asked(const std::vector<NotAsked>& left_out) {
  Json json = Json::object();
  for (const NotAsked& each : left_out) json[std::string(name_of(each.kind))] = each.reason;
  return json;
}

Json statistics(const std::optional<SceneStatistics>& asked) {
  if (!asked) return nullptr;
  return {{"reason", asked->reason},
          {"warm_up", asked->warm_up_s},
          {"collisions_per_ball", asked->collisions_per_ball},
          {"temperature", asked->temperature_J},
          {"not_asked", not_asked(asked->not_asked)}};
}

Json statistics(const std::optional<RunStatistics>& measured) {
  if (!measured) return nullptr;
  Json json = Json::object();
  for (const Statistic& each : measured->all) {
    json[std::string(name_of(each.kind))] = {
        {"value", number_or_null(each.value)},         {"expected", number_or_null(each.expected)},
        {"allowance", number_or_null(each.allowance)}, {"deviations", number_or_null(each.deviations)},
        {"as_expected", each.as_expected()},           {"detail", each.detail}};
  }
  json["not_asked"] = not_asked(measured->not_asked);
  return json;
}

Json final_states(const Scenario& scene, const Trajectory& trajectory, bool all_balls) {
  Json json = Json::array();
  const auto balls = trajectory.frame(trajectory.frames() - 1);
  const std::size_t listed = all_balls ? balls.size() : std::min(balls.size(), kListedBalls);
  Cast cast(scene);
  cast.to_frame(scene.frames);
  for (std::size_t i = 0; i < listed; ++i) {
    if (!cast[i]) {
      json.push_back(nullptr);  // gone; the others keep their places, which are their numbers
      continue;
    }
    // Key by key: a list in braces is copied twice before it is an object, and there are many.
    Json& ball = json.emplace_back(Json::object());
    ball["mass"] = number_or_null(cast[i]->mass);
    ball["radius"] = cast[i]->radius;
    ball["position"] = vector(balls[i].position);
    ball["velocity"] = vector(balls[i].velocity);
    ball["spin"] = vector(balls[i].spin);
  }
  return json;
}

Json settings(const Settings& settings) {
  Json json = Json::object();
  for (const auto& [name, value] : settings) {
    std::visit([&json, &key = name](const auto& v) { json[key] = v; }, value);
  }
  return json;
}

Json run_json(const Scenario& scene, const RunComparison& result, bool all_balls) {
  const Run& run = result.run;
  const bool ok = run.status == RunStatus::ok;
  return {
      {"engine", run.engine},
      {"profile", run.profile},
      {"version", run.version},
      {"precision", run.precision},
      {"settings", settings(run.settings)},
      {"status", name_of(run.status)},
      {"reason", run.reason},
      {"cpu_seconds", ok ? Json(run.cpu_seconds) : Json(nullptr)},
      {"steps", ok ? Json(run.steps) : Json(nullptr)},
      {"collisions", ok ? Json(run.trajectory.tally(run.trajectory.frames() - 1).impacts) : Json(nullptr)},
      {"under_test", result.under_test},
      {"metrics", metrics(result)},
      {"accuracy", judgement(result.judgement)},
      {"first_divergence", divergence(result.first_divergence)},
      {"symmetries", symmetries(result)},
      {"statistics", statistics(result.statistics)},
      {"energy_by_cause", energy_by_cause(result.energy_split)},
      {"events", interferences(scene, run)},
      {"gates", gates(result)},
      {"verdict", name_of(result.verdict)},
      {"final", ok ? final_states(scene, run.trajectory, all_balls) : Json::array()}};
}

Json pair_json(const SceneComparison& scene, const PairComparison& pair) {
  return {{"a", scene.runs[pair.a].run.label()},
          {"b", scene.runs[pair.b].run.label()},
          {"position", pair.position_m},
          {"position_rms", pair.position_rms_m},
          {"energy", number_or_null(pair.energy)},
          {"momentum", number_or_null(pair.momentum)},
          {"angular_momentum", number_or_null(pair.angular_momentum)},
          {"first_divergence", divergence(pair.first_divergence)}};
}

Json baseline_json(const BaselineFindings& baseline) {
  Json json = {{"file", baseline.file},
               {"factor", baseline.factor},
               {"compared", baseline.compared},
               {"not_compared", Json::array()},
               {"better", Json::array()}};
  for (const BaselineFindings::Group& group : baseline.not_compared) {
    json["not_compared"].push_back({{"reason", group.reason}, {"what", group.what}});
  }
  for (const BaselineFindings::Better& better : baseline.better) {
    json["better"].push_back({{"scene", better.scene},
                              {"engine", better.engine},
                              {"metric", name_of(better.metric)},
                              {"value", better.value},
                              {"baseline", better.baseline}});
  }
  return json;
}

Json scene_json(const SceneComparison& comparison, bool all_balls) {
  const Scenario& scene = *comparison.scene;
  Json json = {{"id", scene.id},
               {"title", scene.title},
               {"sha256", scene.sha256},
               {"dimension", scene.dimension},
               {"duration", scene.duration_s},
               {"step", scene.step_s},
               {"frames", scene.frames},
               {"balls", scene.balls.size()},
               {"effects", Json::array()},
               {"notes", scene.notes}};
  for (const Feature feature : required_features(scene)) json["effects"].push_back(name_of(feature));
  json["truth"] = truth_json(comparison);
  json["statistics"] = statistics(comparison.statistics);
  json["runs"] = Json::array();
  for (const RunComparison& run : comparison.runs) json["runs"].push_back(run_json(scene, run, all_balls));
  json["pairs"] = Json::array();
  for (const PairComparison& pair : comparison.pairs) json["pairs"].push_back(pair_json(comparison, pair));
  return json;
}

Json coefficient_json(const CoefficientPanel& panel) {
  Json json = {{"coefficient", panel.coefficient == Coefficient::restitution ? "restitution" : "friction"},
               {"on", panel.wall ? "wall" : "ball"},
               {"nominal", panel.nominal},
               {"speeds_mps", panel.speeds_mps},
               {"delivered", Json::object()}};
  for (const CoefficientCurve& curve : panel.curves) {
    Json values = Json::array();
    for (const std::optional<Delivered>& got : curve.values) {
      values.push_back(got ? Json{{"value", number_or_null(got->value)},
                                  {"lowest", number_or_null(got->lowest)},
                                  {"highest", number_or_null(got->highest)}}
                           : Json(nullptr));
    }
    json["delivered"][curve.label] = std::move(values);
  }
  return json;
}

}  // namespace

std::string results_json(const Results& results, bool all_balls) {
  Json json = {{"carom", results.version},
               {"machine",
                {{"cpu", results.machine.cpu},
                 {"cores", results.machine.cores},
                 {"compiler", results.machine.compiler},
                 {"build", results.machine.build}}},
               {"not_built", Json::array()},
               {"scenes", Json::array()}};
  for (const MissingEngine& engine : results.missing) {
    json["not_built"].push_back({{"engine", engine.name}, {"package", engine.package}});
  }
  if (results.baseline) json["baseline"] = baseline_json(*results.baseline);
  for (const SceneComparison& scene : results.scenes) json["scenes"].push_back(scene_json(scene, all_balls));
  if (!results.coefficients.empty()) {
    json["coefficients"] = Json::array();
    for (const CoefficientPanel& panel : results.coefficients) {
      json["coefficients"].push_back(coefficient_json(panel));
    }
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace carom
