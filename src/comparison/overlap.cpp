#include "comparison/overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace carom {

namespace {

/// A list is to last for about so many frames.
constexpr double kFramesListed = 3.0;
/// Cells as wide as the largest balls are of use while the smallest ones do not crowd them.
constexpr double kMostSizeRatio = 4.0;
/// Cells to a ball at most, however much room there is.
constexpr double kMostCellsPerBall = 4.0;
/// By how many cells pairs can be apart along y and z where the second comes after the first: half of the
/// eight around one, for each pair to be seen once.
constexpr std::array<std::array<std::int64_t, 2>, 4> kRowsAfter = {{{1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

}  // namespace

OverlapSearch::OverlapSearch(const Scenario& scenario) : scenario_(scenario) {
  for (const Ball& ball : scenario.balls) {
    const bool first = radii_m_.empty();
    smallest_radius_m_ = first ? ball.radius : std::min(smallest_radius_m_, ball.radius);
    largest_radius_m_ = std::max(largest_radius_m_, ball.radius);
    radii_m_.push_back(ball.radius);
  }
}

double OverlapSearch::deepest(std::span<const BallState> balls) {
  const Extent extent = extent_of(balls);
  const double in_walls = deepest_in_walls(balls, extent);
  if (!scenario_.effects.collisions) return in_walls;
  if (!list_holds(balls)) list(balls, extent);
  return std::max(in_walls, deepest_in_pairs(balls));
}

OverlapSearch::Extent OverlapSearch::extent_of(std::span<const BallState> balls) {
  if (balls.empty()) return {Vec3::Zero(), Vec3::Zero()};
  Extent extent{balls.front().position, balls.front().position};
  for (const BallState& ball : balls) {
    extent.low = extent.low.cwiseMin(ball.position);
    extent.high = extent.high.cwiseMax(ball.position);
  }
  return extent;
}

/// Whether not even the corner of the box of all centres that is nearest to a wall is as near as the largest
/// radius, by more than the rounding of n·x: three products and their sum, of which each errs by ½ ε.
bool OverlapSearch::clear_of(const Wall& wall, const Extent& extent) const {
  const Vec3 of_low = wall.normal.cwiseProduct(extent.low);
  const Vec3 of_high = wall.normal.cwiseProduct(extent.high);
  const double nearest_m = of_low.cwiseMin(of_high).sum() - wall.offset;
  const double size_m = of_low.cwiseAbs().cwiseMax(of_high.cwiseAbs()).sum() + std::abs(wall.offset);
  constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();
  return nearest_m > largest_radius_m_ + kRounding * size_m;
}

double OverlapSearch::deepest_in_walls(std::span<const BallState> balls, const Extent& extent) const {
  double deepest = 0.0;
  for (const Wall& wall : scenario_.walls) {
    if (clear_of(wall, extent)) continue;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const double overlap = radii_m_[i] - (wall.normal.dot(balls[i].position) - wall.offset);
      if (overlap > 0.0) deepest = std::max(deepest, overlap / radii_m_[i]);
    }
  }
  return deepest;
}

double OverlapSearch::deepest_in_pairs(std::span<const BallState> balls) const {
  double deepest = 0.0;
  for (const auto& [a, b] : near_) {
    const double reach = radii_m_[a] + radii_m_[b];
    const Vec3 between = balls[b].position - balls[a].position;
    if (between.squaredNorm() >= reach * reach) continue;
    deepest = std::max(deepest, (reach - between.norm()) / std::min(radii_m_[a], radii_m_[b]));
  }
  return deepest;
}

bool OverlapSearch::list_holds(std::span<const BallState> balls) const {
  if (listed_at_.empty() || margin_m_ == 0.0) return false;
  const double farthest_m2 = margin_m_ * margin_m_;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    if ((balls[i].position - listed_at_[i]).squaredNorm() > farthest_m2) return false;
  }
  return true;
}

void OverlapSearch::list(std::span<const BallState> balls, const Extent& extent) {
  if (!listed_at_.empty()) {
    double moved_m2 = 0.0;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      moved_m2 = std::max(moved_m2, (balls[i].position - listed_at_[i]).squaredNorm());
    }
    // Of the first list, made without a margin, that was in one frame; later ones lasted as long as they are
    // to.
    const double wanted_m = margin_m_ == 0.0 ? kFramesListed * std::sqrt(moved_m2) : margin_m_;
    margin_m_ = wanted_m <= smallest_radius_m_ ? wanted_m : 0.0;
  }
  listed_at_.resize(balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i) listed_at_[i] = balls[i].position;
  near_.clear();
  sorted_.resize(balls.size());
  if (largest_radius_m_ <= kMostSizeRatio * smallest_radius_m_) {
    list_by_cells(balls, extent);
  } else {
    list_by_sweep(balls);
  }
}

/// Sorts along x and looks only at balls whose extents overlap there.
void OverlapSearch::list_by_sweep(std::span<const BallState> balls) {
  const auto left = [](const Listed& each) { return each.position.x() - each.radius; };
  for (std::size_t i = 0; i < balls.size(); ++i) {
    sorted_[i] = {balls[i].position, radii_m_[i], static_cast<std::uint32_t>(i)};
  }
  std::sort(sorted_.begin(), sorted_.end(),
            [&](const Listed& a, const Listed& b) { return left(a) < left(b); });
  for (std::size_t p = 0; p < sorted_.size(); ++p) {
    const Listed& a = sorted_[p];
    const double right = a.position.x() + a.radius + 2.0 * margin_m_;
    for (std::size_t q = p + 1; q < sorted_.size() && left(sorted_[q]) < right; ++q)
      list_if_near(a, sorted_[q]);
  }
}

