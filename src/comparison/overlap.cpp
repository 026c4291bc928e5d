#include "comparison/overlap.h"

#include <algorithm>
#include <cmath>
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
    const bool first = largest_radius_m_ == 0.0;
    smallest_radius_m_ = first ? ball.radius : std::min(smallest_radius_m_, ball.radius);
    largest_radius_m_ = std::max(largest_radius_m_, ball.radius);
  }
}

double OverlapSearch::deepest(std::span<const BallState> balls) {
  const double in_walls = deepest_in_walls(balls);
  if (!scenario_.effects.collisions) return in_walls;
  if (!list_holds(balls)) list(balls);
  return std::max(in_walls, deepest_in_pairs(balls));
}

double OverlapSearch::deepest_in_walls(std::span<const BallState> balls) const {
  double deepest = 0.0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const double radius = scenario_.balls[i].radius;
    for (const Wall& wall : scenario_.walls) {
      const double overlap = radius - (wall.normal.dot(balls[i].position) - wall.offset);
      if (overlap > 0.0) deepest = std::max(deepest, overlap / radius);
    }
  }
  return deepest;
}

double OverlapSearch::deepest_in_pairs(std::span<const BallState> balls) const {
  double deepest = 0.0;
  for (const auto& [a, b] : near_) {
    const double reach = radius(a) + radius(b);
    const Vec3 between = balls[b].position - balls[a].position;
    if (between.squaredNorm() >= reach * reach) continue;
    deepest = std::max(deepest, (reach - between.norm()) / std::min(radius(a), radius(b)));
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

void OverlapSearch::list(std::span<const BallState> balls) {
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
  if (largest_radius_m_ <= kMostSizeRatio * smallest_radius_m_) {
    list_by_cells(balls);
  } else {
    list_by_sweep(balls);
  }
}

/// Sorts along x and looks only at balls whose extents overlap there.
void OverlapSearch::list_by_sweep(std::span<const BallState> balls) {
  const auto left = [&](std::uint32_t i) { return balls[i].position.x() - radius(i); };
  order_.resize(balls.size());
  std::iota(order_.begin(), order_.end(), 0U);
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return left(a) < left(b); });
  for (std::size_t p = 0; p < order_.size(); ++p) {
    const std::uint32_t a = order_[p];
    const double right = balls[a].position.x() + radius(a) + 2.0 * margin_m_;
    for (std::size_t q = p + 1; q < order_.size() && left(order_[q]) < right; ++q)
      list_if_near(a, order_[q], balls);
  }
}

/// Looks only at balls in the same or in neighbouring cells, x fastest: three cells in a row are one stretch
/// of balls.
void OverlapSearch::list_by_cells(std::span<const BallState> balls) {
  sort_into_cells(balls);
  const auto [columns, rows, layers] = counts_;
  for (std::uint32_t place = 0; place < order_.size(); ++place) {
    const std::uint32_t ball = order_[place];
    const std::int64_t cell = cell_of_[ball];
    const std::int64_t x = cell % columns;
    const std::int64_t y = cell / columns % rows;
    const std::int64_t z = cell / columns / rows;
    const std::int64_t before = std::min<std::int64_t>(x, 1);
    const std::int64_t after = std::min<std::int64_t>(columns - 1 - x, 1);
    const std::uint32_t own_end = starts_[static_cast<std::size_t>(cell + after + 1)];
    for (std::uint32_t other = place + 1; other < own_end; ++other) list_if_near(ball, order_[other], balls);
    for (const auto& [dy, dz] : kRowsAfter) {
      if (y + dy < 0 || y + dy >= rows || z + dz >= layers) continue;
      const std::int64_t beside = cell + (dz * rows + dy) * columns;
      list_with(ball, beside - before, beside + after, balls);
    }
  }
}

/// Fills cell_of_, starts_ and order_: counts the balls of each cell, then puts each in its place.
void OverlapSearch::sort_into_cells(std::span<const BallState> balls) {
  Vec3 low = balls.empty() ? Vec3(Vec3::Zero()) : balls.front().position;
  Vec3 high = low;
  for (const BallState& ball : balls) {
    low = low.cwiseMin(ball.position);
    high = high.cwiseMax(ball.position);
  }
  const Vec3 extent_m = high - low;
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
    const Vec3 at = (balls[i].position - low) / width_m;
    cell_of_[i] =
        (static_cast<std::int64_t>(at.z()) * counts_[1] + static_cast<std::int64_t>(at.y())) * counts_[0] +
        static_cast<std::int64_t>(at.x());
    ++starts_[static_cast<std::size_t>(cell_of_[i])];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  order_.resize(balls.size());
  for (std::size_t i = balls.size(); i-- > 0;) {
    order_[--starts_[static_cast<std::size_t>(cell_of_[i])]] = static_cast<std::uint32_t>(i);
  }
}

void OverlapSearch::list_with(std::uint32_t ball, std::int64_t first_cell, std::int64_t last_cell,
                              std::span<const BallState> balls) {
  const std::uint32_t end = starts_[static_cast<std::size_t>(last_cell + 1)];
  for (std::uint32_t at = starts_[static_cast<std::size_t>(first_cell)]; at < end; ++at) {
    list_if_near(ball, order_[at], balls);
  }
}

void OverlapSearch::list_if_near(std::uint32_t a, std::uint32_t b, std::span<const BallState> balls) {
  const double reach = radius(a) + radius(b) + 2.0 * margin_m_;
  if ((balls[b].position - balls[a].position).squaredNorm() < reach * reach) near_.emplace_back(a, b);
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
