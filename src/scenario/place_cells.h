#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/large_pages.h"
#include "core/vec.h"
#include "scenario/scenario.h"

namespace carom {

/// A box cut into equal cells, counted along each axis. What is outside of it is counted to the cell beside.
class Grid {
 public:
  using Place = std::array<std::int64_t, 3>;

  /// @param width  m, of a cell at least
  /// @param most  cells along an axis
  Grid(const Box& box, int dimension, double width, double most) : corner_(box.min) {
    for (int axis = 0; axis < dimension; ++axis) {
      const double extent = box.max[axis] - box.min[axis];
      counts_[static_cast<std::size_t>(axis)] =
          static_cast<std::int64_t>(std::clamp(std::floor(extent / width), 1.0, most));
      inverse_width_[axis] = static_cast<double>(counts_[static_cast<std::size_t>(axis)]) / extent;
      width_[axis] = 1.0 / inverse_width_[axis];
    }
  }

  std::size_t size() const { return static_cast<std::size_t>(counts_[0] * counts_[1] * counts_[2]); }

  Place place(const Vec3& at) const {
    Place place{};
    for (int axis = 0; axis < 3; ++axis) {
      // A negative place, which the conversion would round up, is held to 0 like the others.
      const double cells = (at[axis] - corner_[axis]) * inverse_width_[axis];
      const auto last = static_cast<double>(counts_[static_cast<std::size_t>(axis)] - 1);
      place[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::clamp(cells, 0.0, last));
    }
    return place;
  }

  std::size_t index(const Place& place) const {
    return static_cast<std::size_t>((place[2] * counts_[1] + place[1]) * counts_[0] + place[0]);
  }

  /// The lower corner of the cell that is so many cells farther along each axis.
  Vec3 corner(const Place& place, std::int64_t farther) const {
    Vec3 cells;
    for (int axis = 0; axis < 3; ++axis) {
      cells[axis] = static_cast<double>(place[static_cast<std::size_t>(axis)] + farther);
    }
    return corner_ + cells.cwiseProduct(width_);
  }

  /// Whether a place is in this cell or in one around it.
  bool beside(const Place& centre, const Vec3& at) const {
    const Place other = place(at);
    bool beside = true;
    for (std::size_t axis = 0; axis < 3; ++axis) beside = beside && std::abs(other[axis] - centre[axis]) <= 1;
    return beside;
  }

  /// Calls visit(index) for every cell that has part in a block, for as long as it returns true.
  template <class Visit>
  void for_each_between(const Vec3& low_corner, const Vec3& high_corner, Visit&& visit) const {
    const Place low = place(low_corner);
    const Place high = place(high_corner);
    for (std::int64_t z = low[2]; z <= high[2]; ++z) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        const std::size_t row = index({0, y, z});
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
          if (!visit(row + static_cast<std::size_t>(x))) return;
        }
      }
    }
  }

 private:
  Vec3 corner_;
  Vec3 inverse_width_ = Vec3::Zero();
  Vec3 width_ = Vec3::Ones();
  Place counts_{1, 1, 1};
};

/// Where a ball is, the radius it has reached, and the next ball of its cell that has no slot there.
struct Placed {
  Vec3 position;
  double size = 0.0;
  std::uint32_t next = 0;
};

/// The balls by the cells that they are in.
///
/// Of a million balls, what is around a place lies in memory that no near cache holds, and a search takes as
/// long as it waits for it. So a cell is one line of memory, in which its first three balls stand themselves,
/// in single precision: a sieve. Few others are looked at, and foresee() has the lines fetched while other
/// balls have their turn.
///
/// Loading a million balls takes 0.53 of what it took with cells that were chains of balls. With large pages
/// alone it took 0.93 of that, with one ball in its cell and the others in a chain 0.85, and without
/// foresee() nothing was gained. It costs a line of memory for each ball while balls are placed.
class Cells {
 public:
  /// @param count  of balls there will be
  /// @param largest  m, the radius that none exceeds
  Cells(const Box& box, int dimension, std::size_t count, double largest)
      : corner_(box.min),
        per_m_(1.0 / (box.max - box.min).maxCoeff()),
        largest_m_(largest),
        grid_(as_many_as(count, box, dimension)),
        cells_(grid_.size()) {}

  void insert(std::uint32_t ball, Column<Placed>& balls) {
    Cell& cell = cells_[grid_.index(grid_.place(balls[ball].position))];
    for (Slot& slot : cell.slots) {
      if (slot.ball != kNone) continue;
      slot = slot_of(ball, balls);
      return;
    }
    balls[ball].next = std::exchange(cell.more, ball);
  }

  void remove(std::uint32_t ball, Column<Placed>& balls) {
    Cell& cell = cells_[grid_.index(grid_.place(balls[ball].position))];
    for (Slot& slot : cell.slots) {
      if (slot.ball != ball) continue;
      slot = Slot();
      if (cell.more == kNone) return;
      slot = slot_of(cell.more, balls);
      cell.more = balls[cell.more].next;
      return;
    }
    std::uint32_t* link = &cell.more;
    while (*link != ball) link = &balls[*link].next;
    *link = balls[ball].next;
  }

