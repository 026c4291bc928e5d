#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace carom {

/// A scene file's text with an event appended. Everything before stays as it was, comments too, and numbers
/// are written so that they read back to the same doubles: the file gives the same bits as the lab.
///
/// @param event  the keys of an [[event]] and their values. What they mean is not checked here: parse_scene()
/// says what is wrong with the result. @throws InputError where a value has no form in TOML
std::string with_event(std::string toml, const nlohmann::json& event);

}  // namespace carom
