#include "report/page/canvas.h"

#include <fmt/format.h>

namespace carom::page {

namespace {

// Room for labels like "−0.00025" and for a line of text, px at the 11 px of the style sheet.
constexpr Margins kMargins = {46.0, 12.0, 16.0, 32.0};
constexpr double kTickLength_px = 4.0;
constexpr double kTextDrop_px = 3.8;  // from the middle of a line of text to its base line

void add_text(Node parent, const char* look, double x, double y, const std::string& text) {
  add(parent, "text", {{"class", look}, {"x", px(x)}, {"y", px(y)}}, text);
}

void draw_x_axis(const Canvas& canvas, Node frame, const AxisText& text) {
  const double left = canvas.margins.left;
  const double bottom = canvas.margins.top + canvas.height;
  std::string grid;
  for (const Tick& tick : canvas.x.ticks(text.ticks)) {
    const double x = left + canvas.width * canvas.x.fraction(tick.value);
    grid += fmt::format("M{} {}v{}", px(x), px(bottom), px(kTickLength_px));
    add_text(frame, "tick middle", x, bottom + 15.0, tick.label);
  }
  if (!grid.empty()) add(frame, "path", {{"class", "frame"}, {"d", grid}});
  add_text(frame, "tick end", left + canvas.width, bottom + 28.0, text.name);
}

void draw_y_axis(const Canvas& canvas, Node frame, const AxisText& text) {
  const double left = canvas.margins.left;
  std::string grid;
  for (const Tick& tick : canvas.y.ticks(text.ticks)) {
    const double y = canvas.margins.top + canvas.height * (1.0 - canvas.y.fraction(tick.value));
    grid += fmt::format("M{} {}h{}", px(left), px(y), px(canvas.width));
    add_text(frame, "tick end", left - 5.0, y + kTextDrop_px, tick.label);
  }
  if (!grid.empty()) add(frame, "path", {{"class", "grid"}, {"d", grid}});
  add_text(frame, "tick", 0.0, 9.0, text.name);
}

}  // namespace

Canvas add_canvas(Node parent, const Caption& caption, const Axis& x, const Axis& y, double width,
                  double height, const AxisText& x_text, const AxisText& y_text) {
  const double total_width = kMargins.left + width + kMargins.right;
  const double total_height = kMargins.top + height + kMargins.bottom;
  Node svg = add(parent, "svg",
                 {{"class", "drawing"},
                  {"viewBox", fmt::format("0 0 {} {}", px(total_width), px(total_height))},
                  {"role", "img"}});
  add(svg, "title", {}, caption.title);
  add(svg, "desc", {}, caption.description);
  Canvas canvas = {x, y, width, height, kMargins, svg, {}};
  Node frame = add(svg, "g", {{"aria-hidden", "true"}});
  draw_x_axis(canvas, frame, x_text);
  draw_y_axis(canvas, frame, y_text);
  // An inner svg clips what it holds without an id, which would have to be unique in the page.
  canvas.area = add(svg, "svg",
                    {{"x", px(kMargins.left)},
                     {"y", px(kMargins.top)},
                     {"width", px(width)},
                     {"height", px(height)},
                     {"class", "area"}});
  add(svg, "rect",
      {{"class", "frame"},
       {"x", px(kMargins.left)},
       {"y", px(kMargins.top)},
       {"width", px(width)},
       {"height", px(height)}});
  return canvas;
}

}  // namespace carom::page
