#include "scenario/read.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "core/error.h"

namespace carom {

namespace {

/// The shortest digits that mean this double, still marked as no integer.
std::string real_number(double value) {
  const std::string digits = fmt::format("{}", value);
  return digits.find_first_not_of("-0123456789") == std::string::npos ? digits + ".0" : digits;
}

/// What stands in the file, as the reader of the error would write it.
std::string found(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (const auto* value = node.as_floating_point()) return real_number(value->get());
  if (const auto* array = node.as_array()) {
    if (array->empty()) return "[]";
    if (array->size() > 4) return fmt::format("an array of {}", array->size());
    std::vector<std::string> elements;
    for (const toml::node& element : *array) elements.push_back(found(element));
    return fmt::format("[ {} ]", fmt::join(elements, ", "));
  }
  std::ostringstream out;
  node.visit([&out](const auto& value) { out << value; });
  return out.str();
}

std::string finite_numbers(int length) {
  return fmt::format("an array of {} finite numbers", length);
}

std::string expected(const toml::node& node, std::string_view allowed) {
  return fmt::format("found {}, allowed: {}", found(node), allowed);
}

}  // namespace

const toml::node* Reader::find(std::string_view key, std::string allowed) {
  allowed_last_ = std::move(allowed);
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.push_back(key);
  return table_->get(key);
}

std::string Reader::path_of(std::string_view key) const {
  if (path_.empty() || key.empty()) return path_ + std::string(key);
  return fmt::format("{}.{}", path_, key);
}

void Reader::fail_at(const toml::node& node, std::string_view path, std::string_view problem) const {
  const auto& place = node.source().begin;
  throw InputError(fmt::format("{}:{}:{}: {}: {}", file_, place.line, place.column, path, problem));
}

void Reader::fail_value(std::string_view key, std::string_view allowed) const {
  const toml::node* node = table_->get(key);
  fail(key, node != nullptr ? expected(*node, allowed) : fmt::format("is missing, allowed: {}", allowed));
}

void Reader::fail(std::string_view key, std::string_view problem) const {
  const toml::node* node = table_->get(key);
  fail_at(node != nullptr ? *node : *table_, path_of(key), problem);
}

double Reader::number_in(const toml::node& node, std::string_view path, const Range& range) const {
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value || !range.contains(*value)) fail_at(node, path, expected(node, range.allowed));
  return *value;
}

Vec3 Reader::vector_in(const toml::node& node, std::string_view path, int length) const {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != static_cast<std::size_t>(length)) {
    fail_at(node, path, expected(node, finite_numbers(length)));
  }
  Vec3 vector = Vec3::Zero();
  for (int axis = 0; axis < length; ++axis) {
    vector[axis] = number_in((*array)[static_cast<std::size_t>(axis)], path, kFinite);
  }
  return vector;
}

std::optional<double> Reader::number(std::string_view key, const Range& range) {
  const toml::node* node = find(key, std::string(range.allowed));
  if (node == nullptr) return std::nullopt;
  return number_in(*node, path_of(key), range);
}

double Reader::number_or(std::string_view key, const Range& range, double otherwise) {
  return number(key, range).value_or(otherwise);
}

std::optional<std::int64_t> Reader::integer(std::string_view key, std::int64_t low, std::int64_t high) {
  const toml::node* node = find(key, fmt::format("an integer from {} to {}", low, high));
  if (node == nullptr) return std::nullopt;
  const auto value = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
  if (!value || *value < low || *value > high) {
    fail_at(*node, path_of(key), expected(*node, allowed_last_));
  }
  return value;
}

std::optional<bool> Reader::boolean(std::string_view key) {
  const toml::node* node = find(key, "true or false");
  if (node == nullptr) return std::nullopt;
  if (!node->is_boolean()) fail_at(*node, path_of(key), expected(*node, allowed_last_));
  return node->value<bool>();
}

std::optional<std::string> Reader::text(std::string_view key) {
  const toml::node* node = find(key, "a string");
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) fail_at(*node, path_of(key), expected(*node, allowed_last_));
  return node->value<std::string>();
}

std::optional<std::size_t> Reader::word(std::string_view key, const std::vector<std::string_view>& allowed) {
  const toml::node* node = find(key, fmt::format("\"{}\"", fmt::join(allowed, "\", \"")));
  if (node == nullptr) return std::nullopt;
  const auto value = node->is_string() ? node->value<std::string>() : std::nullopt;
  const auto match = value ? std::find(allowed.begin(), allowed.end(), *value) : allowed.end();
  if (match == allowed.end()) {
    fail_at(*node, path_of(key), expected(*node, allowed_last_));
  }
  return static_cast<std::size_t>(match - allowed.begin());
}

