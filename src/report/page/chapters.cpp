#include "report/page/chapters.h"

#include <fmt/format.h>

#include "report/page/wording.h"
#include "scenario/features.h"

namespace carom::page {

namespace {

void add_profiles(Node parent, const EngineInfo& engine) {
  if (engine.profiles.empty()) return;
  Node list = add(parent, "dl", {{"class", "profiles"}});
  for (const Profile& profile : engine.profiles) {
    Node pair = add(list, "div");
    add(pair, "dt", {}, profile.name);
    add(pair, "dd", {}, sentence(profile.about));
  }
}

void add_limits(Node parent, const EngineInfo& engine) {
  if (engine.limits.empty()) return;
  add(parent, "h4", {}, "Where it stops being right, and why");
  Node list = add(parent, "ul");
  for (const std::string& limit : engine.limits) add(list, "li", {}, limit);
}

void add_lacks(Node parent, const EngineInfo& engine) {
  if (engine.cannot.empty()) {
    add(parent, "p", {}, "It can run everything that a scene can ask for.");
    return;
  }
  Node body = add_table(parent, "", "What " + engine.name + " cannot do", {{"feature", ""}, {"why", ""}});
  for (const auto& [feature, reason] : engine.cannot) {
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, std::string(name_of(feature)));
    add(row, "td", {}, reason);
  }
}

void add_engine(Node parent, const EngineInfo& engine) {
  Node article = add(parent, "div", {{"class", "engine"}});
  add(article, "h3", {}, engine.name);
  if (engine.about.empty()) {
    add(article, "p", {}, "It could not be opened: " + engine.version);
    return;
  }
  add(article, "p", {},
      fmt::format("{} Version {}, {}.", sentence(engine.about), engine.version, engine.precision));
  add_profiles(article, engine);
  add_limits(article, engine);
  add_lacks(article, engine);
}

}  // namespace

void add_guide(Node parent, const std::string& markdown) {
  Node section =
      add(parent, "section", {{"id", "guide"}, {"class", "prose"}, {"aria-labelledby", "guide-title"}});
  add(section, "h2", {{"id", "guide-title"}}, "How to read this page");
  add_markdown(section, markdown, 1);
}

void add_engines(Node parent, const Results& results) {
  Node section = add(parent, "section", {{"id", "engines"}, {"aria-labelledby", "engines-title"}});
  add(section, "h2", {{"id", "engines-title"}}, "The engines");
  Node grid = add(section, "div", {{"class", "engine-grid"}});
  for (const EngineInfo& engine : results.engines) add_engine(grid, engine);
  for (const MissingEngine& engine : results.missing) {
    Node article = add(grid, "div", {{"class", "engine"}});
    add(article, "h3", {}, engine.name);
    Node text = add(article, "p", {}, "Not built. Install the package ");
    add(text, "code", {}, engine.package);
    say(text, " and build Carom again to have it compared.");
  }
}

void add_footer(Node parent, const Results& results) {
  const Machine& machine = results.machine;
  add(add(parent, "footer"), "p", {},
      fmt::format("Carom {}. Machine: {}, {} cores. Compiler: {}, build {}.", results.version, machine.cpu,
                  machine.cores, machine.compiler, machine.build));
}

}  // namespace carom::page
