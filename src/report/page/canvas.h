#pragma once

#include <string>

#include "report/page/axis.h"
#include "report/page/html.h"
#include "report/page/polyline.h"

namespace carom::page {

/// Room around the drawn area for tick labels, px.
struct Margins {
  double left = 0.0;
  double right = 0.0;
  double top = 0.0;
  double bottom = 0.0;
};

/// The area of a drawing between two axes. What is drawn in `area` has its origin at the area's upper left
/// corner and is cut off at its edges.
struct Canvas {
  Axis x;
  Axis y;
  double width = 0.0;   ///< of the area, px
  double height = 0.0;  ///< of the area, px
  Margins margins;
  Node svg;
  Node area;

  Point at(double x_value, double y_value) const {
    return {width * x.fraction(x_value), height * (1.0 - y.fraction(y_value))};
  }
};

/// What a drawing says to those who do not see it.
struct Caption {
  std::string title;
  std::string description;
};

/// How many ticks an axis should have at most, and what it measures.
struct AxisText {
  int ticks = 5;
  std::string name;
};

/// A new SVG with a grid and labelled axes, ready to be drawn in.
Canvas add_canvas(Node parent, const Caption& caption, const Axis& x, const Axis& y, double width,
                  double height, const AxisText& x_text, const AxisText& y_text);

}  // namespace carom::page
