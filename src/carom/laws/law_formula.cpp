#include "carom/laws/law_formula.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <string>

#include "core/error.h"

namespace carom {

namespace {

/// What the names stand for. Ball 1 and ball 2, SI units; n from ball 1 to ball 2.
struct LawValues {
  double m1, m2, m, mt, r1, r2, I1, I2;
  double e, mu, beta0;
  double vn, vt, vn1, vn2, v1, v2;
  double v1x, v1y, v1z, v2x, v2y, v2z;
  double w1x, w1y, w1z, w2x, w2y, w2z;
  double nx, ny, nz, tx, ty, tz;
};

struct NamedValue {
  LawName name;
  double LawValues::*value;
};

const std::vector<NamedValue>& named_values() {
  using V = LawValues;
  static const std::vector<NamedValue> values = {
      {{"m1", "mass of ball 1, kg"}, &V::m1},
      {{"m2", "mass of ball 2, kg"}, &V::m2},
      {{"m", "reduced mass 1/(1/m1 + 1/m2), kg; right for an immovable ball, too"}, &V::m},
      {{"mt", "the same along the surface, 1/(1/m1 + 1/m2 + r1²/I1 + r2²/I2), kg"}, &V::mt},
      {{"r1", "radius of ball 1, m"}, &V::r1},
      {{"r2", "radius of ball 2, m"}, &V::r2},
      {{"I1", "moment of inertia of ball 1, kg m²; infinite without effects.spin"}, &V::I1},
      {{"I2", "moment of inertia of ball 2, kg m²"}, &V::I2},
      {{"e", "restitution of the scene's [contact]"}, &V::e},
      {{"mu", "friction μ of the scene's [contact]"}, &V::mu},
      {{"beta0", "tangential restitution of the scene's [contact]"}, &V::beta0},
      {{"vn", "(v2 - v1)·n, m/s; below 0, as the balls approach"}, &V::vn},
      {{"vt", "how fast the surfaces slip along t, m/s; not below 0"}, &V::vt},
      {{"vn1", "v1·n, m/s"}, &V::vn1},
      {{"vn2", "v2·n, m/s"}, &V::vn2},
      {{"v1", "speed of ball 1, m/s"}, &V::v1},
      {{"v2", "speed of ball 2, m/s"}, &V::v2},
      {{"v1x", "velocity of ball 1, m/s"}, &V::v1x},
      {{"v1y", ""}, &V::v1y},
      {{"v1z", ""}, &V::v1z},
      {{"v2x", "velocity of ball 2, m/s"}, &V::v2x},
      {{"v2y", ""}, &V::v2y},
      {{"v2z", ""}, &V::v2z},
      {{"w1x", "spin of ball 1, rad/s"}, &V::w1x},
      {{"w1y", ""}, &V::w1y},
      {{"w1z", ""}, &V::w1z},
      {{"w2x", "spin of ball 2, rad/s"}, &V::w2x},
      {{"w2y", ""}, &V::w2y},
      {{"w2z", ""}, &V::w2z},
      {{"nx", "n, the unit vector from ball 1 to ball 2"}, &V::nx},
      {{"ny", ""}, &V::ny},
      {{"nz", ""}, &V::nz},
      {{"tx", "t, the unit vector of the slip of ball 2 on ball 1; 0 where nothing slips"}, &V::tx},
      {{"ty", ""}, &V::ty},
      {{"tz", ""}, &V::tz},
  };
  return values;
}

struct Function {
  std::string_view name;
  double (*of_one)(double);
};
struct BinaryFunction {
  std::string_view name;
  double (*of_two)(double, double);
};

constexpr std::array<Function, 11> kFunctions = {
    {{"sqrt", [](double x) { return std::sqrt(x); }},
     {"abs", [](double x) { return std::abs(x); }},
     {"sign", [](double x) { return double(x > 0.0) - double(x < 0.0); }},
     {"exp", [](double x) { return std::exp(x); }},
     {"ln", [](double x) { return std::log(x); }},
     {"sin", [](double x) { return std::sin(x); }},
     {"cos", [](double x) { return std::cos(x); }},
     {"tan", [](double x) { return std::tan(x); }},
     {"asin", [](double x) { return std::asin(x); }},
     {"acos", [](double x) { return std::acos(x); }},
     {"atan", [](double x) { return std::atan(x); }}}};
constexpr std::array<BinaryFunction, 3> kBinaryFunctions = {
    {{"min", [](double x, double y) { return std::min(x, y); }},
     {"max", [](double x, double y) { return std::max(x, y); }},
     {"atan2", [](double y, double x) { return std::atan2(y, x); }}}};

void set_axes(const Vec3& v, double& x, double& y, double& z) {
  x = v.x();
  y = v.y();
  z = v.z();
}

void set(const PairMeeting& pair, LawValues& values) {
  const PairBall& one = pair.one;
  const PairBall& two = pair.two;
  const double inverse_mass = 1.0 / one.mass + 1.0 / two.mass;
  values.m1 = one.mass;
  values.m2 = two.mass;
  values.m = 1.0 / inverse_mass;
  values.mt =
      1.0 / (inverse_mass + one.radius * one.radius / one.inertia + two.radius * two.radius / two.inertia);
  values.r1 = one.radius;
  values.r2 = two.radius;
  values.I1 = one.inertia;
  values.I2 = two.inertia;
  values.e = pair.surface.restitution;
  values.mu = pair.surface.friction;
  values.beta0 = pair.surface.tangential_restitution;
  values.vn1 = pair.normal.dot(one.velocity);
  values.vn2 = pair.normal.dot(two.velocity);
  values.vn = pair.normal.dot(two.velocity - one.velocity);
  values.v1 = one.velocity.norm();
  values.v2 = two.velocity.norm();
  const Vec3 slip = slip_of(pair);
  values.vt = slip.norm();
  set_axes(one.velocity, values.v1x, values.v1y, values.v1z);
  set_axes(two.velocity, values.v2x, values.v2y, values.v2z);
  set_axes(one.spin, values.w1x, values.w1y, values.w1z);
  set_axes(two.spin, values.w2x, values.w2y, values.w2z);
  set_axes(pair.normal, values.nx, values.ny, values.nz);
  set_axes(values.vt > 0.0 ? Vec3(slip / values.vt) : Vec3::Zero(), values.tx, values.ty, values.tz);
}

// --- what is wrong with an expression

/// The place of a byte of the expression.
std::string place_in(const LawExpression& expression, std::size_t at) {
  SourcePlace place = expression.place;
  if (expression.place_is_exact) {
    for (const char c : expression.text.substr(0, at)) {
      if (c == '\n') ++place.line;
      if (c == '\n') place.column = 0;
      // Bytes that go on with a character are not counted.
      if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) ++place.column;
    }
  }
  return fmt::format("{}:{}:{}: {}", place.file, place.line, place.column, expression.key);
}

[[noreturn]] void fail(const LawExpression& expression, std::size_t at, const std::string& problem) {
  at = std::min(at, expression.text.size());
  throw InputError(fmt::format("{}: \"{}\", character {}: {}", place_in(expression, at), expression.text,
                               at + 1, problem));
}

/// All that may stand for a number at this place.
std::string names_that_exist(const mu::Parser& parser) {
  std::vector<std::string> names;
  for (const LawName& each : law_names()) names.emplace_back(each.name);
  names.emplace_back("pi");
  for (const auto& [name, pointer] : parser.GetVar()) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return fmt::format("allowed names: {}; functions: {}", fmt::join(names, ", "),
                     fmt::join(law_functions(), ", "));
}

/// The word or sign at a place.
std::string word_at(const std::string& text, std::size_t at) {
  const auto goes_on = [&](std::size_t i) {
    const auto c = static_cast<unsigned char>(text[i]);
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c >= 0x80U;
  };
  std::size_t end = at;
  while (end < text.size() && goes_on(end)) ++end;
  return text.substr(at, std::max<std::size_t>(end - at, 1));
}

std::string what_is_wrong(const mu::ParserError& error, const std::string& word, const mu::Parser& parser) {
  switch (error.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN:
      return fmt::format("found \"{}\", {}", word, names_that_exist(parser));
    case mu::ecUNEXPECTED_EOF:
      return "the expression ends too early, allowed: a number, a name or a bracket after its last sign";
    case mu::ecMISSING_PARENS:
      return "a bracket is not closed, allowed: as many ) as (";
    case mu::ecUNEXPECTED_PARENS:
      return fmt::format("\"{}\" closes or opens what it cannot, allowed: as many ) as (", word);
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_FUN:
      return fmt::format("\"{}\" follows on a value, allowed: an operator between them (a product is a*b)",
                         word);
    case mu::ecUNEXPECTED_OPERATOR:
      return fmt::format("found the operator \"{}\", allowed: a number, a name or a bracket before it", word);
    case mu::ecTOO_MANY_PARAMS:
      return fmt::format("{} has too many arguments, allowed: fewer", error.GetToken());
    case mu::ecTOO_FEW_PARAMS:
      return fmt::format("{} has too few arguments, allowed: more", error.GetToken());
    case mu::ecEMPTY_EXPRESSION:
      return "found nothing, allowed: an expression";
    default:
      return fmt::format("{}, allowed: an expression of numbers, names, + - * / ^, brackets and functions",
                         error.GetMsg());
  }
}

/// An assignment would change what a name stands for.
void refuse_assignment(const LawExpression& expression) {
  const std::string& text = expression.text;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
    } else if (i == 0 || (text[i - 1] != '<' && text[i - 1] != '>' && text[i - 1] != '!')) {
      fail(expression, i, "found \"=\", allowed: == to compare; names of your own stand in [let]");
    }
  }
}

}  // namespace