/// Looks only at balls in the same or in neighbouring cells.
void OverlapSearch::list_by_cells(std::span<const BallState> balls, const Extent& extent) {
  sort_into_cells(balls, extent);
  for (std::int64_t z = 0; z < counts_[2]; ++z) {
    for (std::int64_t y = 0; y < counts_[1]; ++y) {
      for (std::int64_t x = 0; x < counts_[0]; ++x) list_around({x, y, z});
    }
  }
}

/// The pairs of the balls in a cell with each other and with those in the cells after it, so that each pair
/// is seen once. Three cells in a row are one stretch of sorted_.
void OverlapSearch::list_around(const Cell& cell) {
  const auto [x, y, z] = cell;
  const std::uint32_t first = starts_[index(cell)];
  const std::uint32_t last = starts_[index(cell) + 1];
  if (first == last) return;
  const std::int64_t left = std::max<std::int64_t>(x - 1, 0);
  const std::int64_t right = std::min(x + 1, counts_[0] - 1);
  const std::uint32_t row_end = starts_[index({right, y, z}) + 1];
  for (std::uint32_t a = first; a < last; ++a) {
    for (std::uint32_t b = a + 1; b < row_end; ++b) list_if_near(sorted_[a], sorted_[b]);
  }
  for (const auto& [dy, dz] : kRowsAfter) {
    if (y + dy < 0 || y + dy >= counts_[1] || z + dz >= counts_[2]) continue;
    const std::uint32_t begin = starts_[index({left, y + dy, z + dz})];
    const std::uint32_t end = starts_[index({right, y + dy, z + dz}) + 1];
    for (std::uint32_t a = first; a < last; ++a) {
      for (std::uint32_t b = begin; b < end; ++b) list_if_near(sorted_[a], sorted_[b]);
    }
  }
}

/// Fills cell_of_, starts_ and sorted_: counts the balls of each cell, then puts each in its place.
void OverlapSearch::sort_into_cells(std::span<const BallState> balls, const Extent& extent) {
  const Vec3 extent_m = extent.high - extent.low;
  // Wider than a pair that is listed is apart, by more than what dividing by it rounds.
  double width_m = 2.0 * (largest_radius_m_ + margin_m_) * (1.0 + 1e-9);
  const auto cells = [&] { return (extent_m / width_m).array().floor() + 1.0; };
  while (cells().prod() > kMostCellsPerBall * static_cast<double>(balls.size()) + 1.0) width_m *= 1.26;  // ∛2
  const Vec3 counts = cells();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    counts_[axis] = static_cast<std::int64_t>(counts[static_cast<Eigen::Index>(axis)]);
  }
  cell_of_.resize(balls.size());
  starts_.assign(static_cast<std::size_t>(counts.prod()) + 1, 0);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Vec3 at = (balls[i].position - extent.low) / width_m;
    cell_of_[i] = index({static_cast<std::int64_t>(at.x()), static_cast<std::int64_t>(at.y()),
                         static_cast<std::int64_t>(at.z())});
    ++starts_[cell_of_[i]];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  for (std::size_t i = balls.size(); i-- > 0;) {
    sorted_[--starts_[cell_of_[i]]] = {balls[i].position, radii_m_[i], static_cast<std::uint32_t>(i)};
  }
}

std::size_t OverlapSearch::index(const Cell& cell) const {
  return static_cast<std::size_t>((cell[2] * counts_[1] + cell[1]) * counts_[0] + cell[0]);
}

void OverlapSearch::list_if_near(const Listed& a, const Listed& b) {
  const double reach = a.radius + b.radius + 2.0 * margin_m_;
  if ((b.position - a.position).squaredNorm() < reach * reach) near_.emplace_back(a.ball, b.ball);
}

namespace {

double deepest_in_walls(const Scenario& scenario, const Cast& cast, std::span<const BallState> balls) {
  double deepest = 0.0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    if (!cast[i]) continue;
    const double radius = cast[i]->radius;
    for (const Wall& wall : scenario.walls) {
      const double overlap = radius - (wall.normal.dot(balls[i].position) - wall.offset);
      deepest = std::max(deepest, overlap / radius);
    }
  }
  return deepest;
}

double deepest_in_pairs(const Cast& cast, std::span<const BallState> balls) {
  const auto radius = [&](std::size_t i) { return cast[i]->radius; };
  const auto left = [&](std::size_t i) { return balls[i].position.x() - radius(i); };
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    if (cast[i]) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return left(a) < left(b); });

  double deepest = 0.0;
  for (std::size_t p = 0; p < order.size(); ++p) {
    const std::size_t a = order[p];
    const double right = balls[a].position.x() + radius(a);
    for (std::size_t q = p + 1; q < order.size() && left(order[q]) < right; ++q) {
      const std::size_t b = order[q];
      const double reach = radius(a) + radius(b);
      const Vec3 between = balls[b].position - balls[a].position;
      if (between.squaredNorm() >= reach * reach) continue;
      deepest = std::max(deepest, (reach - between.norm()) / std::min(radius(a), radius(b)));
    }
  }
  return deepest;
}

}  // namespace

double deepest_overlap(const Scenario& scenario, const Cast& cast, std::span<const BallState> balls) {
  const double in_walls = deepest_in_walls(scenario, cast, balls);
  return scenario.effects.collisions ? std::max(in_walls, deepest_in_pairs(cast, balls)) : in_walls;
}

double deepest_overlap(const Scenario& scenario, std::span<const BallState> balls) {
  return deepest_overlap(scenario, Cast(scenario), balls);
}

}  // namespace carom
