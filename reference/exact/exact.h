#pragma once

#include <memory>

#include "engine/truth_source.h"

namespace carom {

/// Hard balls in arithmetic of as many digits as it takes: uniform gravity, walls, restitution and friction
/// at impacts, in the plane and in space. It shares no code with any engine, nor with the closed forms.
std::unique_ptr<TruthSource> make_exact_truth();

}  // namespace carom
