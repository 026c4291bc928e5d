#include "report/page/laws.h"

#include <fmt/format.h>

#include <string>

#include "report/page/wording.h"

namespace carom::page {

namespace {

void add_result(Node row, const LawReport& report, std::size_t rule) {
  const RuleResult& result = report.results[rule];
  const Verdict look = result.holds() ? Verdict::pass : Verdict::fail;
  Node box = add(row, "td", {{"class", "cell " + std::string(name_of(look))}});
  box.append_attribute("title").set_value(fmt::format("{}: {}; at worst {}, half of the pairs above {}",
                                                      report.law.name, law_rules()[rule].measure,
                                                      number(result.worst), number(result.median))
                                              .c_str());
  add(box, "span", {{"class", "glyph"}, {"aria-hidden", "true"}}, std::string(glyph_of(look)));
  say(box, result.holds() ? " always" : fmt::format(" in {:.3g} %", 100.0 * (1.0 - result.broken_share)));
}

void add_matrix(Node parent, const std::vector<LawReport>& reports) {
  std::vector<Heading> headings = {{"what must hold", ""}};
  for (const LawReport& report : reports) headings.push_back({report.law.name, ""});
  Node body = add_table(
      parent, "", fmt::format("In how many of {} random pairs it holds", reports.front().pairs), headings);
  for (std::size_t rule = 0; rule < law_rules().size(); ++rule) {
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, std::string(law_rules()[rule].meaning));
    for (const LawReport& report : reports) add_result(row, report, rule);
  }
}

/// How far off a law is where it breaks a rule: half of the pairs are above the first number.
void add_breaks(Node parent, const LawReport& report) {
  Node list = add(parent, "ul");
  for (std::size_t rule = 0; rule < report.results.size(); ++rule) {
    const RuleResult& result = report.results[rule];
    if (result.holds()) continue;
    const PairMeeting& pair = result.worst_pair;
    add(list, "li", {},
        fmt::format("{}: {}; in half of the pairs above {}, at worst {}, for m₁ = {} kg, m₂ = {} kg, e = {}, "
                    "approaching "
                    "at {} m/s.",
                    law_rules()[rule].meaning, law_rules()[rule].measure, number(result.median),
                    number(result.worst), number(pair.one.mass), number(pair.two.mass),
                    number(pair.surface.restitution),
                    number(-pair.normal.dot(pair.two.velocity - pair.one.velocity))));
  }
}

void add_law(Node parent, const LawReport& report) {
  Node details = add_details(parent, report.law.name + " (" + report.law.id + ".toml)");
  add_markdown(details, report.law.about, 3);
  for (const LawExpression& each : report.law.definitions) {
    add(add(details, "p"), "code", {}, each.key.substr(each.key.find('.') + 1) + " = " + each.text);
  }
  for (const LawPush& push : report.law.pushes) {
    add(add(details, "p"), "code", {}, push.value.key + " = " + push.value.text);
  }
  add_breaks(details, report);
}

}  // namespace

void add_laws(Node parent, const std::vector<LawReport>& reports) {
  if (reports.empty()) return;
  Node section = add(parent, "section", {{"id", "laws"}, {"aria-labelledby", "laws-title"}});
  add(section, "h2", {{"id", "laws-title"}}, "Laws of impact, right and wrong");
  add(section, "p", {{"class", "about"}},
      "Anybody can write down a formula for what two balls do when they meet: carom run SCENE --law my.toml "
      "runs it, and "
      "carom law my.toml asks what it keeps and what it breaks. Here are the right law and popular others. "
      "Most of the "
      "wrong ones are right for some balls, equal ones or elastic ones or those that fly at each other "
      "head-on, which is "
      "why they are believed: one example proves nothing, so each law is asked about random pairs.");
  add_matrix(section, reports);
  add(section, "p", {{"class", "note"}},
      "Masses over four powers of ten, radii over one, any direction, speed and spin, e and μ from 0 to 1. A "
      "rule is "
      "broken where a pair is off by more than rounding can be, 256 roundings of the speeds. A law without "
      "friction "
      "answers for smooth balls.");
  for (const LawReport& report : reports) {
    if (!report.law.pushes.empty()) add_law(section, report);
  }
}

}  // namespace carom::page
