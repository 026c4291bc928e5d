#include "report/page/energy_bar.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/page/polyline.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

constexpr double kBarWidth_px = 180.0;
constexpr double kBarHeight_px = 16.0;
constexpr double kEdge_px = 7.0;         // beside the widest bar, for an arrowhead
constexpr double kTop_px = 2.0;          // of a part
constexpr double kThick_px = 12.0;       // of a part
constexpr double kVisiblePart_px = 0.3;  // less is not drawn
constexpr double kStripes_px = 5.0;      // from one stripe to the next

struct Look {
  const char* colour_class;  ///< in page.css; hollow for an outline
  bool upright_stripes;
  bool level_stripes;
};

constexpr std::array<Look, kBarLooks> kLooks = {Look{"c7 hollow", false, false}, Look{"c1", false, false},
                                                Look{"c5", true, false},         Look{"c4", false, true},
                                                Look{"c3", true, true},          Look{"c2", true, false}};

/// Lines across a part, in the colour of the card that it lies on.
std::string stripes(const Look& look, double left, double width) {
  std::string path;
  if (look.upright_stripes) {
    for (double x = kStripes_px / 2.0; x < width; x += kStripes_px) {
      path += fmt::format("M{} {}v{}", px(left + x), px(kTop_px), px(kThick_px));
    }
  }
  if (look.level_stripes) {
    for (const double share : {1.0 / 3.0, 2.0 / 3.0}) {
      path += fmt::format("M{} {}h{}", px(left), px(kTop_px + share * kThick_px), px(width));
    }
  }
  return path;
}

void draw_part(Node svg, std::size_t look, double from, double to) {
  const double left = std::min(from, to);
  const double width = std::abs(to - from);
  if (width < kVisiblePart_px) return;
  add(svg, "rect",
      {{"class", std::string("part ") + kLooks.at(look).colour_class},
       {"x", px(left)},
       {"y", px(kTop_px)},
       {"width", px(width)},
       {"height", px(kThick_px)}});
  const std::string lines = stripes(kLooks.at(look), left, width);
  if (!lines.empty()) add(svg, "path", {{"class", "stripes"}, {"d", lines}});
}

/// The sum of what is above zero, or of what is below.
double side_of(const std::vector<BarPart>& parts, double sign) {
  double sum = 0.0;
  for (const BarPart& part : parts) sum += std::max(0.0, sign * part.amount);
  return sum;
}

/// "lost: friction 0.31, flight 0.002", or nothing.
std::string words_of(const std::vector<BarPart>& parts, double sign, const char* what) {
  std::vector<std::string> words;
  for (const BarPart& part : parts) {
    if (sign * part.amount > 0.0) words.push_back(part.name + " " + number(std::abs(part.amount)));
  }
  return words.empty() ? "" : fmt::format("{}: {}. ", what, fmt::join(words, ", "));
}

/// The parts of one side, from zero outwards.
void draw_side(Node svg, const std::vector<BarPart>& parts, double sign, double most, double zero_px,
               double scale_px) {
  double before = 0.0;
  for (const BarPart& part : parts) {
    const double amount = sign * part.amount;
    if (!(amount > 0.0)) continue;
    const double after = std::min(before + amount, most);
    draw_part(svg, part.look, zero_px + sign * scale_px * before, zero_px + sign * scale_px * after);
    before = after;
  }
  if (!(side_of(parts, sign) > most)) return;
  add(svg, "path",
      {{"class", "beyond"},
       {"d", fmt::format("M{} {}l{} {}l{} {}z", px(zero_px + sign * (scale_px * most + 1.0)), px(kTop_px),
                         px(sign * (kEdge_px - 2.0)), px(kThick_px / 2.0), px(-sign * (kEdge_px - 2.0)),
                         px(kThick_px / 2.0))}});
}

}  // namespace

void BarRange::take_in(const std::vector<BarPart>& parts, double most) {
  lost = std::max(lost, std::min(side_of(parts, -1.0), most));
  gained = std::max(gained, std::min(side_of(parts, 1.0), most));
}

void add_bar(Node parent, const std::string& title, const std::vector<BarPart>& parts,
             const BarRange& range) {
  Node svg = add(parent, "svg",
                 {{"class", "bar"},
                  {"viewBox", fmt::format("0 0 {} {}", px(kBarWidth_px), px(kBarHeight_px))},
                  {"role", "img"}});
  add(svg, "title", {}, title);
  const std::string words = words_of(parts, -1.0, "Lost") + words_of(parts, 1.0, "Gained");
  add(svg, "desc", {}, words.empty() ? "Nothing that can be seen." : words);
  const double extent = range.lost + range.gained;
  const double scale_px = extent > 0.0 ? (kBarWidth_px - 2.0 * kEdge_px) / extent : 0.0;
  const double zero_px = kEdge_px + scale_px * range.lost;
  draw_side(svg, parts, -1.0, range.lost, zero_px, scale_px);
  draw_side(svg, parts, 1.0, range.gained, zero_px, scale_px);
  add(svg, "path", {{"class", "zero"}, {"d", fmt::format("M{} 0v{}", px(zero_px), px(kBarHeight_px))}});
}

void add_bar_swatch(Node parent, std::size_t look) {
  Node svg = add(parent, "svg", {{"class", "swatch"}, {"viewBox", "0 0 34 16"}, {"aria-hidden", "true"}});
  draw_part(svg, look, 1.0, 33.0);
}

}  // namespace carom::page
