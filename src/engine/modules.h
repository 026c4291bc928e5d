#pragma once

#include <filesystem>
#include <string>

#include "engine/engine.h"

namespace carom {

/// Opens the engine module at `file` with its symbols kept to itself (RTLD_LOCAL), so that libraries which
/// share symbol names, such as Bullet in single and in double precision, can be open side by side. The module
/// stays open to the end of the process.
/// @throws MachineError where the file is not a loadable engine module, with the loader's reason.
Engine& open_engine_module(const std::filesystem::path& file);

}  // namespace carom
