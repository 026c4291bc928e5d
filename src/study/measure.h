#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/truth_source.h"
#include "study/study.h"
#include "trajectory/record.h"

namespace carom {

/// Who hears how a study goes: what is under way, and that the study has changed so that it may be kept.
struct StudyWatch {
  /// So many more runs than were known before are to be done.
  std::function<void(std::size_t runs)> more = [](std::size_t) {};
  std::function<void(const std::string& what)> done = [](const std::string&) {};
  std::function<void()> changed = [] {};
  /// Whether to stop before the next run, with what there is.
  std::function<bool()> stopped = [] { return false; };
};

/// Measures one scene of a study, in the scene that is handed in, whose points may be there from a study that
/// was stopped: what they tell already is not measured again.
///
/// First the errors, `parallel` runs at a time, coarse steps before fine ones; then the times, one run at a
/// time whatever `parallel` is, so that none disturbs another: in rounds over all points, so that what
/// disturbs a machine for a while hits all engines alike.
///
/// What a run will take is foreseen by the last coarser step. One that is foreseen to take longer than the
/// limit is not started; nor is one for which, with its timing, too little of the scene's budget is left,
/// cheap runs first, so that what ends is the finest steps of the slowest engines. Rounds of timing after the
/// first end with the budget. All of that stands among the points with its reason.
void measure_scene(const ScenarioPtr& scene, const std::vector<EngineChoice>& engines,
                   const std::vector<std::shared_ptr<const TruthSource>>& sources, const StudyLimits& limits,
                   int parallel, const StudyWatch& watch, StudyScene& into);

}  // namespace carom
