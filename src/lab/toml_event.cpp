#include "lab/toml_event.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace carom {

namespace {

/// A bare key as it is, any other in quotes.
std::string toml_key(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return bare ? key : nlohmann::json(key).dump();
}

std::string toml_value(const nlohmann::json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_integer()) return fmt::format("{}", value.get<std::int64_t>());
  if (value.is_number()) return fmt::format("{}", value.get<double>());
  // JSON has no infinity, which is the mass of an immovable ball.
  if (value == "inf") return "inf";
  if (value.is_string()) return value.dump();  // TOML's escapes are JSON's
  std::string text;
  if (value.is_array()) {
    for (const nlohmann::json& element : value) text += (text.empty() ? "" : ", ") + toml_value(element);
    return "[" + text + "]";
  }
  if (!value.is_object()) throw InputError("event: found null, allowed: the keys and values of an [[event]]");
  for (const auto& [key, element] : value.items()) {
    text += fmt::format("{} {} = {}", text.empty() ? "" : ",", toml_key(key), toml_value(element));
  }
  return "{" + text + " }";
}

}  // namespace

std::string with_event(std::string toml, const nlohmann::json& event) {
  if (!event.is_object()) {
    throw InputError("event: allowed: an object with the keys and values of an [[event]]");
  }
  if (!toml.empty() && toml.back() != '\n') toml += '\n';
  toml += "\n[[event]]\n";
  // Time and ball first, as people write them.
  const auto write = [&](const std::string& key) {
    toml += toml_key(key) + " = " + toml_value(event[key]) + "\n";
  };
  for (const char* key : {"time", "ball"}) {
    if (event.contains(key)) write(key);
  }
  for (const auto& [key, value] : event.items()) {
    if (key != "time" && key != "ball") write(key);
  }
  return toml;
}

}  // namespace carom