  /// Calls visit(ball) for every ball in the box that is in the cell of another grid where `at` is or in one
  /// around it, and for some outside of the box, which that grid counts to the cells beside.
  template <class Visit>
  void around(const Vec3& at, const Grid& other, const Column<Placed>& balls, Visit&& visit) const {
    const Grid::Place centre = other.place(at);
    const Vec3 low = other.corner(centre, -1);
    const Vec3 high = other.corner(centre, 2);
    const Rough error = Rough::Constant(rough(error_m(0.0)));
    const Box3f outer(rough(low) - error, rough(high) + error);
    const Box3f inner(rough(low) + error, rough(high) - error);
    grid_.for_each_between(low, high, [&](std::size_t index) {
      const Cell& cell = cells_[index];
      for (const Slot& slot : cell.slots) {
        if (!outer.contains(slot.at)) continue;
        if (inner.contains(slot.at) || other.beside(centre, balls[slot.ball].position)) visit(slot.ball);
      }
      for (std::uint32_t ball = cell.more; ball != kNone; ball = balls[ball].next) {
        if (other.beside(centre, balls[ball].position)) visit(ball);
      }
      return true;
    });
  }

  /// Calls visit(other) for every other ball whose surface may be within `room` of a place, for as long as it
  /// returns true, and ends where one is surely nearer than the ball's own radius.
  /// @return whether it went through
  template <class Visit>
  bool near(const Vec3& at, std::uint32_t ball, double room, const Column<Placed>& balls,
            Visit&& visit) const {
    const Rough centre = rough(at);
    // The sum is rounded, and nobody may be left out by it.
    const double reach = std::nextafter(room + largest_m_, std::numeric_limits<double>::infinity());
    const double error = error_m(reach);
    const float outer = rough(room + error);
    const float inner = rough(balls[ball].size - error);
    bool through = true;
    grid_.for_each_between(at - Vec3::Constant(reach), at + Vec3::Constant(reach), [&](std::size_t index) {
      const Cell& cell = cells_[index];
      for (const Slot& slot : cell.slots) {
        const float square = (slot.at - centre).squaredNorm();
        const float far = outer + slot.size;
        if (!(square <= far * far) || slot.ball == ball) continue;
        const float close = inner + slot.size;
        through = !(close > 0.0F && square < close * close) && visit(slot.ball);
        if (!through) return false;
      }
      for (std::uint32_t other = cell.more; other != kNone; other = balls[other].next) {
        if (other == ball) continue;
        through = visit(other);
        if (!through) return false;
      }
      return true;
    });
    return through;
  }

  /// Has what near() will read fetched from memory meanwhile.
  void foresee(const Vec3& at, double room) const {
    const double reach = room + largest_m_;
    grid_.for_each_between(at - Vec3::Constant(reach), at + Vec3::Constant(reach), [&](std::size_t index) {
      __builtin_prefetch(&cells_[index]);
      // Without it GCC takes this for a function without effect, and leaves out the calls.
      std::atomic_signal_fence(std::memory_order_seq_cst);
      return true;
    });
  }

 private:
  static constexpr std::uint32_t kNone = static_cast<std::uint32_t>(-1);
  /// From the box's corner, by its longest side: in a unit of the scene's own nothing is too large or too
  /// small for single precision.
  using Rough = Eigen::Vector3f;
  using Box3f = Eigen::AlignedBox3f;

  /// A ball, or none, which is near nothing.
  struct Slot {
    Rough at = Rough::Constant(std::numeric_limits<float>::quiet_NaN());
    float size = 0.0F;
    std::uint32_t ball = kNone;
  };
  struct alignas(64) Cell {
    std::array<Slot, 3> slots;
    std::uint32_t more = kNone;  ///< the first ball without a slot
  };
  static_assert(sizeof(Cell) == 64);

  /// Of cells that are as many as the balls few hold more than three. Along a side that is much longer than
  /// the others there are fewer, so that in a flat box they do not outnumber the balls by much.
  static Grid as_many_as(std::size_t count, const Box& box, int dimension) {
    double volume = 1.0;
    for (int axis = 0; axis < dimension; ++axis) volume *= box.max[axis] - box.min[axis];
    constexpr double kLongest = 8.0;
    const double along_cube = std::pow(static_cast<double>(count), 1.0 / dimension);
    return {box, dimension, std::pow(volume, 1.0 / dimension) / along_cube,
            std::max(1.0, kLongest * along_cube)};
  }

  /// How far a rough distance may be off, with one of two rough sizes added: with u = 2⁻²⁴ each of two places
  /// errs by √3 u of the longest side, their difference, its square and the root of that by 5 u of what comes
  /// out, and sizes and their sum by 2 u of the reach. That is less than 11 u of both together, and 16 u are
  /// taken.
  double error_m(double reach) const { return 0x1p-20 * (1.0 / per_m_ + reach); }

  Slot slot_of(std::uint32_t ball, const Column<Placed>& balls) const {
    return {rough(balls[ball].position), rough(balls[ball].size), ball};
  }
  Rough rough(const Vec3& at) const { return ((at - corner_) * per_m_).cast<float>(); }
  float rough(double length_m) const { return static_cast<float>(length_m * per_m_); }

  Vec3 corner_;
  double per_m_;  ///< 1/m, of the longest side of the box
  double largest_m_;
  Grid grid_;
  Column<Cell> cells_;
};

}  // namespace carom
