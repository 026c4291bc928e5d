#pragma once

#include <string>
#include <utility>
#include <vector>

#include "comparison/results.h"
#include "report/page/html.h"
#include "report/page/polyline.h"

namespace carom::page {

/// How an engine's lines look everywhere on the page: colour, dashes and the shape of the markers all differ,
/// so that none of them is the only cue.
struct LineStyle {
  std::string colour_class;  ///< its colour is in the style sheet, for light and for dark
  std::string dashes;        ///< stroke-dasharray; empty for a full line
  std::size_t shape = 0;

  /// The marker around a place, as the `d` of an SVG path.
  std::string marker(const Point& at) const;
};

/// The labels of all runs of the page, in the order in which they come, each with a style of its own.
class Legend {
 public:
  explicit Legend(const std::vector<SceneComparison>& scenes);
  /// @pre no label is there twice
  explicit Legend(std::vector<std::string> labels) : labels_(std::move(labels)) {}

  const std::vector<std::string>& labels() const { return labels_; }
  LineStyle style(const std::string& label) const;

  /// A short piece of the engine's line with its marker.
  void add_swatch(Node parent, const std::string& label) const;

 private:
  std::vector<std::string> labels_;
};

}  // namespace carom::page
