#include "scenario/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/large_pages.h"
#include "scenario/generate.h"
#include "scenario/place_cells.h"

namespace carom {

namespace {

/// Room left between surfaces, relative to the radius: far above round-off (1e-16), so that no engine, in
/// single precision on its own scale or not, finds two balls touching that were meant to be apart, far below
/// anything that is seen.
constexpr double kClearance = 1e-9;

/// How far a ball is moved in one trial at most, in its radii: the gaps of a dense fluid are of this size.
constexpr double kStride = 0.5;

/// Sweeps without a single further ball at its full size after which the placement gives up. In a fluid of
/// many balls one arrives nearly every sweep; among few, or among very different ones, the last can wait for
/// thousands.
int patience(std::size_t balls) {
  constexpr std::size_t kTrials = 4'000'000;
  return static_cast<int>(std::max<std::size_t>(400, kTrials / std::max<std::size_t>(balls, 1000)));
}

/// Only balls near one that still grows are moved in most sweeps; a dense corner is relieved from further
/// away.
constexpr int kStirAll = 4;

double largest_radius(const std::vector<double>& radii, const Scenario& scene) {
  double largest = radii.empty() ? 0.0 : *std::max_element(radii.begin(), radii.end());
  for (const Ball& ball : scene.balls) largest = std::max(largest, ball.radius);
  return largest;
}

class Placement {
 public:
  Placement(const std::vector<double>& radii, const Scenario& scene, Random& random)
      : scene_(scene),
        random_(random),
        count_(radii.size()),
        full_(radii),
        largest_((1.0 + kClearance) * largest_radius(radii, scene)),
        stirred_cells_(*scene.box, scene.dimension, 2.0 * largest_, scene.dimension == 2 ? 1024.0 : 128.0),
        cells_(*scene.box, scene.dimension, count_ + scene.balls.size(), largest_) {
    for (double& radius : full_) radius *= 1.0 + kClearance;
    balls_.reserve(count_ + scene.balls.size());
    for (std::size_t i = 0; i < count_; ++i) balls_.push_back({anywhere()});
    for (const Ball& ball : scene.balls) balls_.push_back({ball.position, ball.radius});
    for (std::uint32_t i = 0; i < balls_.size(); ++i) {
      if (i + kAhead < balls_.size()) cells_.foresee(balls_[i + kAhead].position, 0.0);
      cells_.insert(i, balls_);
    }
    stirred_.assign(balls_.size(), 0);
  }

  std::vector<Vec3> run() {
    std::size_t grown = 0;
    for (int waited = 0; grown < count_; ++waited) {
      if (waited > patience(count_)) {
        throw DoesNotFit(
            fmt::format("{} of {} balls fit into the box with the rest, and no more do", grown, count_));
      }
      const std::size_t now = sweep();
      if (now > grown) waited = 0;
      grown = now;
    }
    std::vector<Vec3> positions;
    positions.reserve(count_);
    for (std::size_t i = 0; i < count_; ++i) positions.push_back(balls_[i].position);
    return positions;
  }

 private:
  /// What the search around a ball will read is fetched while so many others have their turn.
  static constexpr std::uint32_t kAhead = 8;

  /// Two trials for every ball that is not grown, one near by and one anywhere in the box; one near by for
  /// those around it, so that room opens, and in every kStirAll-th sweep for all. Returns how many balls are
  /// grown.
  std::size_t sweep() {
    std::size_t grown = 0;
    ++sweeps_;
    for (std::uint32_t i = 0; i < count_; ++i) {
      const std::uint32_t ahead = i + kAhead;
      if (ahead < count_ && moves(ahead)) cells_.foresee(balls_[ahead].position, full_[ahead]);
      if (moves(i)) move(i);
      if (balls_[i].size >= full_[i]) ++grown;
    }
    return grown;
  }