const std::vector<LawName>& law_names() {
  static const std::vector<LawName> names = [] {
    std::vector<LawName> all;
    all.reserve(named_values().size());
    for (const NamedValue& each : named_values()) all.push_back(each.name);
    return all;
  }();
  return names;
}

const std::vector<std::string_view>& law_functions() {
  static const std::vector<std::string_view> functions = [] {
    std::vector<std::string_view> all;
    all.reserve(kFunctions.size() + kBinaryFunctions.size());
    for (const Function& each : kFunctions) all.push_back(each.name);
    for (const BinaryFunction& each : kBinaryFunctions) all.push_back(each.name);
    return all;
  }();
  return functions;
}

struct LawFormula::Compiled {
  LawValues values{};
  std::deque<double> defined;  // a deque: the parsers hold on to where its numbers are
  std::vector<mu::Parser> definitions;
  std::vector<mu::Parser> pushes;

  /// A parser that knows every name so far, and nothing else.
  mu::Parser parser(const LawFile& file) {
    mu::Parser made;
    // muParser reads numbers by a locale of its own, the classic one, whatever the program's is.
    made.ClearFun();
    for (const Function& each : kFunctions) made.DefineFun(std::string(each.name), each.of_one);
    for (const BinaryFunction& each : kBinaryFunctions) made.DefineFun(std::string(each.name), each.of_two);
    made.ClearConst();
    made.DefineConst("pi", std::numbers::pi);
    for (const NamedValue& each : named_values()) {
      made.DefineVar(std::string(each.name.name), &(values.*each.value));
    }
    for (std::size_t i = 0; i < defined.size(); ++i) {
      made.DefineVar(file.definitions[i].key.substr(4), &defined[i]);
    }
    return made;
  }

