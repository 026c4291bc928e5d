#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/vec.h"

namespace carom {

/// The numbers a key allows, and how people are told.
struct Range {
  double low = 0.0;
  double high = 0.0;
  bool low_open = false;
  bool high_open = false;
  std::string_view allowed;

  bool contains(double x) const {
    return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
  }
};

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
// The ends that are infinite are open, so "finite" needs no rule of its own.
inline constexpr Range kFinite{-kInfinity, kInfinity, true, true, "a finite number"};
inline constexpr Range kPositive{0.0, kInfinity, true, true, "a finite number > 0"};
inline constexpr Range kPositiveOrInfinite{0.0, kInfinity, true, false, "a number > 0, or inf"};
inline constexpr Range kNotNegative{0.0, kInfinity, false, true, "a finite number >= 0"};
inline constexpr Range kUnitInterval{0.0, 1.0, false, false, "a number in [0, 1]"};
inline constexpr Range kOpenUnitInterval{0.0, 1.0, true, true, "a number in (0, 1)"};
inline constexpr Range kPositiveToOne{0.0, 1.0, true, false, "a number in (0, 1]"};
inline constexpr Range kMinusOneToOne{-1.0, 1.0, false, false, "a number in [-1, 1]"};

/// Reads one table of a scenario file key by key. Remembers which keys were asked for, so that finish() can
/// name a key that nobody knows. Every error is an InputError "file:line:column: key: found …, allowed: …".
class Reader {
 public:
  Reader(const toml::table& table, std::string_view file, std::string path)
      : table_(&table), file_(file), path_(std::move(path)) {}

  bool has(std::string_view key) { return find(key) != nullptr; }

  std::optional<double> number(std::string_view key, const Range& range);
  double number_or(std::string_view key, const Range& range, double otherwise);
  std::optional<std::int64_t> integer(std::string_view key, std::int64_t low, std::int64_t high);
  std::optional<bool> boolean(std::string_view key);
  std::optional<std::string> text(std::string_view key);
  /// One of a few words, as its index.
  std::optional<std::size_t> word(std::string_view key, const std::vector<std::string_view>& allowed);
  /// Several of a few words, each once, as their indices; "all" stands for all of them.
  std::optional<std::vector<std::size_t>> words(std::string_view key,
                                                const std::vector<std::string_view>& allowed);
  /// A vector of the scene's dimension; z = 0 in dimension 2.
  std::optional<Vec3> vector(std::string_view key, int dimension);
  /// A number about z in dimension 2, a vector in dimension 3.
  std::optional<Vec3> spin(std::string_view key, int dimension);
  /// One number, or [low, high].
  std::optional<std::pair<double, double>> number_or_range(std::string_view key, const Range& range);

  std::optional<Reader> table(std::string_view key);
  std::vector<Reader> tables(std::string_view key);
  /// Every key of this table with its sub-table; all of them must be tables. For names chosen by the user.
  std::vector<std::pair<std::string, Reader>> remaining_tables();

  /// The value just read from `key`. @throws InputError where the file has none.
  template <class T>
  T required(std::string_view key, std::optional<T> value) const {
    if (!value) fail(key, "is missing, allowed: " + allowed_last_);
    return *std::move(value);
  }

  /// @throws InputError where the table has a key that was never asked for.
  void finish() const;

  /// @throws InputError at the key's place, or at the table's where the key is absent or empty.
  [[noreturn]] void fail(std::string_view key, std::string_view problem) const;

  /// The same, saying what was found at the key.
  [[noreturn]] void fail_value(std::string_view key, std::string_view allowed) const;

  const std::string& path() const { return path_; }

 private:
  /// The key's node; remembers that it was asked for, and what it allows.
  const toml::node* find(std::string_view key, std::string allowed = {});
  std::string path_of(std::string_view key) const;
  [[noreturn]] void fail_at(const toml::node& node, std::string_view path, std::string_view problem) const;
  double number_in(const toml::node& node, std::string_view path, const Range& range) const;
  Vec3 vector_in(const toml::node& node, std::string_view path, int length) const;

  const toml::table* table_;
  std::string_view file_;
  std::string path_;
  std::vector<std::string_view> asked_;
  std::string allowed_last_;
};

}  // namespace carom
