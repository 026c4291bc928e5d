#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study/study.h"
#include "trajectory/record.h"

namespace carom {

/// The numbers of steps that the interval between two frames is cut into, ascending: nine over three decades,
///   k_i = round(10^{3 i/8}), i = 0 … 8:  1, 2, 6, 13, 32, 75, 178, 422, 1000.
/// Whole fractions of the interval, so that every engine is seen at the same moments.
std::vector<std::int64_t> study_steps();

/// The one of them at which a setting is tried that has nothing to do with the step.
std::int64_t middle_step();

/// "velocity_iterations = 8"
std::string words_of(const Tuned& tuned);

/// What an engine answered when asked what can be studied about it.
struct Answer {
  StudyEngine engine;
  std::vector<Tuning> tunings;
};

/// Asks every engine, each in a process of its own. One that fails there is taken to have its step alone.
std::vector<Answer> ask_engines(const Scenario& scene, const std::vector<EngineChoice>& engines,
                                const ProcessLimits& limits, int parallel);

/// A point that is to be measured, with what to run for it.
struct PlannedPoint {
  StudyPoint point;
  EngineChoice choice;
};

/// Every point of a scene, coarse steps first, and at each step engine by engine, so that what is measured
/// one after the other is of different engines.
std::vector<PlannedPoint> plan_scene(const Scenario& scene, const std::vector<EngineChoice>& engines,
                                     const std::vector<Answer>& answers);

/// The scene with so many steps between two frames.
Scenario with_steps(const Scenario& scene, std::int64_t steps_per_frame);

}  // namespace carom
