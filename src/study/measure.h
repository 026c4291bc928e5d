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
};

/// Measures one scene of a study, in the scene that is handed in, whose points may be there from a study that
/// was stopped: what they tell already is not measured again.
///
/// First the errors, `parallel` runs at a time, coarse steps before fine ones; a run that is foreseen to take
/// longer than the limit, by what the last coarser step took, is not started. Then the times, one run
/// at a time whatever `parallel` is, so that none disturbs another: in rounds over all points, so that what
/// disturbs a machine for a while hits all engines alike.
void measure_scene(const ScenarioPtr& scene, const std::vector<EngineChoice>& engines,
                   const std::vector<std::shared_ptr<const TruthSource>>& sources, const StudyLimits& limits,
                   int parallel, const StudyWatch& watch, StudyScene& into);

/// How many timed runs a setting gets whose run takes this long: fewer of a long one, which is hardly
/// disturbed.
int repeats_for(double cpu_s, int asked);

}  // namespace carom
