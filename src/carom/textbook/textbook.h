#pragma once

#include <memory>
#include <string_view>

#include "engine/engine.h"

namespace carom {

inline constexpr std::string_view kTextbookName = "carom:textbook";

/// The course program (program.h) as an engine. An update lasts a step of the scene, or, in the profile
/// "default", the time between two recorded frames, as the program had it: there it drew after each update.
std::unique_ptr<Engine> make_textbook_engine();

}  // namespace carom
