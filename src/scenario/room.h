#pragma once

#include <optional>
#include <string>

#include "scenario/scenario.h"

namespace carom {

/// What in the scene contradicts itself: a movable ball that stands between two parallel walls, or a wall and
/// a slab, that are nearer to each other than its diameter, so that it overlaps one of them wherever it goes.
/// Nothing where there is no such ball.
///
/// Decides this alone. A ball may also be caught by several walls that are not parallel, or by immovable
/// balls; whether it can slip out then depends on all that is around it, and is left to the engines: who
/// finds no way to part what overlaps says so.
std::optional<std::string> lack_of_room(const Scenario& scene);

}  // namespace carom
