#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace carom {

/// An expression as somebody wrote it.
struct LawExpression {
  std::string key;  ///< under which it stands: "normal", "let.k"
  std::string text;
  /// Of its first character; of the quotation mark before it where the file writes it with escapes.
  SourcePlace place;
  bool place_is_exact = true;
};

/// One impulse of a law: the value of an expression, N s, along n or along t, on one ball or on both.
struct LawPush {
  LawExpression value;
  bool along_normal = true;  ///< else along t
  double on_one = 0.0;       ///< −1, 0 or 1: by which the value is multiplied
  double on_two = 0.0;
};

/// A law of impact as a file says it (TOML):
///   name       = "…"
///   about      = "…"            # Markdown, may be left out
///   normal     = "expression"   # N s along n, on ball 2; ball 1 gets the opposite
///   tangential = "expression"   # N s along t, the same; may be left out
///   [let]                       # names of one's own, each from what stands before it
///   k = "expression"
/// In place of normal, normal_1 and normal_2 give each ball an impulse of its own, both along n, and so do
/// tangential_1 and tangential_2 along t. The names that an expression may use are law_names()
/// (law_formula.h).
struct LawFile {
  std::string id;    ///< the file's stem; the profile under which the law runs
  std::string file;  ///< where it was read
  std::string name;
  std::string about;
  std::vector<LawExpression> definitions;  ///< of [let], in the order of the file
  std::vector<LawPush> pushes;

  bool has_tangential() const;
  /// Whether each ball gets the opposite of what the other gets, by the way it is written.
  bool is_reciprocal() const;
};

/// @throws InputError with file, line, column, key, what was found and what is allowed
LawFile parse_law(std::string_view toml_text, const std::string& file);

/// The same from a file. @throws InputError also where it cannot be read
LawFile load_law(const std::filesystem::path& file);

}  // namespace carom
