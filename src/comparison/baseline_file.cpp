#include "comparison/baseline_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/error.h"

namespace carom {

namespace {

using Json = nlohmann::ordered_json;

/// Of the format: a file of another number is not read.
constexpr int kFormat = 1;

/// Walks over a text and counts its lines, for a parser that does not tell where it is.
class Counting {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  Counting(const char* at, int* line) : at_(at), line_(line) {}
  reference operator*() const { return *at_; }
  Counting& operator++() {
    if (*at_ == '\n') ++*line_;
    ++at_;
    return *this;
  }
  bool operator==(const Counting& other) const { return at_ == other.at_; }
  bool operator!=(const Counting& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  int* line_;
};

/// One value of the file with the line on which its key stands.
struct Node {
  std::string key;
  int line = 1;
  std::shared_ptr<const Json> held;  ///< nothing for a table; by pointer, so that nodes move without a throw
  bool is_table = false;
  std::vector<Node> children;

  const Json& value() const {
    static const Json none;
    return held ? *held : none;
  }
};

/// Builds the tree of nodes while the text is parsed. A baseline has tables, texts and numbers.
class TreeBuilder {
 public:
  using number_integer_t = Json::number_integer_t;
  using number_unsigned_t = Json::number_unsigned_t;
  using number_float_t = Json::number_float_t;
  using string_t = Json::string_t;
  using binary_t = Json::binary_t;

  TreeBuilder(const std::string& file, const int& line) : file_(file), line_(line) {}

  bool null() { return take(nullptr); }
  bool boolean(bool value) { return take(value); }
  bool number_integer(number_integer_t value) { return take(value); }
  bool number_unsigned(number_unsigned_t value) { return take(value); }
  bool number_float(number_float_t value, const string_t& /*text*/) { return take(value); }
  bool string(string_t& value) { return take(value); }
  bool binary(binary_t& /*value*/) { return false; }
  bool start_object(std::size_t /*size*/) {
    Node& node = next();
    node.is_table = true;
    path_.push_back(&node);
    return true;
  }
  bool end_object() {
    path_.pop_back();
    return true;
  }
  bool start_array(std::size_t /*size*/) {
    throw InputError(fmt::format("{}:{}: {}: found a list, allowed: a table, a text or a number", file_,
                                 line_, path_.empty() ? "the file" : key_));
  }
  bool end_array() { return false; }
  bool key(string_t& key) {
    for (const Node& sibling : path_.back()->children) {
      if (sibling.key == key) {
        throw InputError(
            fmt::format("{}:{}: {}: stands twice, line {} has it too", file_, line_, key, sibling.line));
      }
    }
    key_ = key;
    key_line_ = line_;
    return true;
  }
  bool parse_error(std::size_t /*position*/, const std::string& /*token*/, const Json::exception& error) {
    const std::string what = error.what();
    throw InputError(fmt::format("{}:{}: not JSON: {}", file_, line_, what.substr(what.rfind("] ") + 2)));
  }

  Node take_root() { return std::move(root_); }

 private:
  bool take(Json value) {
    next().held = std::make_shared<const Json>(std::move(value));
    return true;
  }
  /// Where the value that comes now belongs. A vector of children grows only while it is the last on the
  /// path.
  Node& next() {
    if (path_.empty()) {
      root_.line = line_;
      return root_;
    }
    return path_.back()->children.emplace_back(Node{key_, key_line_, nullptr, false, {}});
  }

  const std::string& file_;
  const int& line_;
  std::string key_;
  int key_line_ = 1;
  Node root_;
  std::vector<Node*> path_;
};

/// Reads nodes as what they must be.
class Interpreter {
 public:
  explicit Interpreter(const std::string& file) : file_(file) {}

  Baseline baseline(const Node& root) const {
    if (!root.is_table) fail(root, "", "found no table, allowed: what carom check --write-baseline writes");
    allow(root, "", {"carom_baseline", "scenes"});
    const Node& format = required(root, "", "carom_baseline");
    if (format.value() != kFormat) fail_value(format, "carom_baseline", std::to_string(kFormat));
    Baseline baseline;
    baseline.file = file_;
    const Node& scenes = required(root, "", "scenes");
    for (const Node& node : table(scenes, "scenes")) {
      baseline.scenes[node.key] = scene(node, "scenes." + node.key);
    }
    return baseline;
  }

