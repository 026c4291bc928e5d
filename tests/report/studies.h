#pragma once

#include <cstdint>
#include <string>

#include "study/study.h"

namespace carom::test {

inline StudyPoint study_point(const std::string& engine, const std::string& setting, std::int64_t steps,
                              double error_m, double cpu_s) {
  StudyPoint result;
  result.engine = engine;
  result.setting = setting;
  result.steps_per_frame = steps;
  result.step_s = 0.1 / static_cast<double>(steps);
  result.status = RunStatus::ok;
  result.errors.position_m = error_m;
  result.steps = 10 * steps;
  result.impacts = 3;
  result.cpu_s = {cpu_s, cpu_s, cpu_s};
  return result;
}

/// One scene: an engine that is exact in 2 µs, a peer of order 1 whose coarsest run is faster, and a setting
/// of it that fails.
inline Study some_study() {
  Study study;
  study.version = "0.1.0";
  study.machine = {"a CPU", 2, "a compiler", "Release", "-O3"};
  study.own = "carom";
  StudyScene scene;
  scene.id = "impact/some";
  scene.title = "Some <impact>";
  scene.balls = 2;
  scene.truth = "exact";
  scene.uncertainty_m = 1e-15;
  scene.smallest_radius_m = 0.1;
  scene.reach_m = 1.0;
  scene.engines = {{"carom:event", false, true, std::nullopt}, {"peer", true, true, 1}};
  scene.points.push_back(study_point("carom:event", "", 1, 0.0, 2e-6));
  for (const std::int64_t steps : {1, 10, 100, 1000}) {
    const auto count = static_cast<double>(steps);
    scene.points.push_back(study_point("peer", "", steps, 1e-3 / count, 1e-6 * count));
  }
  StudyPoint failed = study_point("peer", "velocity_iterations = 1", 1, 0.0, 0.0);
  failed.status = RunStatus::crashed;
  failed.reason = "ended by a \"signal\", early";
  failed.errors = {};
  failed.cpu_s.clear();
  scene.points.push_back(failed);
  study.scenes.push_back(scene);
  return study;
}

}  // namespace carom::test
