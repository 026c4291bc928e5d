#include "report/page/wording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace carom::page {

namespace {

// Below this a value is a rounding error, and two digits say all there is to say about it.
constexpr double kSmall = 1e-3;

/// 1e-09 as 1e-9, 1e+05 as 1e5, and the typographer's minus in front.
std::string tidy(std::string text) {
  const std::size_t e = text.find('e');
  if (e != std::string::npos) {
    const std::string sign = text[e + 1] == '-' ? "-" : "";
    const std::size_t digit = std::min(text.find_first_not_of("+-0", e + 1), text.size());
    text = text.substr(0, e + 1) + sign + text.substr(digit);
  }
  if (!text.empty() && text[0] == '-') text.replace(0, 1, "−");
  return text;
}

std::string not_finite(double value) {
  if (std::isnan(value)) return "n/a";
  return value > 0.0 ? "∞" : "−∞";
}

}  // namespace

std::string number(double value) {
  if (!std::isfinite(value)) return not_finite(value);
  if (value == 0.0) return "0";  // without the sign that a zero can have
  return tidy(std::abs(value) < kSmall ? fmt::format("{:.2g}", value) : fmt::format("{:.3g}", value));
}

std::string number(const std::optional<double>& value) {
  return value ? number(*value) : "n/a";
}

std::string given(double value) {
  if (value == 0.0) return "0";
  return std::isfinite(value) ? tidy(fmt::format("{:.12g}", value)) : not_finite(value);
}

std::string given(const SettingValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "yes" : "no";
  if (const double* real = std::get_if<double>(&value)) return given(*real);
  return std::get<std::string>(value);
}

std::string coordinates(const Vec3& vector, int dimension) {
  std::string text = "(" + number(vector.x()) + ", " + number(vector.y());
  if (dimension == 3) text += ", " + number(vector.z());
  return text + ")";
}

std::string list_of(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
    text += words[i];
  }
  return text;
}

std::string sentence(std::string text) {
  if (text.empty()) return text;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (text.back() != '.') text += '.';
  return text;
}

std::string count_of(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string_view glyph_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "✓";
    case Verdict::fail:
      return "✗";
    case Verdict::shown:
      return "○";
    case Verdict::unsupported:
      return "–";
    case Verdict::error:
      return "!";
  }
  return "";
}

std::string title_of(Metric metric) {
  std::string title(name_of(metric));
  std::replace(title.begin(), title.end(), '_', ' ');
  return title;
}

std::string value_of(Metric metric, const std::optional<double>& value) {
  const bool length = metric == Metric::position || metric == Metric::position_rms;
  if (!value) return number(value);
  return number(value) + (length ? " m" : metric == Metric::symmetry ? " radii" : "");
}

std::string power_of_ten(int exponent) {
  // 1, 10 and 100 are shorter than their powers.
  if (exponent >= 0 && exponent <= 2) return given(std::pow(10.0, exponent));
  return fmt::format("1e{}", exponent);
}

std::string describe(const std::optional<Divergence>& divergence) {
  if (!divergence) return "none";
  std::vector<std::string> balls;
  for (const std::size_t ball : divergence->balls) balls.push_back(std::to_string(ball));
  std::string text = fmt::format("{} s: {}", number(divergence->time_s), title_of(divergence->metric));
  if (!balls.empty()) text += fmt::format(" of {} {}", balls.size() == 1 ? "ball" : "balls", list_of(balls));
  return text;
}

std::string anchor_of(const Scenario& scenario) {
  std::string anchor = "scene-" + scenario.id;
  for (char& letter : anchor) {
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0) letter = '-';
  }
  return anchor;
}

}  // namespace carom::page
