#pragma once

#include <string>
#include <vector>

#include "report/page/html.h"

namespace carom::page {

/// A part of a bar: what it is called, how it looks everywhere on the page, and how much it is.
struct BarPart {
  std::string name;
  std::size_t look = 0;  ///< below kBarLooks: colour and hatching, so that colour is never the only cue
  double amount = 0.0;
};

inline constexpr std::size_t kBarLooks = 6;

/// What bars that stand under each other can show, so that they can be compared: from -lost to gained, both
/// at least 0.
struct BarRange {
  double lost = 0.0;
  double gained = 0.0;

  /// Widens it for a bar of these parts, up to `most` on either side.
  void take_in(const std::vector<BarPart>& parts, double most);
};

/// A bar of parts that are laid end to end from an upright line at zero, what is above zero to the right and
/// what is below to the left, each in the order given. What does not fit ends in an arrowhead.
void add_bar(Node parent, const std::string& title, const std::vector<BarPart>& parts, const BarRange& range);

/// A short piece of a part, for a key.
void add_bar_swatch(Node parent, std::size_t look);

}  // namespace carom::page
