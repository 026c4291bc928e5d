#include "lab/requests.h"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "core/files.h"
#include "lab/toml_event.h"
#include "report/playback.h"
#include "scenario/cast.h"
#include "scenario/catalog.h"
#include "scenario/features.h"
#include "scenario/parse.h"
#include "trajectory/truth.h"

namespace carom {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The text of a key; nothing where there is no such key.
std::optional<std::string> text_of(const Json& body, const char* key) {
  const auto found = body.find(key);
  if (found == body.end() || found->is_null()) return std::nullopt;
  if (!found->is_string()) throw InputError(fmt::format("{}: found {}, allowed: a text", key, found->dump()));
  return found->get<std::string>();
}

/// The file of a scene. Only what the catalog lists is a scene: an id is compared and never made a path.
fs::path file_of(const LabSetup& setup, const std::string& id) {
  for (const fs::path& file : Catalog(setup.scenarios).all()) {
    if (fmt::format("{}/{}", file.parent_path().filename().string(), file.stem().string()) == id) return file;
  }
  throw InputError(fmt::format("no scene \"{}\"; allowed: an id that /api/modes lists", id));
}

/// A scene as it was asked for: its text, and by which name errors in it are told.
struct AskedScene {
  std::string toml;
  std::string id;
  std::string file;
};

AskedScene asked_scene(const LabSetup& setup, const Json& body) {
  const std::optional<std::string> toml = text_of(body, "toml");
  const std::optional<std::string> id = text_of(body, "id");
  if (toml) return {*toml, id.value_or("lab/scene"), "scene.toml"};
  if (!id) {
    throw InputError("allowed: toml, the text of a scene file, or id, one of those that /api/modes lists");
  }
  return {read_file(file_of(setup, *id)), *id, *id + ".toml"};
}

ScenarioPtr parsed(const LabSetup& setup, const AskedScene& asked) {
  auto scene = std::make_shared<Scenario>(
      *parse_scene(asked.toml, asked.file, {{}, {}, setup.engine_names, setup.limits.balls}));
  scene->id = asked.id;
  return scene;
}

/// What a page cannot hold. How many balls there may be, the reader is told.
void check_limits(const LabLimits& limits, const Scenario& scene) {
  const std::size_t balls = numbered_balls(scene);
  const auto frames = static_cast<std::size_t>(scene.frames) + 1;
  if (frames > limits.states / balls) {
    throw InputError(
        fmt::format("{}: {} balls in {} frames, allowed in the lab: at most {} of both together; "
                    "carom run takes them",
                    scene.file, balls, frames, limits.states));
  }
}

std::vector<std::string> asked_engines(const LabSetup& setup, const Json& body) {
  const auto found = body.find("engines");
  if (found == body.end()) return {"carom"};
  std::vector<std::string> engines;
  if (found->is_array()) {
    for (const Json& name : *found) {
      if (name.is_string()) engines.push_back(name.get<std::string>());
    }
  }
  if (engines.empty() || engines.size() != found->size() || engines.size() > setup.limits.engines) {
    throw InputError(fmt::format("engines: allowed: an array of 1 to {} names, name or name@profile",
                                 setup.limits.engines));
  }
  return engines;
}

std::string run(const LabSetup& setup, const Json& body) {
  const ScenarioPtr scene = parsed(setup, asked_scene(setup, body));
  check_limits(setup.limits, *scene);
  const std::vector<EngineChoice> engines =
      setup.choose(asked_engines(setup, body), text_of(body, "law").value_or(""));
  const ProcessLimits limits{setup.limits.run_seconds, setup.limits.memory_mib};
  std::optional<Truth> truth;
  if (body.value("truth", false)) truth = record_truth(*scene, setup.truths, limits);
  const std::vector<Run> runs = run_engines(*scene, engines, limits, setup.parallel);
  std::vector<const Run*> played;
  played.reserve(runs.size());
  for (const Run& each : runs) played.push_back(&each);
  return playback_json(*scene, played, truth ? &*truth : nullptr);
}

std::string modes(const LabSetup& setup) {
  Json course = Json::array();
  Json others = Json::array();
  for (const fs::path& file : Catalog(setup.scenarios).all()) {
    ScenarioPtr scene;
    try {
      scene = load_scene(file);
    } catch (const InputError&) {
      continue;  // somebody is writing it; the other modes are there all the same
    }
    Json& list = scene->id.starts_with("course/") ? course : others;
    list.push_back({{"id", scene->id},
                    {"title", scene->title},
                    {"about", scene->about},
                    {"dimension", scene->dimension}});
  }
  course.insert(course.end(), others.begin(), others.end());
  return dump(course);
}

std::string engines(const LabSetup& setup) {
  Json list = Json::array();
  const ProcessLimits limits{setup.limits.run_seconds, setup.limits.memory_mib};
  for (const EngineInfo& info : describe_engines(setup.engines, limits, setup.parallel)) {
    for (const Profile& profile : info.profiles) {
      Json json = {{"label", engine_label(info.name, profile.name)},
                   {"name", info.name},
                   {"about", info.about},
                   {"profile", profile.name},
                   {"profile_about", profile.about},
                   {"version", info.version},
                   {"precision", info.precision},
                   {"cannot", Json::object()}};
      for (const auto& [feature, reason] : info.cannot)
        json["cannot"][std::string(name_of(feature))] = reason;
      list.push_back(std::move(json));
    }
  }
  return dump(list);
}

std::string scene(const LabSetup& setup, const Json& body) {
  const std::optional<std::string> id = text_of(body, "id");
  if (!id) throw InputError("allowed: id, one of those that /api/modes lists");
  return dump({{"toml", read_file(file_of(setup, *id))}});
}

std::string toml(const LabSetup& setup, const Json& body) {
  AskedScene asked = asked_scene(setup, body);
  if (!body.contains("event"))
    throw InputError("event is missing, allowed: the keys and values of an [[event]]");
  asked.toml = with_event(std::move(asked.toml), nlohmann::json(body.at("event")));
  check_limits(setup.limits, *parsed(setup, asked));
  return dump({{"toml", asked.toml}});
}

std::string law(const LabSetup& setup, const Json& body) {
  const std::optional<std::string> text = text_of(body, "law");
  if (!text) throw InputError("allowed: law, the text of a law file");
  return setup.judge_law(*text);
}

std::string answer(const LabSetup& setup, std::string_view what, const std::string& text) {
  const Json body = text.empty() ? Json::object() : Json::parse(text);
  if (!body.is_object()) throw InputError("the body: allowed: a JSON object");
  if (what == "modes") return modes(setup);
  if (what == "engines") return engines(setup);
  if (what == "scene") return scene(setup, body);
  if (what == "run") return run(setup, body);
  if (what == "toml") return toml(setup, body);
  if (what == "law" && setup.judge_law) return law(setup, body);
  throw std::invalid_argument(fmt::format("nothing is known of {}", what));
}

}  // namespace

LabAnswer lab_error(int status, std::string_view message) {
  return {status, dump({{"error", message}})};
}

LabAnswer answer_lab(const LabSetup& setup, std::string_view what, const std::string& body) {
  try {
    return {200, answer(setup, what, body)};
  } catch (const InputError& error) {
    return lab_error(400, error.what());
  } catch (const Json::parse_error& error) {
    return lab_error(400, fmt::format("the body is not JSON: {}", error.what()));
  } catch (const Json::type_error& error) {
    return lab_error(400, fmt::format("the body: {}", error.what()));
  } catch (const std::invalid_argument& error) {
    return lab_error(404, error.what());
  } catch (const std::bad_alloc&) {
    return lab_error(400, "the scene takes more memory than a request in the lab may have");
  } catch (const std::exception& error) {
    return lab_error(500, error.what());
  }
}

}  // namespace carom