std::optional<std::vector<std::size_t>> Reader::words(std::string_view key,
                                                      const std::vector<std::string_view>& allowed) {
  const std::string choice = fmt::format("\"{}\"", fmt::join(allowed, "\", \""));
  const toml::node* node = find(key, fmt::format("\"all\", or an array of some of {}", choice));
  if (node == nullptr) return std::nullopt;
  std::vector<std::size_t> indices;
  if (node->value<std::string>() == "all") {
    for (std::size_t i = 0; i < allowed.size(); ++i) indices.push_back(i);
    return indices;
  }
  if (!node->is_array() || node->as_array()->empty()) {
    fail_at(*node, path_of(key), expected(*node, allowed_last_));
  }
  for (const toml::node& element : *node->as_array()) {
    const auto word = element.is_string() ? element.value<std::string>() : std::nullopt;
    const auto match = word ? std::find(allowed.begin(), allowed.end(), *word) : allowed.end();
    if (match == allowed.end()) fail_at(element, path_of(key), expected(element, choice));
    const auto index = static_cast<std::size_t>(match - allowed.begin());
    if (std::find(indices.begin(), indices.end(), index) != indices.end()) {
      fail_at(element, path_of(key), expected(element, "each of them once"));
    }
    indices.push_back(index);
  }
  return indices;
}

std::optional<Vec3> Reader::vector(std::string_view key, int dimension) {
  const toml::node* node = find(key, finite_numbers(dimension));
  if (node == nullptr) return std::nullopt;
  return vector_in(*node, path_of(key), dimension);
}

std::optional<Vec3> Reader::spin(std::string_view key, int dimension) {
  if (dimension == 3) return vector(key, dimension);
  const auto about_z = number(key, kFinite);
  if (!about_z) return std::nullopt;
  return Vec3(0.0, 0.0, *about_z);
}

std::optional<std::pair<double, double>> Reader::number_or_range(std::string_view key, const Range& range) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const std::string path = path_of(key);
  const toml::array* array = node->as_array();
  if (array == nullptr) {
    const double value = number_in(*node, path, range);
    return std::pair(value, value);
  }
  const std::string allowed = fmt::format("{}, or [low, high] of such with low <= high", range.allowed);
  if (array->size() != 2) fail_at(*node, path, expected(*node, allowed));
  const std::pair ends(number_in((*array)[0], path, range), number_in((*array)[1], path, range));
  if (ends.first > ends.second) fail_at(*node, path, expected(*node, allowed));
  return ends;
}

std::optional<Reader> Reader::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) fail_at(*node, path_of(key), expected(*node, "a table"));
  return Reader(*node->as_table(), file_, path_of(key));
}

std::vector<Reader> Reader::tables(std::string_view key) {
  const toml::node* node = find(key);
  std::vector<Reader> readers;
  if (node == nullptr) return readers;
  const std::string allowed = fmt::format("tables, each headed [[{}]]", path_of(key));
  if (!node->is_array()) fail_at(*node, path_of(key), expected(*node, allowed));
  for (const toml::node& element : *node->as_array()) {
    if (!element.is_table()) fail_at(element, path_of(key), expected(element, allowed));
    readers.emplace_back(*element.as_table(), file_, fmt::format("{}[{}]", path_of(key), readers.size()));
  }
  return readers;
}

std::vector<std::pair<std::string, Reader>> Reader::remaining_tables() {
  std::vector<std::pair<std::string, Reader>> readers;
  for (const auto& [key, node] : *table_) {
    if (std::find(asked_.begin(), asked_.end(), key.str()) != asked_.end() || !node.is_table()) continue;
    readers.emplace_back(std::string(key.str()), *table(key.str()));
  }
  return readers;
}

void Reader::finish() const {
  for (const auto& [key, node] : *table_) {
    if (std::find(asked_.begin(), asked_.end(), key.str()) != asked_.end()) continue;
    const auto& place = key.source().begin;
    throw InputError(fmt::format("{}:{}:{}: {}: unknown key, allowed: {}", file_, place.line, place.column,
                                 path_of(key.str()), fmt::join(asked_, ", ")));
  }
}

}  // namespace carom
