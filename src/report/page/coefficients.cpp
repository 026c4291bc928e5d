#include "report/page/coefficients.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/page/canvas.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

constexpr double kPanelWidth_px = 330.0;
constexpr double kPanelHeight_px = 190.0;
constexpr int kSpeedTicks = 5;
constexpr int kDeliveredTicks = 6;
// An engine that delivers within this of what was asked for does what it says: a hundred roundings of single
// precision.
constexpr double kAsAsked = 1e-5;
// What an engine that explodes may reach in a plot, in nominal values.
constexpr double kTallest = 3.0;
// A range shorter than this is hidden by its marker.
constexpr double kVisible_px = 2.0;

const char* symbol_of(Coefficient coefficient) {
  return coefficient == Coefficient::restitution ? "e" : "μ";
}

/// "e of a ball on a wall, asked for 0.5"
std::string panel_title(const CoefficientPanel& panel) {
  return fmt::format("{} of a ball on a {}, {} asked for", symbol_of(panel.coefficient),
                     panel.wall ? "wall" : "ball", given(panel.nominal));
}

/// From zero to the tallest curve, with a little room for markers at both ends.
Axis axis_of(const CoefficientPanel& panel) {
  constexpr double kRoom = 1.08;
  double high = panel.nominal;
  for (const CoefficientCurve& curve : panel.curves) {
    for (const std::optional<Delivered>& got : curve.values) {
      if (got) high = std::max(high, std::min(got->highest, kTallest * panel.nominal));
    }
  }
  return Axis::linear((1.0 - kRoom) * high, kRoom * high);
}

/// Powers of ten as their exponents.
Axis speed_axis(const CoefficientPanel& panel) {
  constexpr double kRoom = 0.1;
  return Axis::linear(std::log10(panel.speeds_mps.front()) - kRoom,
                      std::log10(panel.speeds_mps.back()) + kRoom);
}

void draw_curve(const Canvas& canvas, const CoefficientPanel& panel, const CoefficientCurve& curve,
                const LineStyle& style) {
  Polyline line;
  std::string markers;
  std::string ranges;
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    const std::optional<Delivered>& got = curve.values[i];
    const double x = std::log10(panel.speeds_mps[i]);
    line.push_back(canvas.at(x, got ? got->value : std::numeric_limits<double>::quiet_NaN()));
    if (!got) continue;
    markers += style.marker(line.back());
    const Point low = canvas.at(x, got->lowest);
    const Point high = canvas.at(x, got->highest);
    if (low.y - high.y > kVisible_px) ranges += fmt::format("M{} {}V{}", px(low.x), px(low.y), px(high.y));
  }
  if (markers.empty()) return;
  Node path =
      add(canvas.area, "path",
          {{"class", "line " + style.colour_class}, {"data-label", curve.label}, {"d", path_data(line)}});
  if (!style.dashes.empty()) path.append_attribute("stroke-dasharray").set_value(style.dashes.c_str());
  if (!ranges.empty()) add(canvas.area, "path", {{"class", "line " + style.colour_class}, {"d", ranges}});
  add(canvas.area, "path", {{"class", "marker " + style.colour_class}, {"d", markers}});
}

bool as_asked(const CoefficientPanel& panel, const CurveFinding& finding) {
  return finding.arrived && !finding.lost_up_to_mps && panel.nominal - finding.lowest <= kAsAsked &&
         finding.highest - panel.nominal <= kAsAsked;
}

/// "no bounce up to 1 m/s, then 0.5 to 0.58"
std::string words_for(const CoefficientPanel& panel, const CoefficientCurve& curve) {
  CurveFinding finding = finding_of(panel, curve);
  if (!finding.arrived) return "nothing was measured";
  std::string lost;
  if (finding.lost_up_to_mps) {
    lost = fmt::format("no {} up to {} m/s",
                       panel.coefficient == Coefficient::restitution ? "bounce" : "friction",
                       number(*finding.lost_up_to_mps));
    if (*finding.lost_up_to_mps >= panel.speeds_mps.back()) return lost;
    lost += ", then ";
    finding.lost_up_to_mps.reset();
  }
  if (as_asked(panel, finding)) return lost + "as asked for";
  return lost + number(finding.lowest) + " to " + number(finding.highest);
}