  /// Whether a ball has a turn in this sweep.
  bool moves(std::uint32_t ball) const {
    return balls_[ball].size < full_[ball] || stirred_[ball] == sweeps_ || sweeps_ % kStirAll == 0;
  }

  void move(std::uint32_t ball) {
    const Placed& placed = balls_[ball];
    const Vec3 near_by = placed.position + nudge(kStride * full_[ball]);
    if (placed.size >= full_[ball]) {
      try_at(ball, near_by);
      return;
    }
    const Vec3 elsewhere = anywhere();
    cells_.foresee(elsewhere, full_[ball]);
    try_at(ball, near_by);
    try_at(ball, elsewhere);
    if (placed.size >= full_[ball]) return;
    try_at(ball, placed.position);
    if (placed.size >= full_[ball]) return;
    cells_.around(placed.position, stirred_cells_, balls_,
                  [this](std::uint32_t near) { stirred_[near] = sweeps_ + 1; });
  }

  void try_at(std::uint32_t ball, const Vec3& at) {
    const double room = room_at(at, ball);
    if (!enough(room, ball)) return;
    cells_.remove(ball, balls_);
    balls_[ball].position = at;
    balls_[ball].size = std::min(room, full_[ball]);
    cells_.insert(ball, balls_);
  }

  /// Whether a ball can be moved to where it has this much room.
  bool enough(double room, std::uint32_t ball) const { return room >= balls_[ball].size && room > 0.0; }

  /// The largest radius, up to about the ball's full one, that a ball at this place may have; where that is
  /// not enough, anything else that is not.
  double room_at(const Vec3& at, std::uint32_t ball) const {
    double room = full_[ball];
    for (const Wall& wall : scene_.walls) room = std::min(room, wall.normal.dot(at) - wall.offset);
    for (const Slab& slab : scene_.slabs) room = std::min(room, room_beside(slab, at));
    for (const Barrier& barrier : scene_.barriers) room = std::min(room, room_beside(barrier, at));
    if (!enough(room, ball)) return room;
    const bool through = cells_.near(at, ball, room, balls_, [&](std::uint32_t other) {
      const double distance2 = (at - balls_[other].position).squaredNorm();
      const double reach = room + balls_[other].size;
      // A root for those alone that are near, with more to spare than it rounds.
      if (distance2 > reach * reach * (1.0 + 1e-12)) return true;
      room = std::min(room, std::sqrt(distance2) - balls_[other].size);
      return enough(room, ball);
    });
    return through ? room : 0.0;
  }

  template <class Sheet>
  static double room_beside(const Sheet& sheet, const Vec3& at) {
    return std::abs(sheet.normal.dot(at) - sheet.offset) - 0.5 * sheet.thickness;
  }

  Vec3 anywhere() {
    Vec3 at = Vec3::Zero();
    for (int axis = 0; axis < scene_.dimension; ++axis) {
      at[axis] = random_.uniform(scene_.box->min[axis], scene_.box->max[axis]);
    }
    return at;
  }

  Vec3 nudge(double stride) {
    Vec3 by = Vec3::Zero();
    for (int axis = 0; axis < scene_.dimension; ++axis) by[axis] = random_.uniform(-stride, stride);
    return by;
  }

  const Scenario& scene_;
  Random& random_;
  std::size_t count_;         ///< balls to place; behind them stand those that are there already
  std::vector<double> full_;  ///< the radius each is to reach
  double largest_;            ///< of these and of the balls that are there already
  Grid stirred_cells_;        ///< the balls of neighbouring ones are stirred together
  Cells cells_;
  Column<Placed> balls_;
  std::vector<int> stirred_;  ///< the sweep in which a ball is to be moved, being near one that grows
  int sweeps_ = 0;
};

}  // namespace

std::vector<Vec3> place_at_random(const std::vector<double>& radii, const Scenario& scene, Random& random) {
  return Placement(radii, scene, random).run();
}

}  // namespace carom
