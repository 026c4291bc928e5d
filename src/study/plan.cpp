#include "study/plan.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>

namespace carom {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kStepValues = 9;
constexpr double kDecades = 3.0;

Json json_of(const SettingValue& value) {
  return std::visit([](const auto& each) { return Json(each); }, value);
}

SettingValue value_of(const Json& json) {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number()) return json.get<double>();
  return json.get<std::string>();
}

/// The body of the process that asks.
std::string ask(const Scenario& scene, const EngineChoice& choice) {
  const Engine& engine = choice.source.open();
  Json json = {{"takes_steps", true}, {"claims", false}, {"tunings", Json::array()}};
  const auto* tunable = dynamic_cast<const Tunable*>(&engine);
  if (tunable != nullptr && unsupported_reason(engine, scene, choice.profile).empty()) {
    json["takes_steps"] = tunable->takes_steps(scene);
    json["claims"] = true;
    if (const ClaimedOrder order = tunable->claimed_order(scene)) json["claimed_order"] = *order;
    for (const Tuning& tuning : tunable->tunings(scene, choice.profile)) {
      Json row = {tuning.name, tuning.meaning, tuning.at_every_step, Json::array()};
      for (const SettingValue& value : tuning.values) row.back().push_back(json_of(value));
      json["tunings"].push_back(std::move(row));
    }
  }
  return json.dump();
}

Answer answer_from(const std::string& payload) {
  const Json json = Json::parse(payload);
  Answer answer;
  answer.engine.takes_steps = json.at("takes_steps");
  answer.engine.claims = json.at("claims");
  if (json.contains("claimed_order")) answer.engine.claimed_order = json.at("claimed_order").get<int>();
  for (const Json& row : json.at("tunings")) {
    Tuning tuning{row.at(0), row.at(1), {}, row.at(2)};
    for (const Json& value : row.at(3)) tuning.values.push_back(value_of(value));
    answer.tunings.push_back(std::move(tuning));
  }
  return answer;
}

PlannedPoint planned(const Scenario& scene, const EngineChoice& engine, std::int64_t steps,
                     std::optional<Tuned> tuned, bool everywhere) {
  PlannedPoint result;
  result.choice = engine;
  result.point.engine = engine_label(engine.source.name, engine.profile);
  result.point.setting = tuned ? words_of(*tuned) : std::string();
  result.point.everywhere = everywhere;
  result.point.steps_per_frame = steps;
  result.point.step_s = with_steps(scene, steps).step_s;
  result.choice.tuned = std::move(tuned);
  return result;
}

}  // namespace

std::vector<std::int64_t> study_steps() {
  std::vector<std::int64_t> steps;
  steps.reserve(kStepValues);
  for (int i = 0; i < kStepValues; ++i) {
    steps.push_back(std::llround(std::pow(10.0, kDecades * i / (kStepValues - 1))));
  }
  return steps;
}

std::int64_t middle_step() {
  return study_steps()[kStepValues / 2];
}

std::string words_of(const Tuned& tuned) {
  return std::visit([&](const auto& value) { return fmt::format("{} = {}", tuned.name, value); },
                    tuned.value);
}

Scenario with_steps(const Scenario& scene, std::int64_t steps_per_frame) {
  Scenario result = scene;
  result.step_s = scene.duration_s / static_cast<double>(scene.frames) / static_cast<double>(steps_per_frame);
  return result;
}

std::vector<Answer> ask_engines(const Scenario& scene, const std::vector<EngineChoice>& engines,
                                const ProcessLimits& limits, int parallel) {
  // At a step that every engine takes which takes the scene at all: coarse ones some refuse.
  const Scenario fine = with_steps(scene, study_steps().back());
  std::vector<Job> jobs;
  jobs.reserve(engines.size());
  for (const EngineChoice& engine : engines) {
    jobs.emplace_back([&fine, &engine] { return ask(fine, engine); });
  }
  const std::vector<ProcessOutcome> outcomes = run_isolated(jobs, limits, parallel);
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < engines.size(); ++i) {
    answers.push_back(outcomes[i].end == ProcessEnd::finished ? answer_from(outcomes[i].payload) : Answer());
    answers.back().engine.label = engine_label(engines[i].source.name, engines[i].profile);
  }
  return answers;
}

std::vector<PlannedPoint> plan_scene(const Scenario& scene, const std::vector<EngineChoice>& engines,
                                     const std::vector<Answer>& answers) {
  std::vector<PlannedPoint> plan;
  for (const std::int64_t steps : study_steps()) {
    for (std::size_t i = 0; i < engines.size(); ++i) {
      const Answer& answer = answers[i];
      const bool only = !answer.engine.takes_steps;
      if (only && steps != study_steps().front()) continue;
      plan.push_back(planned(scene, engines[i], steps, std::nullopt, true));
      for (const Tuning& tuning : answer.tunings) {
        const bool everywhere = tuning.at_every_step && !only;
        if (!everywhere && !only && steps != middle_step()) continue;
        for (const SettingValue& value : tuning.values) {
          plan.push_back(planned(scene, engines[i], steps, Tuned{tuning.name, value}, everywhere));
        }
      }
    }
  }
  return plan;
}

}  // namespace carom
