#include "report/junit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <pugixml.hpp>
#include <sstream>
#include <string_view>
#include <vector>

#include "report/words.h"

namespace carom {

namespace {

struct Counts {
  int tests = 0;
  int failures = 0;
  int errors = 0;
  int skipped = 0;
  double seconds = 0.0;

  void add(const Counts& other) {
    tests += other.tests;
    failures += other.failures;
    errors += other.errors;
    skipped += other.skipped;
    seconds += other.seconds;
  }

  void write_to(pugi::xml_node node) const {
    node.append_attribute("time") = fmt::format("{:.6f}", seconds).c_str();
    node.append_attribute("tests") = tests;
    node.append_attribute("failures") = failures;
    node.append_attribute("errors") = errors;
    node.append_attribute("skipped") = skipped;
  }
};

/// The bytes of the UTF-8 character at the front of a text that is not empty; 0 where there is none.
/// Source: RFC 3629, section 4, the table of well-formed byte sequences.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4) return 0;
  const std::size_t length = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  if (text.size() < length) return 0;
  // The second byte leaves out longer forms than needed, surrogates, and what is beyond the last code point.
  const unsigned char low = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
  const unsigned char high = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
  if (byte(1) < low || byte(1) > high) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  return length;
}

/// XML 1.0 has no place for most control characters, not even escaped, and asks for UTF-8: what an engine
/// printed may be neither. Each byte that is not allowed becomes a question mark.
std::string xml_text(std::string_view text) {
  std::string clean;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text.substr(i));
    const bool control = static_cast<unsigned char>(text[i]) < ' ' && text[i] != '\t' && text[i] != '\n';
    if (length == 0 || control) {
      clean += '?';
      ++i;
    } else {
      clean += text.substr(i, length);
      i += length;
    }
  }
  return clean;
}

pugi::xml_node add_case(pugi::xml_node suite, const SceneComparison& scene, const RunComparison& run,
                        std::string_view name) {
  pugi::xml_node test = suite.append_child("testcase");
  test.append_attribute("classname") =
      xml_text(fmt::format("{}.{}", scene.scene->id, run.run.label())).c_str();
  test.append_attribute("name") = std::string(name).c_str();
  // The run's time is told once, at its first test case, so that a sum over all of them is right.
  const bool first = test.previous_sibling("testcase").empty() ||
                     std::string(test.previous_sibling("testcase").attribute("classname").value()) !=
                         test.attribute("classname").value();
  test.append_attribute("time") = fmt::format("{:.6f}", first ? run.run.cpu_seconds : 0.0).c_str();
  return test;
}

/// What went wrong, as attribute and as text: some consumers show the one, some the other.
void add_message(pugi::xml_node test, const char* element, const char* type, const std::string& message) {
  const std::string clean = xml_text(message);
  pugi::xml_node node = test.append_child(element);
  node.append_attribute("message") = clean.c_str();
  if (std::string_view(element) == "skipped") return;
  node.append_attribute("type") = type;
  node.text() = clean.c_str();
}

/// One test case for a run that has no values to hold against limits.
Counts add_whole_run(pugi::xml_node suite, const SceneComparison& scene, const RunComparison& run) {
  const pugi::xml_node test = add_case(suite, scene, run, "run");
  Counts counts;
  counts.tests = 1;
  if (run.violates()) {
    counts.errors = 1;
    add_message(test, "error", std::string(name_of(run.run.status)).c_str(), violations(scene, run).front());
  } else {
    counts.skipped = 1;
    add_message(test, "skipped", "",
                run.run.status == RunStatus::ok
                    ? "shown, not gated"
                    : fmt::format("{}: {}", name_of(run.run.status), run.run.reason));
  }
  return counts;
}

/// A test case for each metric that has limits: the scene's, the baseline's, or both.
Counts add_run(pugi::xml_node suite, const SceneComparison& scene, const RunComparison& run) {
  if (run.run.status != RunStatus::ok || run.gates.empty()) {
    Counts counts = add_whole_run(suite, scene, run);
    counts.seconds = run.run.cpu_seconds;
    return counts;
  }
  Counts counts;
  counts.seconds = run.run.cpu_seconds;
  std::map<Metric, std::vector<std::string>> broken;
  for (const GateResult& gate : run.gates) {
    std::vector<std::string>& lines = broken[gate.metric];
    if (!gate.holds) lines.push_back(violation(gate));
  }
  for (const auto& [metric, lines] : broken) {
    const pugi::xml_node test = add_case(suite, scene, run, name_of(metric));
    ++counts.tests;
    if (lines.empty()) continue;
    ++counts.failures;
    add_message(test, "failure", "gate",
                fmt::format("{}: {}: {}", scene.scene->id, run.run.label(), fmt::join(lines, "; ")));
  }
  return counts;
}

}  // namespace

std::string results_junit(const Results& results) {
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node suites = document.append_child("testsuites");
  suites.append_attribute("name") = "carom check";
  Counts all;
  for (const SceneComparison& scene : results.scenes) {
    pugi::xml_node suite = suites.append_child("testsuite");
    suite.append_attribute("name") = xml_text(scene.scene->id).c_str();
    Counts counts;
    for (const RunComparison& run : scene.runs) counts.add(add_run(suite, scene, run));
    counts.write_to(suite);
    all.add(counts);
  }
  all.write_to(suites);
  std::ostringstream out;
  document.save(out, "  ");
  return out.str();
}

}  // namespace carom
