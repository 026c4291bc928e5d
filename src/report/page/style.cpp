#include "report/page/style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace carom::page {

namespace {

constexpr std::size_t kColours = 8;  // .c0 … .c7 in page.css

// Lengths of dashes and gaps, px. Seven of them, so that they pair differently with eight colours and six
// shapes.
constexpr std::array kDashes = {"", "7 3", "2 2.5", "9 3 2 3", "4 2", "12 4", "6 2 2 2 2 2"};

// Drawn from the point that they mark, all of about the same area.
constexpr std::array kShapes = {
    "m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0z",                           // disc
    "m-2.7-2.7h5.4v5.4h-5.4z",                                      // square
    "m0-3.6l3.5 6h-7z",                                             // triangle
    "m0-3.8l3.2 3.8l-3.2 3.8l-3.2-3.8z",                            // diamond
    "m0 3.6l3.5-6h-7z",                                             // triangle on its tip
    "m-1.1-3.4h2.2v2.3h2.3v2.2h-2.3v2.3h-2.2v-2.3h-2.3v-2.2h2.3z",  // cross
};

}  // namespace

std::string LineStyle::marker(const Point& at) const {
  return fmt::format("M{} {}{}", px(at.x), px(at.y), kShapes[shape]);
}

Legend::Legend(const std::vector<SceneComparison>& scenes) {
  for (const SceneComparison& scene : scenes) {
    for (const RunComparison& run : scene.runs) {
      const std::string label = run.run.label();
      if (std::find(labels_.begin(), labels_.end(), label) == labels_.end()) labels_.push_back(label);
    }
  }
}

LineStyle Legend::style(const std::string& label) const {
  const auto place = std::find(labels_.begin(), labels_.end(), label);
  const auto slot = static_cast<std::size_t>(place - labels_.begin());
  return {fmt::format("c{}", slot % kColours), kDashes[slot % kDashes.size()], slot % kShapes.size()};
}

void Legend::add_swatch(Node parent, const std::string& label) const {
  const LineStyle look = style(label);
  Node svg =
      add(parent, "svg",
          {{"class", "swatch " + look.colour_class}, {"viewBox", "0 0 34 12"}, {"aria-hidden", "true"}});
  Node line = add(svg, "path", {{"class", "line"}, {"d", "M1 6h32"}});
  if (!look.dashes.empty()) line.append_attribute("stroke-dasharray").set_value(look.dashes.c_str());
  add(svg, "path", {{"class", "marker"}, {"d", look.marker({17.0, 6.0})}});
}

}  // namespace carom::page
