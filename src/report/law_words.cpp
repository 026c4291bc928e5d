#include "report/law_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "carom/laws/law_formula.h"
#include "report/json_number.h"
#include "report/words.h"

namespace carom {

namespace {

using Json = nlohmann::ordered_json;

std::string percent(double share) {
  return fmt::format("{:.3g} %", 100.0 * share);
}

/// The pair in the names of the law's expressions.
std::string pair_words(const PairMeeting& pair) {
  return fmt::format("m1 = {:.3g} kg, m2 = {:.3g} kg, e = {:.3g}, vn1 = {:.3g} m/s, vn2 = {:.3g} m/s",
                     pair.one.mass, pair.two.mass, pair.surface.restitution,
                     pair.normal.dot(pair.one.velocity), pair.normal.dot(pair.two.velocity));
}

std::string expressions(const LawFile& law) {
  std::string lines;
  for (const LawExpression& each : law.definitions) lines += wrapped("  " + each.key + " = ", each.text);
  for (const LawPush& push : law.pushes) lines += wrapped("  " + push.value.key + " = ", push.value.text);
  return lines;
}

Json components(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json ball_json(const PairBall& ball) {
  return {{"mass", ball.mass},
          {"radius", ball.radius},
          {"inertia", number_or_null(ball.inertia)},
          {"velocity", components(ball.velocity)},
          {"spin", components(ball.spin)}};
}

Json pair_json(const PairMeeting& pair) {
  return {
      {"one", ball_json(pair.one)},        {"two", ball_json(pair.two)},
      {"normal", components(pair.normal)}, {"restitution", pair.surface.restitution},
      {"friction", pair.surface.friction}, {"tangential_restitution", pair.surface.tangential_restitution}};
}

}  // namespace

std::string law_table(const LawReport& report, const LawReport& right) {
  std::string text = fmt::format("{} ({})\n{}", report.law.name, report.law.file, expressions(report.law));
  text += fmt::format("  {} random pairs, seed {}\n", report.pairs, report.seed);
  if (report.not_finite > 0) {
    text += fmt::format("  for {} of them the law is not a number; the others:\n", report.not_finite);
  }
  text += fmt::format("  {:<36}{:>7}{:>12}{:>10}{:>13}\n", "what must hold", "in all", "half above", "worst",
                      "right law");
  std::string explanations;
  for (std::size_t i = 0; i < report.results.size(); ++i) {
    const RuleResult& result = report.results[i];
    const LawRuleName& rule = law_rules()[i];
    text +=
        fmt::format("  {:<36}{:>7}{:>12}{:>10}{:>13}\n", rule.meaning,
                    result.holds() ? "yes" : percent(1.0 - result.broken_share), short_number(result.median),
                    short_number(result.worst), short_number(right.results[i].worst));
    if (result.holds()) continue;
    explanations += wrapped("  " + std::string(rule.name) + ": ",
                            fmt::format("{}; worst for {}", rule.measure, pair_words(result.worst_pair)));
  }
  if (explanations.empty()) return text + "  Nothing is broken.\n";
  return text + "  Broken, in units of what, and where it is worst:\n" + explanations;
}

std::string law_json(const LawReport& report, const LawReport& right) {
  Json json = {{"law", report.law.name}, {"file", report.law.file}, {"expressions", Json::object()}};
  for (const LawExpression& each : report.law.definitions) json["expressions"][each.key] = each.text;
  for (const LawPush& push : report.law.pushes) json["expressions"][push.value.key] = push.value.text;
  json["pairs"] = report.pairs;
  json["seed"] = report.seed;
  json["not_finite"] = report.not_finite;
  json["rules"] = Json::array();
  for (std::size_t i = 0; i < report.results.size(); ++i) {
    const RuleResult& result = report.results[i];
    const LawRuleName& rule = law_rules()[i];
    json["rules"].push_back({{"rule", rule.name},
                             {"meaning", rule.meaning},
                             {"measure", rule.measure},
                             {"holds", result.holds()},
                             {"broken_share", result.broken_share},
                             {"median", number_or_null(result.median)},
                             {"worst", number_or_null(result.worst)},
                             {"worst_pair", pair_json(result.worst_pair)},
                             {"right_worst", number_or_null(right.results[i].worst)}});
  }
  return json.dump(2) + "\n";
}

std::string law_vocabulary() {
  std::string text =
      "Names of an expression (ball 1 and ball 2, n from 1 to 2; impulses in N s, on ball 2):\n";
  const std::vector<LawName>& names = law_names();
  for (std::size_t i = 0; i < names.size();) {
    // Components share the meaning of the first.
    std::string together(names[i].name);
    const std::string_view meaning = names[i].meaning;
    for (++i; i < names.size() && names[i].meaning.empty(); ++i)
      together += fmt::format(", {}", names[i].name);
    text += wrapped(fmt::format("  {:<14}", together), meaning);
  }
  text += "  pi\n";
  return text + wrapped("Functions: ", fmt::format("{}; operators + - * / ^ and < > <= >= == != && || ? :",
                                                   fmt::join(law_functions(), ", ")));
}

}  // namespace carom
