#pragma once

#include <memory>

#include "engine/engine.h"
#include "engine/truth_source.h"

namespace carom {

/// The engine "closed-form": exact solutions, for scenes that have one. It shares no code with any engine
/// that it is the truth for. Its simulations jump to the time asked for.
std::unique_ptr<Engine> make_closed_form_engine();

/// The same solutions as a source of truths.
std::unique_ptr<TruthSource> make_closed_form_truth();

}  // namespace carom
