#include "study/study_json.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"

namespace carom {

namespace {

// Keys in the order in which people read them.
using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "carom study 2";
constexpr std::array kStatuses = {RunStatus::ok, RunStatus::unsupported, RunStatus::crashed,
                                  RunStatus::timeout, RunStatus::invalid};

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

template <class Value>
std::optional<Value> optional_of(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? std::nullopt : std::optional(value.get<Value>());
}

/// Infinity and NaN, which JSON does not know, count as what cannot be told.
Json number_or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json status_json(const std::optional<RunStatus>& status) {
  return status ? Json(name_of(*status)) : Json(nullptr);
}

std::optional<RunStatus> status_of(const Json& json) {
  if (json.is_null()) return std::nullopt;
  const std::string name = json;
  for (const RunStatus status : kStatuses) {
    if (name == name_of(status)) return status;
  }
  throw InputError(fmt::format("no status \"{}\"", name));
}

Json json_of(const StudyPoint& point) {
  const StudyErrors& errors = point.errors;
  return {{"engine", point.engine},
          {"setting", point.setting},
          {"everywhere", point.everywhere},
          {"steps_per_frame", point.steps_per_frame},
          {"step", point.step_s},
          {"version", point.version},
          {"precision", point.precision},
          {"status", status_json(point.status)},
          {"reason", point.reason},
          {"position", number_or_null(errors.position_m)},
          {"final_position", number_or_null(errors.final_position_m)},
          {"energy", number_or_null(errors.energy)},
          {"momentum", number_or_null(errors.momentum)},
          {"angular_momentum", number_or_null(errors.angular_momentum)},
          {"impact_time", number_or_null(errors.impact_time_s)},
          {"rounding", number_or_null(point.rounding_m)},
          {"steps", point.steps},
          {"impacts", point.impacts},
          {"recorded_cpu_seconds", point.recorded_cpu_s},
          {"cpu_seconds", point.cpu_s},
          {"untimed", point.untimed}};
}

StudyPoint point_from(const Json& json) {
  StudyPoint point;
  point.engine = json.at("engine");
  point.setting = json.at("setting");
  point.everywhere = json.at("everywhere");
  point.steps_per_frame = json.at("steps_per_frame");
  point.step_s = json.at("step");
  point.version = json.at("version");
  point.precision = json.at("precision");
  point.status = status_of(json.at("status"));
  point.reason = json.at("reason");
  point.errors = {optional_of<double>(json, "position"),         optional_of<double>(json, "final_position"),
                  optional_of<double>(json, "energy"),           optional_of<double>(json, "momentum"),
                  optional_of<double>(json, "angular_momentum"), optional_of<double>(json, "impact_time")};
  point.rounding_m = optional_of<double>(json, "rounding").value_or(0.0);
  point.steps = json.at("steps");
  point.impacts = json.at("impacts");
  point.recorded_cpu_s = json.at("recorded_cpu_seconds");
  point.cpu_s = json.at("cpu_seconds").get<std::vector<double>>();
  point.untimed = json.at("untimed");
  return point;
}

Json json_of(const StudyEngine& engine) {
  return {{"engine", engine.label},
          {"takes_steps", engine.takes_steps},
          {"claims", engine.claims},
          {"claimed_order", or_null(engine.claimed_order)}};
}

StudyEngine engine_from(const Json& json) {
  return {json.at("engine"), json.at("takes_steps"), json.at("claims"),
          optional_of<int>(json, "claimed_order")};
}

Json json_of(const StudyScene& scene) {
  Json json = {{"id", scene.id},
               {"title", scene.title},
               {"sha256", scene.sha256},
               {"seed", or_null(scene.seed)},
               {"dimension", scene.dimension},
               {"balls", scene.balls},
               {"duration", scene.duration_s},
               {"frames", scene.frames},
               {"smallest_radius", scene.smallest_radius_m},
               {"reach", scene.reach_m},
               {"truth",
                {{"kind", scene.truth},
                 {"reason", scene.no_truth},
                 {"uncertainty", scene.uncertainty_m},
                 {"horizon", or_null(scene.horizon_s)}}},
               {"engines", Json::array()},
               {"points", Json::array()}};
  for (const StudyEngine& engine : scene.engines) json["engines"].push_back(json_of(engine));
  for (const StudyPoint& point : scene.points) json["points"].push_back(json_of(point));
  return json;
}

StudyScene scene_from(const Json& json) {
  StudyScene scene;
  scene.id = json.at("id");
  scene.title = json.at("title");
  scene.sha256 = json.at("sha256");
  scene.seed = optional_of<std::uint64_t>(json, "seed");
  scene.dimension = json.at("dimension");
  scene.balls = json.at("balls");
  scene.duration_s = json.at("duration");
  scene.frames = json.at("frames");
  scene.smallest_radius_m = json.at("smallest_radius");
  scene.reach_m = json.at("reach");
  const Json& truth = json.at("truth");
  scene.truth = truth.at("kind");
  scene.no_truth = truth.at("reason");
  scene.uncertainty_m = truth.at("uncertainty");
  scene.horizon_s = optional_of<double>(truth, "horizon");
  for (const Json& engine : json.at("engines")) scene.engines.push_back(engine_from(engine));
  for (const Json& point : json.at("points")) scene.points.push_back(point_from(point));
  return scene;
}

Json json_of(const StudyGrowth& growth) {
  Json json = {{"dimension", growth.dimension},
               {"packing", growth.packing},
               {"engine", growth.engine},
               {"points", Json::array()}};
  for (const GrowthPoint& point : growth.points) {
    json["points"].push_back({{"balls", point.balls},
                              {"status", status_json(point.status)},
                              {"reason", point.reason},
                              {"steps", point.steps},
                              {"impacts", point.impacts},
                              {"cpu_seconds", point.cpu_s}});
  }
  return json;
}

StudyGrowth growth_from(const Json& json) {
  StudyGrowth growth{json.at("dimension"), json.at("packing"), json.at("engine"), {}};
  for (const Json& row : json.at("points")) {
    growth.points.push_back({row.at("balls"), status_of(row.at("status")), row.at("reason"), row.at("steps"),
                             row.at("impacts"), row.at("cpu_seconds").get<std::vector<double>>()});
  }
  return growth;
}

Study study_from(const Json& json) {
  Study study;
  study.version = json.at("carom");
  const Json& machine = json.at("machine");
  study.machine = {machine.at("cpu"), machine.at("cores"), machine.at("compiler"), machine.at("build"),
                   machine.at("flags")};
  study.own = json.at("under_test");
  const Json& limits = json.at("limits");
  study.limits = {limits.at("timeout"), limits.at("memory"), limits.at("repeats"), limits.at("budget")};
  for (const Json& scene : json.at("scenes")) study.scenes.push_back(scene_from(scene));
  for (const Json& growth : json.at("growths")) study.growths.push_back(growth_from(growth));
  return study;
}

}  // namespace

std::string study_json(const Study& study) {
  const Machine& machine = study.machine;
  Json json = {{"format", kFormat},
               {"carom", study.version},
               {"machine",
                {{"cpu", machine.cpu},
                 {"cores", machine.cores},
                 {"compiler", machine.compiler},
                 {"build", machine.build},
                 {"flags", machine.flags}}},
               {"under_test", study.own},
               {"limits",
                {{"timeout", study.limits.timeout_s},
                 {"memory", study.limits.memory_mib},
                 {"repeats", study.limits.repeats},
                 {"budget", study.limits.budget_s}}},
               {"scenes", Json::array()},
               {"growths", Json::array()}};
  for (const StudyScene& scene : study.scenes) json["scenes"].push_back(json_of(scene));
  for (const StudyGrowth& growth : study.growths) json["growths"].push_back(json_of(growth));
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Study parse_study(std::string_view text, const std::string& file) {
  try {
    const Json json = Json::parse(text);
    if (!json.is_object() || json.value("format", "") != kFormat) {
      throw InputError(fmt::format("not a study; allowed: a file that carom study has written"));
    }
    return study_from(json);
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: not a study: {}", file, error.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
}

}  // namespace carom
