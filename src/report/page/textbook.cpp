#include "report/page/textbook.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "report/page/math.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

std::string hundredths(double share) {
  return number(100.0 * share) + " %";
}

/// The decimal digits that are right where this is the largest error of a quantity of about 1.
int digits(double error) {
  return static_cast<int>(std::floor(-std::log10(error)));
}

void add_section(Node parent, const std::string& title, const std::string& text) {
  add(parent, "h3", {}, title);
  add(parent, "p", {}, text);
}

// The symbols that several formulas share.
std::string x(const char* ball) {
  return sub(mi("x"), mn(ball));
}
std::string v(const char* ball) {
  return sub(mi("v"), mn(ball));
}
std::string m(const char* ball) {
  return sub(mi("m"), mn(ball));
}
std::string r(const char* ball) {
  return sub(mi("r"), mn(ball));
}

void add_impulse(Node parent, const ImpulseAccuracy& measured) {
  add_section(
      parent, "The impulse is right",
      "Two balls closer than the sum of their radii are in contact. With n the unit vector from the second "
      "ball to the first, s says how fast they part; where they do not, each gets its share of an impulse:");
  add_formula(parent, {mi("n"),
                       mo("="),
                       frac(row({x("1"), mo("−"), x("2")}), mi("d")),
                       mo(","),
                       mi("s"),
                       mo("="),
                       mo("("),
                       v("1"),
                       mo("−"),
                       v("2"),
                       mo(")"),
                       mo("·"),
                       mi("n"),
                       mo(","),
                       mi("p"),
                       mo("="),
                       frac(row({mn("2"), mi("s")}), row({m("1"), mo("+"), m("2")})),
                       mo(","),
                       v("1"),
                       mo("−="),
                       mi("p"),
                       m("2"),
                       mi("n"),
                       mo(","),
                       v("2"),
                       mo("+="),
                       mi("p"),
                       m("1"),
                       mi("n")});
  add(parent, "p", {},
      fmt::format("This is the law of elastic impact, for any two masses. {} random pairs that met were held "
                  "against the same "
                  "law in double precision: velocities are right to {} digits (the largest error is {} of "
                  "the speeds), Σ m v "
                  "is kept to {} of Σ m|v| and Σ ½ m v² to {} of itself. More digits are not in a number of "
                  "single precision; "
                  "the formula has no error of its own.",
                  measured.pairs, digits(measured.velocity), number(measured.velocity),
                  number(measured.momentum), number(measured.energy)));
}

void add_shift(Node parent, const TextbookFindings& findings) {
  add_section(
      parent, "Moving balls apart moves them too far",
      "Balls that overlap are moved along the line of centres by the overlap o, one after the other:");
  add_formula(parent, {mi("o"), mo("="),
                       mi("d"), mo("−"),
                       mo("("), r("1"),
                       mo("+"), r("2"),
                       mo(")"), mo(","),
                       x("1"),  mo("−="),
                       mi("o"), frac(row({x("1"), mo("−"), x("2")}), mi("d")),
                       mo(","), mtext("\u00a0then\u00a0"),
                       x("2"),  mo("+="),
                       mi("o"), frac(row({x("1"), mo("−"), x("2")}), mi("d"))});
  add(parent, "p", {},
      "The first line alone takes away all of the overlap. The second finds the first ball where it is now, "
      "at the "
      "distance R = r₁ + r₂ and no longer d, still divides by d, and moves the second ball by R/d overlaps "
      "more. "
      "The deeper the overlap, the further they are thrown apart:");
  Node body = add_table(parent, "", "Two balls at rest that overlap, after one update",
                        {{"overlap, of R", "number"},
                         {"first moved, in overlaps", "number"},
                         {"second moved", "number"},
                         {"gap afterwards, of R", "number"},
                         {"centre of mass moved (m₂ = 100 m₁), in overlaps", "number"}});
  for (const ShiftMeasured& shift : findings.shifts) {
    Node line = add(body, "tr");
    add(line, "th", {{"scope", "row"}, {"class", "number"}}, hundredths(shift.overlap));
    add_number(line, number(shift.first));
    add_number(line, number(shift.second));
    add_number(line, hundredths(shift.gap));
    add_number(line, number(shift.centre_of_mass));
  }
  add(parent, "p", {},
      fmt::format(
          "Which of two equal balls has the lower number decides which goes further: numbered the other way "
          "round, at half of R each ends {} overlaps from where it did. The masses have no say, so the "
          "centre "
          "of mass jumps, and with it the angular momentum; no force has done it. Right is to share the "
          "overlap out by the inverse masses, as carom:step does.",
          number(findings.swapped)));
}

void add_drops(Node parent, const std::vector<DropMeasured>& drops) {
  add_section(
      parent, "Under gravity it makes energy",
      "A ball that is moved up has more potential energy than before, and nothing has paid for it. One ball "
      "falls on another in a shaft, both elastic, for ten seconds; all of the energy should be there at the "
      "end. The program's text has no gravity; here each update adds g to v before it adds v to x, which has "
      "an error of its own at every bounce:");
  Node body = add_table(parent, "", "Change of the energy, of what it was at the start",
                        {{"updates a second", "number"},
                         {"all in all", "number"},
                         {"by moving balls apart", "number"},
                         {"by falling in whole updates", "number"}});
  for (const DropMeasured& drop : drops) {
    Node line = add(body, "tr");
    add(line, "th", {{"scope", "row"}, {"class", "number"}}, fmt::format("{}", drop.rate_hz));
    add_number(line, hundredths(drop.energy));
    add_number(line, hundredths(drop.correction));
    add_number(line, hundredths(drop.flight));
  }
}

