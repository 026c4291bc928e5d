#include "carom/laws/law_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <tuple>

#include "carom/laws/law_formula.h"
#include "core/files.h"
#include "scenario/read.h"

namespace carom {

namespace {

struct PushKey {
  std::string_view key;
  bool along_normal;
  double on_one;
  double on_two;
};

constexpr std::array<PushKey, 6> kPushKeys = {{{"normal", true, -1.0, 1.0},
                                               {"normal_1", true, 1.0, 0.0},
                                               {"normal_2", true, 0.0, 1.0},
                                               {"tangential", false, -1.0, 1.0},
                                               {"tangential_1", false, 1.0, 0.0},
                                               {"tangential_2", false, 0.0, 1.0}}};

/// The offset of a place in a text. Columns of TOML count characters, not bytes.
std::size_t offset_of(std::string_view text, const toml::source_position& place) {
  std::size_t at = 0;
  for (toml::source_index line = 1; line < place.line; ++line) at = text.find('\n', at) + 1;
  for (toml::source_index column = 1; column < place.column && at < text.size(); ++column) {
    do ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U);
  }
  return at;
}

/// The place after these bytes of an expression that begins at `from`.
SourcePlace place_after(const SourcePlace& from, std::string_view bytes) {
  SourcePlace place = from;
  for (const char c : bytes) {
    if (c == '\n') {
      ++place.line;
      place.column = 1;
    } else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {
      ++place.column;
    }
  }
  return place;
}

/// What stands at a key, and where its first character is.
LawExpression expression_at(const toml::table& table, std::string_view key, std::string path,
                            const std::string& value, std::string_view text, const std::string& file) {
  const toml::source_position begin = table.get(key)->source().begin;
  LawExpression expression{std::move(path), value, {file, begin.line, begin.column}, false};
  // One quotation mark before it, or three and perhaps a line; with escapes in it, it is not there as it is.
  const std::size_t quote = offset_of(text, begin);
  for (std::size_t before = 1; before <= 5 && quote + before <= text.size(); ++before) {
    if (text.substr(quote + before, value.size()) != value) continue;
    expression.place = place_after(expression.place, text.substr(quote, before));
    expression.place_is_exact = true;
    break;
  }
  return expression;
}

/// The keys of a table in the order in which they stand in the file.
std::vector<std::string> keys_in_order(const toml::table& table) {
  std::vector<std::pair<toml::source_position, std::string>> keys;
  for (const auto& [key, node] : table) keys.emplace_back(node.source().begin, std::string(key.str()));
  std::stable_sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first.line, a.first.column) < std::tie(b.first.line, b.first.column);
  });
  std::vector<std::string> names;
  names.reserve(keys.size());
  for (auto& [place, name] : keys) names.push_back(std::move(name));
  return names;
}

bool is_name(const std::string& word) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return letter(word.front()) &&
         std::all_of(word.begin(), word.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

bool is_taken(const std::string& word) {
  const auto& names = law_names();
  const auto& functions = law_functions();
  return std::any_of(names.begin(), names.end(), [&](const LawName& each) { return each.name == word; }) ||
         std::find(functions.begin(), functions.end(), word) != functions.end();
}

void read_definitions(Reader& root, const toml::table& table, std::string_view text, LawFile& law) {
  std::optional<Reader> reader = root.table("let");
  if (!reader) return;
  const toml::table& let = *table.get_as<toml::table>("let");
  const std::vector<std::string> keys = keys_in_order(let);
  for (const std::string& key : keys) {
    if (key.empty() || !is_name(key)) {
      reader->fail(key, "is no name, allowed: letters, digits and _, a letter first");
    }
    if (is_taken(key)) reader->fail(key, "has a meaning already, allowed: a name of your own");
    const std::string value = reader->required(key, reader->text(key));
    law.definitions.push_back(expression_at(let, key, "let." + key, value, text, law.file));
  }
  reader->finish();
}

/// The keys of an impulse along one direction: of both balls, or of each by itself.
struct PushKeys {
  std::string_view both;
  std::string_view one;
  std::string_view two;
};

/// Either both balls get the same, or each its own.
void check_pushes(Reader& root, const PushKeys& keys, bool required) {
  const bool both = root.has(keys.both);
  const bool one = root.has(keys.one);
  const bool two = root.has(keys.two);
  if (both && (one || two)) {
    root.fail(keys.both, fmt::format("stands beside {}, allowed: {} alone, or {} and {}",
                                     one ? keys.one : keys.two, keys.both, keys.one, keys.two));
  }
  if (one != two) {
    root.fail(one ? keys.one : keys.two, fmt::format("stands alone, allowed: {} and {}, or {} for both balls",
                                                     keys.one, keys.two, keys.both));
  }
  if (required && !both && !one) {
    root.fail(keys.both, fmt::format("{} is missing, allowed: an expression in quotation marks, or {} and {}",
                                     keys.both, keys.one, keys.two));
  }
}

void read_law(const toml::table& table, std::string_view text, LawFile& law) {
  Reader root(table, law.file, "");
  law.name = root.required("name", root.text("name"));
  law.about = root.text("about").value_or("");
  read_definitions(root, table, text, law);
  check_pushes(root, {"normal", "normal_1", "normal_2"}, true);
  check_pushes(root, {"tangential", "tangential_1", "tangential_2"}, false);
  for (const PushKey& each : kPushKeys) {
    const std::optional<std::string> value = root.text(each.key);
    if (!value) continue;
    law.pushes.push_back({expression_at(table, each.key, std::string(each.key), *value, text, law.file),
                          each.along_normal, each.on_one, each.on_two});
  }
  root.finish();
}

}  // namespace

bool LawFile::has_tangential() const {
  return std::any_of(pushes.begin(), pushes.end(), [](const LawPush& push) { return !push.along_normal; });
}

bool LawFile::is_reciprocal() const {
  return std::all_of(pushes.begin(), pushes.end(),
                     [](const LawPush& push) { return push.on_one == -push.on_two; });
}

LawFile parse_law(std::string_view toml_text, const std::string& file) {
  LawFile law;
  law.file = file;
  law.id = std::filesystem::path(file).stem().string();
  try {
    const toml::table table = toml::parse(toml_text, file);
    read_law(table, toml_text, law);
  } catch (const toml::parse_error& error) {
    const auto& place = error.source().begin;
    throw InputError(
        fmt::format("{}:{}:{}: not TOML: {}", file, place.line, place.column, error.description()));
  }
  const LawFormula compiled(law);  // says what is wrong with an expression
  return law;
}

LawFile load_law(const std::filesystem::path& file) {
  return parse_law(read_file(file), file.string());
}

}  // namespace carom