/// Those that do not deliver what was asked for, in words.
std::string finding_text(const CoefficientPanel& panel) {
  std::vector<std::string> words;
  std::size_t right = 0;
  for (const CoefficientCurve& curve : panel.curves) {
    if (as_asked(panel, finding_of(panel, curve))) {
      ++right;
    } else {
      words.push_back(curve.label + ": " + words_for(panel, curve));
    }
  }
  if (words.empty()) return "Every engine delivers what is asked for.";
  return fmt::format("{} of {} deliver what is asked for. Not so ", right, panel.curves.size()) +
         fmt::format("{}.", fmt::join(words, "; "));
}

void add_panel(Node parent, const CoefficientPanel& panel, const Legend& legend) {
  const std::string title = panel_title(panel);
  const std::string finding = finding_text(panel);
  Node figure = add(parent, "figure", {{"class", "plot"}});
  Node caption = add(figure, "figcaption");
  add(caption, "strong", {}, title + ".");
  say(caption, " " + finding);
  const Canvas canvas =
      add_canvas(figure, {title, finding}, speed_axis(panel), axis_of(panel), kPanelWidth_px, kPanelHeight_px,
                 {kSpeedTicks, "speed of the approach, m/s, as a power of ten"},
                 {kDeliveredTicks, std::string(symbol_of(panel.coefficient)) + " delivered"});
  const double asked = canvas.at(0.0, panel.nominal).y;
  add(canvas.area, "path", {{"class", "rule"}, {"d", fmt::format("M0 {}h{}", px(asked), px(canvas.width))}});
  for (const CoefficientCurve& curve : panel.curves) {
    draw_curve(canvas, panel, curve, legend.style(curve.label));
  }
}

/// "0.5", or "0.54 (0.02 to 0.66)" where it hangs on the phase of the step.
std::string words_of(const Delivered& got) {
  std::string value = number(got.value);
  if (got.highest - got.lowest <= kAsAsked) return value;
  return fmt::format("{} ({} to {})", value, number(got.lowest), number(got.highest));
}

void add_values(Node parent, const CoefficientPanel& panel) {
  std::vector<Heading> headings = {{"engine", ""}};
  for (const double speed_mps : panel.speeds_mps) headings.push_back({number(speed_mps) + " m/s", "number"});
  Node body = add_table(parent, "", panel_title(panel), headings);
  for (const CoefficientCurve& curve : panel.curves) {
    Node row = add(body, "tr");
    add(row, "th", {{"scope", "row"}}, curve.label);
    for (const std::optional<Delivered>& got : curve.values) add_number(row, got ? words_of(*got) : "–");
  }
}

void add_key(Node parent, const CoefficientPanel& panel, const Legend& legend) {
  Node key = add(parent, "ul", {{"class", "key"}});
  for (const CoefficientCurve& curve : panel.curves) {
    Node item = add(key, "li");
    legend.add_swatch(item, curve.label);
    say(item, " " + curve.label);
  }
}

}  // namespace

void add_coefficients(Node parent, const std::vector<CoefficientPanel>& panels, const Legend& legend) {
  if (panels.empty()) return;
  Node section = add(parent, "section", {{"id", "coefficients"}, {"aria-labelledby", "coefficients-title"}});
  add(section, "h2", {{"id", "coefficients-title"}}, "What an impact really delivers");
  add(section, "p", {{"class", "about"}},
      "A scene asks for a restitution e and a friction μ. Here one ball meets another, or a wall, head-on "
      "and "
      "without gravity, at speeds over four powers of ten: e is the speed of parting by that of approach, μ "
      "the "
      "change of velocity along the surface by that across it, of balls that spin so fast that they slide "
      "throughout. A law that knows no slow and no fast impacts is a horizontal line. A threshold, below "
      "which an "
      "engine takes an impact for rest, is a step down to zero.");
  add_key(section, panels.front(), legend);
  Node row = add(section, "div", {{"class", "plots"}});
  for (const CoefficientPanel& panel : panels) add_panel(row, panel, legend);
  add(section, "p", {{"class", "note"}},
      "The radius r is 0.1 m, the step 0.05 r/v. Each impact is made three times, so that a stepping engine "
      "finds an "
      "overlap of 0.2, 0.5 and 0.8 steps: the curve is the first, the upright line at a marker the range of "
      "all "
      "three. A gap in a curve, and a dash in the tables: the ball was stopped before it arrived. The "
      "straight line "
      "is what was asked for.");
  Node details = add_details(section, "All values");
  for (const CoefficientPanel& panel : panels) add_values(details, panel);
}

}  // namespace carom::page
