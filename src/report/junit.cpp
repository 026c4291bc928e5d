#include "report/junit.h"

#include <fmt/format.h>

#include <pugixml.hpp>
#include <sstream>

#include "report/words.h"

namespace carom {

namespace {

struct Counts {
  int tests = 0;
  int failures = 0;
  int errors = 0;
  int skipped = 0;

  void add(const Counts& other) {
    tests += other.tests;
    failures += other.failures;
    errors += other.errors;
    skipped += other.skipped;
  }

  void write_to(pugi::xml_node node) const {
    node.append_attribute("tests") = tests;
    node.append_attribute("failures") = failures;
    node.append_attribute("errors") = errors;
    node.append_attribute("skipped") = skipped;
  }
};

pugi::xml_node add_case(pugi::xml_node suite, const SceneComparison& scene, const RunComparison& run,
                        std::string_view name) {
  pugi::xml_node test = suite.append_child("testcase");
  test.append_attribute("classname") = fmt::format("{}.{}", scene.scene->id, run.run.label()).c_str();
  test.append_attribute("name") = std::string(name).c_str();
  // The run's time is told once, at its first test case, so that a sum over all of them is right.
  const bool first = test.previous_sibling("testcase").empty() ||
                     std::string(test.previous_sibling("testcase").attribute("classname").value()) !=
                         test.attribute("classname").value();
  test.append_attribute("time") = fmt::format("{:.6f}", first ? run.run.cpu_seconds : 0.0).c_str();
  return test;
}

void add_message(pugi::xml_node test, const char* element, const std::string& message) {
  pugi::xml_node node = test.append_child(element);
  node.append_attribute("message") = message.c_str();
}

Counts add_run(pugi::xml_node suite, const SceneComparison& scene, const RunComparison& run) {
  Counts counts;
  if (run.run.status != RunStatus::ok || run.gates.empty()) {
    const pugi::xml_node test = add_case(suite, scene, run, "run");
    counts.tests = 1;
    if (run.violates()) {
      counts.errors = 1;
      add_message(test, "error", violations(scene, run).front());
    } else {
      counts.skipped = 1;
      add_message(test, "skipped",
                  run.run.status == RunStatus::ok
                      ? "shown, not gated"
                      : fmt::format("{}: {}", name_of(run.run.status), run.run.reason));
    }
    return counts;
  }
  std::size_t broken = 0;
  const std::vector<std::string> lines = violations(scene, run);
  for (const GateResult& gate : run.gates) {
    const pugi::xml_node test = add_case(suite, scene, run, name_of(gate.metric));
    ++counts.tests;
    if (gate.holds) continue;
    ++counts.failures;
    add_message(test, "failure", lines[broken++]);
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
    suite.append_attribute("name") = scene.scene->id.c_str();
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
