#include "scenario/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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
      if (i + kAhead < balls_.size()) cells_.fetch(balls_[i + kAhead].position);
      cells_.insert(i, balls_);
    }
    stirred_.assign(balls_.size(), 1);  // all grow
  }

  std::vector<Vec3> run() {
    for (int waited = 0; grown_ < count_; ++waited) {
      if (waited > patience(count_)) {
        throw DoesNotFit(
            fmt::format("{} of {} balls fit into the box with the rest, and no more do", grown_, count_));
      }
      const std::size_t before = grown_;
      sweep();
      if (grown_ > before) waited = 0;
    }
    std::vector<Vec3> positions;
    positions.reserve(count_);
    for (std::size_t i = 0; i < count_; ++i) positions.push_back(balls_[i].position);
    return positions;
  }

 private:
  /// What the search around a ball will read is fetched while so many others have their turn.
  static constexpr std::size_t kAhead = 16;

  /// Where a ball is to be tried.
  struct Turn {
    std::uint32_t ball;
    Cells::Spot near_by;
    Cells::Spot elsewhere;  ///< of a ball that is not grown
  };
  /// Turns that are drawn and not played.
  struct Hand {
    std::array<Turn, kAhead> turns;
    std::size_t size = 0;
    bool growing = false;  ///< one of the balls is not grown
  };

  /// Two trials for every ball that is not grown, one near by and one anywhere in the box; one near by for
  /// those around it, so that room opens, and in every kStirAll-th sweep for all.
  ///
  /// A ball is changed in its own turn alone, so turns can be drawn before those ahead of them are played.
  void sweep() {
    ++sweeps_;
    Hand hand;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (!moves(i)) continue;
      if (hand.size == kAhead || (hand.growing && may_be_put_off(i))) play(hand);
      if (moves(i)) draw(i, hand);
    }
    play(hand);
  }

  /// Whether a ball has a turn in this sweep. One that is stirred for the next before it has its turn in this
  /// one is put off, unless it grows.
  bool moves(std::uint32_t ball) const {
    if (sweeps_ % kStirAll == 0 || stirred_[ball] == sweeps_) return true;
    return stirred_[ball] > sweeps_ && !grown(ball);
  }

  bool may_be_put_off(std::uint32_t ball) const { return sweeps_ % kStirAll != 0 && grown(ball); }

  bool grown(std::uint32_t ball) const { return balls_[ball].size >= full_[ball]; }

  void draw(std::uint32_t ball, Hand& hand) {
    Turn& turn = hand.turns[hand.size++];
    turn.ball = ball;
    turn.near_by = cells_.spot(balls_[ball].position + nudge(kStride * full_[ball]), full_[ball]);
    cells_.fetch(turn.near_by);
    if (grown(ball)) return;
    hand.growing = true;
    turn.elsewhere = cells_.spot(anywhere(), full_[ball]);
    cells_.fetch(turn.elsewhere);
  }

  void play(Hand& hand) {
    for (std::size_t i = 0; i < hand.size; ++i) play(hand.turns[i]);
    hand.size = 0;
    hand.growing = false;
  }

  /// The ball is taken out meanwhile, so that it is not in its own way.
  void play(const Turn& turn) {
    const std::uint32_t ball = turn.ball;
    const bool grows = !grown(ball);
    cells_.remove(ball, balls_);
    if (grows) {
      grow(turn);
    } else {
      try_at(turn.near_by, ball);
    }
    cells_.insert(ball, balls_);
    if (!grows) return;
    if (grown(ball)) {
      ++grown_;
    } else {
      cells_.around(balls_[ball].position, stirred_cells_, balls_,
                    [this](std::uint32_t near) { stirred_[near] = sweeps_ + 1; });
    }
  }

  /// Near by, then elsewhere, then where the ball is. Elsewhere is looked at first: where it has all the room
  /// there, it does not matter what near by would give.
  void grow(const Turn& turn) {
    const std::uint32_t ball = turn.ball;
    const double room = room_at(turn.elsewhere, ball);
    if (room < full_[ball]) try_at(turn.near_by, ball);
    move_to(turn.elsewhere, room, ball);
    if (!grown(ball)) try_at(cells_.spot(balls_[ball].position, full_[ball]), ball);
  }

  void try_at(const Cells::Spot& spot, std::uint32_t ball) { move_to(spot, room_at(spot, ball), ball); }

  /// Moves a ball if there is as much room as it fills already.
  void move_to(const Cells::Spot& spot, double room, std::uint32_t ball) {
    if (!enough(room, ball)) return;
    balls_[ball] = {spot.at, std::min(room, full_[ball])};
  }

  /// Whether a ball can be moved to where it has this much room.
  bool enough(double room, std::uint32_t ball) const { return room >= balls_[ball].size && room > 0.0; }

  /// The largest radius, up to about the ball's full one, that a ball at this place may have; where that is
  /// not enough, anything else that is not.
  double room_at(const Cells::Spot& spot, std::uint32_t ball) const {
    const Vec3& at = spot.at;
    double room = full_[ball];
    for (const Wall& wall : scene_.walls) room = std::min(room, wall.normal.dot(at) - wall.offset);
    for (const Slab& slab : scene_.slabs) room = std::min(room, room_beside(slab, at));
    for (const Barrier& barrier : scene_.barriers) room = std::min(room, room_beside(barrier, at));
    if (!enough(room, ball)) return room;
    const bool through = cells_.near(spot, balls_[ball].size, room, [&](std::uint32_t other) {
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
  /// The sweep in which a ball is to be moved, for it grows or is near one that does.
  std::vector<int> stirred_;
  int sweeps_ = 0;
  std::size_t grown_ = 0;  ///< balls
};

}  // namespace

std::vector<Vec3> place_at_random(const std::vector<double>& radii, const Scenario& scene, Random& random) {
  return Placement(radii, scene, random).run();
}

}  // namespace carom
