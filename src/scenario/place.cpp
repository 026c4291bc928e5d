#include "scenario/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "scenario/generate.h"

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

/// Where a ball is, the radius it has reached, and the next ball in its cell: what a search looks at lies
/// together.
struct Placed {
  Vec3 position;
  double size = 0.0;
  std::uint32_t next = 0;
};

/// Balls in square cells of the box, as linked lists, so that a moved ball changes its cell in O(1).
class Cells {
 public:
  Cells(const Box& box, int dimension, double width) : origin_(box.min) {
    for (int axis = 0; axis < dimension; ++axis) {
      const double extent = box.max[axis] - box.min[axis];
      // Cells no narrower than asked, and not many more of them than balls.
      const double most = dimension == 2 ? 1024.0 : 128.0;
      counts_[static_cast<std::size_t>(axis)] =
          static_cast<std::int64_t>(std::clamp(std::floor(extent / width), 1.0, most));
      inverse_width_[axis] = static_cast<double>(counts_[static_cast<std::size_t>(axis)]) / extent;
    }
    heads_.assign(static_cast<std::size_t>(counts_[0] * counts_[1] * counts_[2]), kEnd);
  }

  void insert(std::size_t ball, std::vector<Placed>& balls) {
    std::uint32_t& head = heads_[index(cell(balls[ball].position))];
    balls[ball].next = head;
    head = static_cast<std::uint32_t>(ball);
  }

  void remove(std::size_t ball, std::vector<Placed>& balls) {
    std::uint32_t* link = &heads_[index(cell(balls[ball].position))];
    while (*link != ball) link = &balls[*link].next;
    *link = balls[ball].next;
  }

  /// Calls visit(ball) for every ball in the cell of `at` and the cells around it, for as long as it returns
  /// true.
  template <class Visit>
  void around(const Vec3& at, const std::vector<Placed>& balls, Visit&& visit) const {
    const Cell centre = cell(at);
    Cell low;
    Cell high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::max<std::int64_t>(centre[axis] - 1, 0);
      high[axis] = std::min(centre[axis] + 1, counts_[axis] - 1);
    }
    for (std::int64_t z = low[2]; z <= high[2]; ++z) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        const std::uint32_t* const row = &heads_[index({0, y, z})];
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
          for (std::uint32_t ball = row[x]; ball != kEnd; ball = balls[ball].next) {
            if (!visit(ball)) return;
          }
        }
      }
    }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  static constexpr std::uint32_t kEnd = static_cast<std::uint32_t>(-1);

  Cell cell(const Vec3& at) const {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
      // A negative place, which the conversion would round up, is held to 0 like the others.
      const double place = (at[axis] - origin_[axis]) * inverse_width_[axis];
      const auto last = static_cast<double>(counts_[static_cast<std::size_t>(axis)] - 1);
      cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::clamp(place, 0.0, last));
    }
    return cell;
  }

  std::size_t index(const Cell& cell) const {
    return static_cast<std::size_t>((cell[2] * counts_[1] + cell[1]) * counts_[0] + cell[0]);
  }

  Vec3 origin_;
  Vec3 inverse_width_ = Vec3::Zero();
  std::array<std::int64_t, 3> counts_{1, 1, 1};
  std::vector<std::uint32_t> heads_;
};

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
        cells_(*scene.box, scene.dimension, 2.0 * (1.0 + kClearance) * largest_radius(radii, scene)) {
    for (double& radius : full_) radius *= 1.0 + kClearance;
    balls_.reserve(count_ + scene.balls.size());
    for (std::size_t i = 0; i < count_; ++i) balls_.push_back({anywhere()});
    for (const Ball& ball : scene.balls) balls_.push_back({ball.position, ball.radius});
    for (std::size_t i = 0; i < balls_.size(); ++i) cells_.insert(i, balls_);
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
  /// Two trials for every ball that is not grown, one near by and one anywhere in the box; one near by for
  /// those around it, so that room opens, and in every kStirAll-th sweep for all. Returns how many balls are
  /// grown.
  std::size_t sweep() {
    std::size_t grown = 0;
    ++sweeps_;
    for (std::size_t i = 0; i < count_; ++i) {
      const bool growing = balls_[i].size < full_[i];
      if (growing || stirred_[i] == sweeps_ || sweeps_ % kStirAll == 0)
        try_at(i, balls_[i].position + nudge(kStride * full_[i]));
      if (growing) try_at(i, anywhere());
      if (growing) try_at(i, balls_[i].position);
      if (balls_[i].size < full_[i]) {
        cells_.around(balls_[i].position, balls_, [this](std::size_t near) {
          stirred_[near] = sweeps_ + 1;
          return true;
        });
      } else {
        ++grown;
      }
    }
    return grown;
  }

  void try_at(std::size_t ball, const Vec3& at) {
    const double room = room_at(at, ball);
    if (!enough(room, ball)) return;
    cells_.remove(ball, balls_);
    balls_[ball].position = at;
    balls_[ball].size = std::min(room, full_[ball]);
    cells_.insert(ball, balls_);
  }

  /// Whether a ball can be moved to where it has this much room.
  bool enough(double room, std::size_t ball) const { return room >= balls_[ball].size && room > 0.0; }

  /// The largest radius, up to about the ball's full one, that a ball at this place may have; where that is
  /// not enough, anything else that is not.
  double room_at(const Vec3& at, std::size_t ball) const {
    double room = full_[ball];
    for (const Wall& wall : scene_.walls) room = std::min(room, wall.normal.dot(at) - wall.offset);
    for (const Slab& slab : scene_.slabs) room = std::min(room, room_beside(slab, at));
    for (const Barrier& barrier : scene_.barriers) room = std::min(room, room_beside(barrier, at));
    if (!enough(room, ball)) return room;
    cells_.around(at, balls_, [&](std::size_t other) {
      if (other == ball) return true;
      const double distance2 = (at - balls_[other].position).squaredNorm();
      const double reach = room + balls_[other].size;
      // A root for those alone that are near, with more to spare than it rounds.
      if (distance2 > reach * reach * (1.0 + 1e-12)) return true;
      room = std::min(room, std::sqrt(distance2) - balls_[other].size);
      return enough(room, ball);
    });
    return room;
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
  std::vector<Placed> balls_;
  std::vector<int> stirred_;  ///< the sweep in which a ball is to be moved, being near one that grows
  int sweeps_ = 0;
  Cells cells_;
};

}  // namespace

std::vector<Vec3> place_at_random(const std::vector<double>& radii, const Scenario& scene, Random& random) {
  return Placement(radii, scene, random).run();
}

}  // namespace carom
