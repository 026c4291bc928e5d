#include "report/page/energy_causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "comparison/conserved.h"
#include "report/page/energy_bar.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

struct Cause {
  const char* name;
  double EnergySplit::*joules;
};

constexpr std::array kCauses = {
    Cause{"flight", &EnergySplit::flight_J},
    Cause{"ball impacts", &EnergySplit::ball_impacts_J},
    Cause{"wall impacts", &EnergySplit::wall_impacts_J},
    Cause{"friction", &EnergySplit::friction_J},
    Cause{"position correction", &EnergySplit::correction_J},
    Cause{"events", &EnergySplit::events_J},
};

static_assert(kCauses.size() == kBarLooks);

// A share of the energy below this is nobody's concern in this table; the plots of energy show what is
// smaller.
constexpr double kMatters = 1e-6;

double sum_of(const EnergySplit& split) {
  double sum_J = 0.0;
  for (const Cause& cause : kCauses) sum_J += split.*cause.joules;
  return sum_J;
}

bool matters(const EnergySplit& split, double scale_J) {
  return std::any_of(kCauses.begin(), kCauses.end(), [&](const Cause& cause) {
    return !(std::abs(split.*cause.joules) <= kMatters * scale_J);
  });
}

/// The cause with the largest amount.
const Cause& largest_of(const EnergySplit& split) {
  return *std::max_element(kCauses.begin(), kCauses.end(), [&](const Cause& a, const Cause& b) {
    return std::abs(split.*a.joules) < std::abs(split.*b.joules);
  });
}

/// A share with its sign; what does not matter is 0.
std::string share_text(double joules, double scale_J) {
  const double share = joules / scale_J;
  if (std::abs(share) <= kMatters) return "0";
  return (share > 0.0 ? "+" : "") + number(share);
}

/// The causes that matter, as shares of the scale.
std::vector<BarPart> parts_of(const EnergySplit& split, double scale_J) {
  std::vector<BarPart> parts;
  for (std::size_t i = 0; i < kCauses.size(); ++i) {
    const double share = split.*kCauses[i].joules / scale_J;
    if (std::abs(share) > kMatters && std::isfinite(share)) parts.push_back({kCauses[i].name, i, share});
  }
  return parts;
}

/// A bar longer than the energy at the start is cut, so that an engine that explodes leaves the others to be
/// seen.
constexpr double kLongest = 1.0;

BarRange range_of(const SceneComparison& scene, double scale_J) {
  BarRange range;
  for (const RunComparison& run : scene.runs) {
    if (run.energy_split) range.take_in(parts_of(*run.energy_split, scale_J), kLongest);
  }
  return range;
}

void add_key(Node parent) {
  Node key = add(parent, "ul", {{"class", "key"}});
  for (std::size_t i = 0; i < kCauses.size(); ++i) {
    Node item = add(key, "li");
    add_bar_swatch(item, i);
    say(item, std::string(" ") + kCauses[i].name);
  }
}

/// What a bar shows, and where it may end on either side.
std::string bar_heading(const BarRange& range) {
  return fmt::format("lost ← 0 → gained, from {} to {}", number(-range.lost), number(range.gained));
}

void add_row(Node body, const std::string& label, const EnergySplit& split, double scale_J,
             const BarRange& range, const Legend& legend) {
  Node row = add(body, "tr");
  Node name = add(row, "th", {{"scope", "row"}});
  legend.add_swatch(name, label);
  say(name, " " + label);
  add_bar(add(row, "td"), "Energy by cause, " + label, parts_of(split, scale_J), range);
  for (const Cause& cause : kCauses) {
    const bool largest = &cause == &largest_of(split) && matters(split, scale_J);
    Node cell = add(row, "td", {{"class", "number"}});
    const std::string text = share_text(split.*cause.joules, scale_J);
    if (largest) {
      add(cell, "strong", {}, text);
    } else {
      say(cell, text);
    }
  }
  add_number(row, share_text(sum_of(split), scale_J));
}

}  // namespace

void add_energy_causes(Node parent, const SceneComparison& scene, const Legend& legend) {
  const double scale_J = Reference(*scene.scene).energy_scale_J;
  const bool any = std::any_of(scene.runs.begin(), scene.runs.end(), [&](const RunComparison& run) {
    return run.energy_split && matters(*run.energy_split, scale_J);
  });
  if (!any || !(scale_J > 0.0)) return;
  const BarRange range = range_of(scene, scale_J);
  std::vector<Heading> headings = {{"engine", ""}, {bar_heading(range), ""}};
  for (const Cause& cause : kCauses) headings.push_back({cause.name, "number"});
  headings.push_back({"all together", "number"});
  Node details = add_details(parent, "Where the energy went");
  add_key(details);
  Node body =
      add_table(details, "", "Energy gained (+) and lost (−), as a share of that at the start", headings);
  for (const RunComparison& run : scene.runs) {
    if (run.energy_split) add_row(body, run.run.label(), *run.energy_split, scale_J, range, legend);
  }
  add(details, "p", {{"class", "note"}},
      "Impacts are what normal pushes did to the motion, friction what pushes along surfaces did, position "
      "correction what moving overlapping balls apart did under gravity. Flight is the rest: drag, the "
      "errors of "
      "integration, and what an engine does to velocities without a push. "
      "The bars of a scene share one scale; one that ends in an arrowhead goes on, beyond all of the energy "
      "at "
      "the start.");
}

}  // namespace carom::page