 private:
  [[noreturn]] void fail(const Node& node, const std::string& path, const std::string& problem) const {
    throw InputError(fmt::format("{}:{}: {}{}{}", file_, node.line, path, path.empty() ? "" : ": ", problem));
  }
  [[noreturn]] void fail_value(const Node& node, const std::string& path, const std::string& allowed) const {
    const std::string found = node.is_table ? "a table" : node.value().dump();
    fail(node, path, fmt::format("found {}, allowed: {}", found, allowed));
  }

  const std::vector<Node>& table(const Node& node, const std::string& path) const {
    if (!node.is_table) fail_value(node, path, "a table");
    return node.children;
  }

  void allow(const Node& node, const std::string& path, const std::vector<std::string_view>& keys) const {
    for (const Node& child : table(node, path)) {
      if (std::find(keys.begin(), keys.end(), child.key) != keys.end()) continue;
      fail(child, below(path, child.key), fmt::format("unknown key, allowed: {}", fmt::join(keys, ", ")));
    }
  }

  static std::string below(const std::string& path, std::string_view key) {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
  }

  static const Node* find(const Node& node, std::string_view key) {
    const auto found = std::find_if(node.children.begin(), node.children.end(),
                                    [key](const Node& child) { return child.key == key; });
    return found == node.children.end() ? nullptr : &*found;
  }

  const Node& required(const Node& node, const std::string& path, std::string_view key) const {
    const Node* found = find(node, key);
    if (found == nullptr) fail(node, below(path, key), "is missing");
    return *found;
  }

  double number(const Node& node, const std::string& path) const {
    if (!node.value().is_number()) fail_value(node, path, "a finite number >= 0");
    const auto value = node.value().get<double>();
    if (!std::isfinite(value) || value < 0.0) fail_value(node, path, "a finite number >= 0");
    return value;
  }

  BaselineScene scene(const Node& node, const std::string& path) const {
    allow(node, path, {"sha256", "step", "seed", "engines"});
    BaselineScene scene;
    const Node& sha256 = required(node, path, "sha256");
    if (!sha256.value().is_string()) fail_value(sha256, path + ".sha256", "a text");
    scene.sha256 = sha256.value();
    scene.step_s = number(required(node, path, "step"), path + ".step");
    if (const Node* seed = find(node, "seed")) {
      if (!seed->value().is_number_unsigned()) fail_value(*seed, path + ".seed", "a whole number >= 0");
      scene.seed = seed->value().get<std::uint64_t>();
    }
    for (const Node& engine : table(required(node, path, "engines"), path + ".engines")) {
      scene.engines[engine.key] = metrics(engine, path + ".engines." + engine.key);
    }
    return scene;
  }

  Metrics metrics(const Node& node, const std::string& path) const {
    allow(node, path, {kMetricNames.begin(), kMetricNames.end()});
    Metrics metrics;
    for (const Node& child : node.children) {
      const auto* name = std::find(kMetricNames.begin(), kMetricNames.end(), child.key);
      metrics[static_cast<Metric>(name - kMetricNames.begin())] = number(child, path + "." + child.key);
    }
    return metrics;
  }

  const std::string& file_;
};

}  // namespace

std::string baseline_json(const Baseline& baseline) {
  Json scenes = Json::object();
  for (const auto& [id, scene] : baseline.scenes) {
    Json json = {{"sha256", scene.sha256}, {"step", scene.step_s}};
    if (scene.seed) json["seed"] = *scene.seed;
    json["engines"] = Json::object();
    for (const auto& [label, metrics] : scene.engines) {
      Json& engine = json["engines"][label] = Json::object();
      for (std::size_t i = 0; i < kMetricNames.size(); ++i) {
        const std::optional<double> value = metrics.values[i];
        if (value && std::isfinite(*value)) engine[std::string(kMetricNames[i])] = *value;
      }
    }
    scenes[id] = std::move(json);
  }
  const Json json = {{"carom_baseline", kFormat}, {"scenes", std::move(scenes)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Baseline parse_baseline(std::string_view text, const std::string& file) {
  int line = 1;
  TreeBuilder builder(file, line);
  // The parser reads a character beyond a number, and so possibly a line beyond it: keys are what is told.
  Json::sax_parse(Counting(text.data(), &line), Counting(text.data() + text.size(), &line), &builder);
  const Node root = builder.take_root();
  return Interpreter(file).baseline(root);
}

}  // namespace carom