  mu::Parser compiled(const LawFile& file, const LawExpression& expression) {
    mu::Parser made = parser(file);
    refuse_assignment(expression);
    std::string one_line = expression.text;
    std::replace_if(
        one_line.begin(), one_line.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
    try {
      made.SetExpr(one_line);
      made.Eval();
    } catch (const mu::ParserError& error) {
      const auto at = static_cast<std::size_t>(std::max(error.GetPos(), 0));
      const bool inside = at < one_line.size();
      fail(expression, at, what_is_wrong(error, inside ? word_at(one_line, at) : error.GetToken(), made));
    }
    if (made.GetNumResults() != 1) {
      fail(expression, one_line.find(','), "found several values, allowed: one (decimals are written 0.5)");
    }
    return made;
  }
};

LawFormula::LawFormula(LawFile file) : file_(std::move(file)), compiled_(std::make_unique<Compiled>()) {
  // Any pair will do to see whether the expressions can be read.
  set(PairMeeting{{}, {}, Vec3::UnitX(), {}}, compiled_->values);
  for (const LawExpression& definition : file_.definitions) {
    compiled_->definitions.push_back(compiled_->compiled(file_, definition));
    compiled_->defined.push_back(0.0);
  }
  for (const LawPush& push : file_.pushes) {
    compiled_->pushes.push_back(compiled_->compiled(file_, push.value));
  }
}

LawFormula::~LawFormula() = default;

PairImpulses LawFormula::impulses(const PairMeeting& pair) {
  LawValues& values = compiled_->values;
  set(pair, values);
  for (std::size_t i = 0; i < compiled_->definitions.size(); ++i) {
    compiled_->defined[i] = compiled_->definitions[i].Eval();
  }
  const Vec3 t(values.tx, values.ty, values.tz);
  PairImpulses impulses;
  for (std::size_t i = 0; i < compiled_->pushes.size(); ++i) {
    const LawPush& push = file_.pushes[i];
    const Vec3 impulse_Ns = compiled_->pushes[i].Eval() * (push.along_normal ? pair.normal : t);
    impulses.on_one += push.on_one * impulse_Ns;
    impulses.on_two += push.on_two * impulse_Ns;
  }
  return impulses;
}

}  // namespace carom
