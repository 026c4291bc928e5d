#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace carom {

/// JSON knows no infinity and no NaN; null stands for them and for what there is not.
inline nlohmann::ordered_json number_or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace carom
