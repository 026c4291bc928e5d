#pragma once

#include <memory>

#include "engine/engine.h"

namespace carom {

/// What the hand-written engine is and can do.
EngineInfo carom_engine_info();

/// The hand-written engine.
std::unique_ptr<Engine> make_carom_engine();

}  // namespace carom
