#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "comparison/comparison.h"

namespace carom::page {

// How the page writes numbers and names for people.

/// A measured value with the digits that matter: 0.43, −1.2e-7. @return "n/a" for none, "∞" for infinity
std::string number(double value);
std::string number(const std::optional<double>& value);

/// A value that someone chose, with every digit: 0.004, 1e-9.
std::string given(double value);
std::string given(const SettingValue& value);

/// 10 to this power, as it is written at an axis of powers: 1e-4, 1, 10, 1e3.
std::string power_of_ten(int exponent);

/// (1, 2) or (1, 2, 3), by the dimension of the scene.
std::string coordinates(const Vec3& vector, int dimension);

/// "a, b and c"
std::string list_of(const std::vector<std::string>& words);

/// With a capital letter in front and a full stop behind.
std::string sentence(std::string text);

/// "1 scene", "2 scenes"
std::string count_of(std::size_t count, const std::string& what);

/// A shape for each verdict, so that colour is never the only sign.
std::string_view glyph_of(Verdict verdict);

/// "angular momentum"
std::string title_of(Metric metric);

/// The value with the metric's unit.
std::string value_of(Metric metric, const std::optional<double>& value);

/// "0.5 s: position of balls 0 and 1"
std::string describe(const std::optional<Divergence>& divergence);

/// The scene's name in this page's addresses.
std::string anchor_of(const Scenario& scenario);

}  // namespace carom::page
