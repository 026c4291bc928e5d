#include "report/page/polyline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom::page {

namespace {

constexpr double kTolerance_px = 0.15;  // below what a screen resolves
constexpr double kFarAway_px = 5000.0;  // outside of every drawing

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double square = dx * dx + dy * dy;
  const double along = square > 0.0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / square : 0.0;
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

/// The lowest and the highest point of each of equal shares of the line, in the order in which they come.
Polyline extremes(const Polyline& line, std::size_t shares) {
  Polyline kept;
  const auto by_height = [](const Point& a, const Point& b) { return a.y < b.y; };
  for (std::size_t i = 0; i < shares; ++i) {
    const auto begin = line.begin() + static_cast<std::ptrdiff_t>(line.size() * i / shares);
    const auto end = line.begin() + static_cast<std::ptrdiff_t>(line.size() * (i + 1) / shares);
    if (begin == end) continue;
    auto [low, high] = std::minmax_element(begin, end, by_height);
    if (high < low) std::swap(low, high);
    kept.push_back(*low);
    if (low != high) kept.push_back(*high);
  }
  return kept;
}

/// Leaves out every point that is no farther than `tolerance` from the line through those that stay.
/// Source: D. Douglas, T. Peucker, The Canadian Cartographer 10, 112 (1973).
Polyline simplified(const Polyline& line, double tolerance_px) {
  if (line.size() < 3) return line;
  std::vector<bool> keep(line.size(), false);
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> spans = {{0, line.size() - 1}};
  while (!spans.empty()) {
    const auto [first, last] = spans.back();
    spans.pop_back();
    double worst = tolerance_px;
    std::size_t farthest = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double distance = distance_to_segment(line[i], line[first], line[last]);
      if (distance > worst) {
        worst = distance;
        farthest = i;
      }
    }
    if (farthest == first) continue;
    keep[farthest] = true;
    spans.emplace_back(first, farthest);
    spans.emplace_back(farthest, last);
  }
  Polyline kept;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (keep[i]) kept.push_back(line[i]);
  }
  return kept;
}

bool goes_forward(const Polyline& line) {
  return std::is_sorted(line.begin(), line.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
}

}  // namespace

std::string px(double value) {
  const double tenths = std::round(10.0 * std::clamp(value, -kFarAway_px, kFarAway_px));
  return fmt::format("{}", tenths == 0.0 ? 0.0 : tenths / 10.0);
}

Polyline thinned(Polyline line, std::size_t at_most) {
  for (Point& p : line) {
    p.x = std::clamp(p.x, -kFarAway_px, kFarAway_px);
    p.y = std::clamp(p.y, -kFarAway_px, kFarAway_px);
  }
  // Only of a curve over time are the extremes of a share what is seen of it; a path in the plane turns back.
  if (line.size() > at_most && goes_forward(line)) line = extremes(line, at_most / 2);
  Polyline kept = simplified(line, kTolerance_px);
  for (double tolerance = 2.0 * kTolerance_px; kept.size() > at_most; tolerance *= 2.0) {
    kept = simplified(kept, tolerance);
  }
  return kept;
}

std::vector<Polyline> pieces(const Polyline& line) {
  std::vector<Polyline> found(1);
  for (const Point& p : line) {
    if (std::isfinite(p.x) && std::isfinite(p.y)) {
      found.back().push_back(p);
    } else if (!found.back().empty()) {
      found.emplace_back();
    }
  }
  if (found.back().empty()) found.pop_back();
  return found;
}

std::string path_data(const Polyline& line, std::size_t at_most) {
  std::string data;
  for (const Polyline& piece : pieces(line)) {
    char command = 'M';
    for (const Point& p : thinned(piece, at_most)) {
      data += command + px(p.x) + ' ' + px(p.y);
      command = 'L';
    }
    // A single point is drawn as a dot, by the round end of its line.
    if (piece.size() == 1) data += "h0";
  }
  return data;
}

}  // namespace carom::page