void add_coincident(Node parent, const CoincidentMeasured& measured) {
  add_section(
      parent, "One centre is a division by zero",
      fmt::format(
          "Where d = 0 there is no line of centres: n is 0/0, which is not a number, and so is all that is "
          "computed with it. After one update {} of 3 balls are nowhere, after four seconds {}. {} It takes "
          "two "
          "centres that agree to the last bit when they are compared, so it is rare, and all the harder to "
          "find. Carom's own engine takes any direction then, and always the same.",
          measured.not_finite_after_one, measured.not_finite_after_all,
          measured.third_untouched
              ? "The third, which lay in their way, is untouched: no comparison with NaN holds, so a lost "
                "ball hits nobody."
              : "The third, which lay in their way, is lost with them."));
}

void add_squares(Node parent, const std::vector<SquaredLaw>& rows) {
  add_section(parent, "The law printed as that of momentum is that of energy",
              "The course text writes the conservation of momentum with squared speeds:");
  add_formula(parent,
              {m("1"), sup(v("1"), mn("2")), mo("+"), m("2"), sup(v("2"), mn("2")), mo("="), m("1"),
               sup(row({v("1"), mo("′")}), mn("2")), mo("+"), m("2"), sup(row({v("2"), mo("′")}), mn("2"))});
  add(parent, "p", {},
      "Half of it is the kinetic energy, and elastic balls keep that: so the line is true, but it is another "
      "law. "
      "Momentum has the first power, and a direction. The difference does not show as long as e = 1, because "
      "both "
      "laws hold; with e < 1 energy is lost and momentum is not. Balls of 1 kg at 2 m/s and 3 kg at −1 m/s:");
  Node body = add_table(parent, "", "Before → after one impact",
                        {{"restitution e", "number"}, {"Σ m v, kg m/s", "number"}, {"Σ m v², J", "number"}});
  for (const SquaredLaw& each : rows) {
    Node line = add(body, "tr");
    add(line, "th", {{"scope", "row"}, {"class", "number"}}, number(each.restitution));
    add_number(line, fmt::format("{} → {}", number(each.momentum_before), number(each.momentum_after)));
    add_number(line, fmt::format("{} → {}", number(each.squares_before), number(each.squares_after)));
  }
  add(parent, "p", {},
      "And squares forget directions: both balls flying backwards, or on through each other, satisfy the "
      "printed line "
      "as well. The law file momentum-for-energy shows what comes of a program that believes it.");
}

void add_rates(Node parent, const std::vector<RateMeasured>& rates) {
  add_section(
      parent, "An update is a frame, and frames are not seconds",
      "The program adds v to x once a frame, so v is a length per frame: the same program runs faster on a "
      "faster screen. Carom translates, v = (m/s) · (s per update), so that a scene means the same at every "
      "rate. What remains is what is not seen between two frames: a contact is found late, and a ball that "
      "goes further than R = r₁ + r₂ in an update may pass another (past its centre they no longer "
      "approach, and get no impulse):");
  Node body = add_table(parent, "", "Two balls with R = 0.2 m, one of them at rest",
                        {{"updates a second", "number"},
                         {"0.02 m per update is, m/s", "number"},
                         {"pass unseen at 20 m/s", "number"},
                         {"1 − R/(v · update)", "number"},
                         {"impacts of the others are late by, s", "number"}});
  for (const RateMeasured& rate : rates) {
    Node line = add(body, "tr");
    add(line, "th", {{"scope", "row"}, {"class", "number"}}, fmt::format("{}", rate.rate_hz));
    add_number(line, number(rate.speed_mps));
    add_number(line, hundredths(rate.unseen));
    add_number(line, hundredths(rate.unseen_by_formula));
    add_number(line, number(rate.late_s));
  }
}

void add_spin(Node parent, const SpinMeasured& spin) {
  add_section(
      parent, "The spin is drawn, not computed",
      fmt::format(
          "Each update adds 0.1 v/r to the angle at which a ball is drawn. It is a look: no impact changes "
          "it but "
          "by way of v, and it has no energy. A ball that covers its circumference turns by {} rad; one that "
          "rolls turns by {} rad. The factor does not depend on the frame rate, as v is per update, too. "
          "Spin "
          "that friction makes is in the scenes of friction/.",
          number(spin.drawn_rad), number(spin.rolling_rad)));
}

}  // namespace

void add_textbook(Node parent, const std::optional<TextbookFindings>& findings) {
  if (!findings) return;
  Node section = add(parent, "section", {{"id", "textbook"}, {"aria-labelledby", "textbook-title"}});
  add(section, "h2", {{"id", "textbook-title"}}, "The course program, formula by formula");
  add(section, "p", {{"class", "about"}},
      "Carom grew from a student's program: balls in single precision, one update a frame, every pair looked "
      "at twice. "
      "It runs here as carom:textbook, with its formulas as they stand in the text and in their order. Each "
      "number "
      "below was measured by running it when this page was made.");
  add_impulse(section, findings->impulse);
  add_shift(section, *findings);
  add_drops(section, findings->drops);
  add_coincident(section, findings->coincident);
  add_squares(section, findings->squares);
  add_rates(section, findings->rates);
  add_spin(section, findings->spin);
}

}  // namespace carom::page
