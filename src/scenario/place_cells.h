#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <experimental/simd>
#include <limits>
#include <utility>

#include "core/large_pages.h"
#include "core/prefetch.h"
#include "core/vec.h"
#include "scenario/place_grid.h"
#include "scenario/scenario.h"

namespace carom {

namespace stdx = std::experimental;

/// Where a ball is, and the radius it has reached; in one line of memory.
struct alignas(32) Placed {
  Vec3 position;
  double size = 0.0;
};

/// The balls by the cells that they are in.
///
/// Of a million balls, what is around a place lies in memory that no near cache holds, and a search takes as
/// long as it waits for it. So a cell is one line of memory, a sieve: seven balls stand in it, in numbers of
/// 16 bits, and one instruction looks at all of them. Few others are looked at, and fetch() has the lines
/// fetched while other balls have their turn. SPEED.md says what that is worth.
///
/// The trick: places are counted in steps from the box's corner, modulo 2¹⁶, as a clock counts hours. No two
/// that are compared are half a round apart, so their difference is right, in a box of any size.
class Cells {
 public:
  /// A place where a ball is tried, and the cells with all that may be in its way there.
  struct Spot {
    Vec3 at;
    Grid::Block cells;
  };

  /// @param count  of balls there will be
  /// @param largest  m, the radius that none exceeds
  Cells(const Box& box, int dimension, std::size_t count, double largest)
      : box_(box),
        axes_(static_cast<std::size_t>(dimension)),
        largest_m_(largest),
        grid_(a_few_in_each(count, box, dimension)),
        per_m_(kFarthest * kCoarse / (2.0 * largest + grid_.longest_side(dimension))),
        cells_(grid_.size()),
        names_(grid_.size()),
        next_(count, kNone) {}

  void insert(std::uint32_t ball, const Column<Placed>& balls) {
    const auto& [position, size] = balls[ball];
    const std::size_t index = grid_.index(grid_.place(position));
    Cell& cell = cells_[index];
    Names& names = names_[index];
    const std::size_t slot = box_has(position) ? free_slot(cell) : kCrowd;
    if (slot == kCrowd) {
      next_[ball] = std::exchange(names[kCrowd], ball);
      cell.size[kCrowd] = 0;
      return;
    }
    names[slot] = ball;
    cell.size[slot] = static_cast<Size>(size * per_m_ + 1.0);
    const Code at = code(position);
    for (std::size_t axis = 0; axis < 3; ++axis) cell.at[axis][slot] = at[axis];
  }

  void remove(std::uint32_t ball, const Column<Placed>& balls) {
    const std::size_t index = grid_.index(grid_.place(balls[ball].position));
    Cell& cell = cells_[index];
    Names& names = names_[index];
    for (std::size_t slot = 0; slot < kCrowd; ++slot) {
      if (names[slot] != ball) continue;
      names[slot] = kNone;
      cell.size[slot] = kNobody;
      return;
    }
    std::uint32_t* link = &names[kCrowd];
    while (*link != ball) link = &next_[*link];
    *link = next_[ball];
    if (names[kCrowd] == kNone) cell.size[kCrowd] = kNobody;
  }

  /// Calls visit(ball) for every ball in the box that is in the cell of another grid where `at` is or in one
  /// around it, and for some outside of the box, which that grid counts to the cells beside.
  template <class Visit>
  void around(const Vec3& at, const Grid& other, const Column<Placed>& balls, Visit&& visit) const {
    const Grid::Place centre = other.place(at);
    const Vec3 low = other.corner(centre, -1).cwiseMax(box_.min);
    const Vec3 high = other.corner(centre, 2).cwiseMin(box_.max);
    const Grid::Block block = grid_.block(low, high);
    fetch(block, true);
    const Code from = code(low);
    const Code to = code(high);
    grid_.for_each(block, [&](std::size_t index, const Grid::Place& place) {
      const Cell& cell = cells_[index];
      const Names& names = names_[index];
      // By two steps a place is surely on its side of a corner, by one it may be for all that is rounded. In
      // the cells between the outermost there is nothing to ask.
      auto inside = cell.size >= Size{0};
      auto surely = inside;
      for (std::size_t axis = 0; axis < axes_; ++axis) {
        if (place[axis] == block.low[axis]) {
          const Sizes beyond = stdx::static_simd_cast<Sizes>(cell.at[axis] - from[axis]);
          inside &= beyond >= Size{-1};
          surely &= beyond >= Size{2};
        }
        if (place[axis] == block.high[axis]) {
          const Sizes below = stdx::static_simd_cast<Sizes>(to[axis] - cell.at[axis]);
          inside &= below >= Size{-1};
          surely &= below >= Size{2};
        }
      }
      for (std::size_t slot = 0; slot < kCrowd; ++slot) {
        if (!inside[slot]) continue;
        if (surely[slot] || other.beside(centre, balls[names[slot]].position)) visit(names[slot]);
      }
      for (std::uint32_t ball = names[kCrowd]; ball != kNone; ball = next_[ball]) {
        if (other.beside(centre, balls[ball].position)) visit(ball);
      }
      return true;
    });
  }

  /// @param room  m, the largest radius that a ball tried there may have
  Spot spot(const Vec3& at, double room) const {
    // The sum is rounded, and nobody may be left out by it.
    const Vec3 reach = Vec3::Constant((room + largest_m_) * (1.0 + 0x1p-50));
    return {at, grid_.block(at - reach, at + reach)};
  }

  /// Calls visit(ball) for every ball whose surface may be within `room` of a spot, for as long as it returns
  /// true, and ends where one surely overlaps a ball of that size there.
  /// @pre The place is in the box, and size and room are no larger than the largest radius and what the spot
  /// is for.
  /// @return whether it went through
  template <class Visit>
  bool near(const Spot& spot, double size, double room, Visit&& visit) const {
    const Code centre = code(spot.at);
    const Limits limits(size * per_m_, room * per_m_);
    bool through = true;
    grid_.for_each(spot.cells, [&](std::size_t index, const Grid::Place& /*place*/) {
      const Cell& cell = cells_[index];
      const auto found = sieve(cell, centre, limits);
      const bool crowded = cell.size[kCrowd] != kNobody;
      if (stdx::none_of(found) && !crowded) return true;
      for (std::size_t slot = 0; slot < kCrowd && through; ++slot) {
        if (!found[slot]) continue;
        const float square = squared_steps(cell, slot, centre);
        const float far = limits.far + static_cast<float>(cell.size[slot]);
        const float close = limits.close + static_cast<float>(cell.size[slot]);
        if (square > far * far) continue;
        through = !(close > 0.0F && square < close * close) && visit(names_[index][slot]);
      }
      if (!crowded) return through;
      for (std::uint32_t ball = names_[index][kCrowd]; ball != kNone && through; ball = next_[ball]) {
        through = visit(ball);
      }
      return through;
    });
    return through;
  }

  /// Has what near() will read fetched from memory meanwhile, and where the ball will stand.
  void fetch(const Spot& spot) const {
    fetch(spot.at);
    fetch(spot.cells, false);
  }
  /// Has the cell of a place fetched.
  void fetch(const Vec3& at) const {
    const Grid::Place place = grid_.place(at);
    fetch({place, place}, true);
  }

 private:
  static constexpr std::uint32_t kNone = static_cast<std::uint32_t>(-1);
  static constexpr std::size_t kSlots = 8;
  /// The last slot is for all of the cell that have none: there are too many, or they are outside of the box.
  static constexpr std::size_t kCrowd = kSlots - 1;

  /// Along an axis a ball in a cell that a search looks at is at most as far away as a cell is long and two
  /// balls reach. That is made kFarthest coarse steps of 2⁷ steps. Below zero they are rounded down to 147,
  /// and the sum of three squares fits into 16 bits, as the steps themselves do with their sign.
  static constexpr double kFarthest = 146.0;
  static constexpr int kCoarseBits = 7;
  static constexpr double kCoarse = 1 << kCoarseBits;
  static_assert(3 * 147 * 147 < 1 << 16 && 147 << kCoarseBits < 1 << 15);

  template <class T>
  using Lanes = stdx::simd<T, stdx::simd_abi::deduce_t<T, kSlots>>;
  using Codes = Lanes<std::uint16_t>;
  /// Steps along each axis, rounded down, modulo 2¹⁶.
  using Code = std::array<std::uint16_t, 3>;
  /// Steps, rounded up.
  using Size = std::int16_t;
  using Sizes = Lanes<Size>;
  static constexpr Size kNobody = std::numeric_limits<Size>::min();  ///< of a slot that is free

  struct alignas(64) Cell {
    std::array<Codes, 3> at = {Codes(0), Codes(0), Codes(0)};
    Sizes size = kNobody;
  };
  static_assert(sizeof(Cell) == 64);

  /// The balls of a cell by their slots; in the last one, the first of a chain.
  struct alignas(32) Names : std::array<std::uint32_t, kSlots> {
    Names() { fill(kNone); }
  };

  /// Two places are each rounded down to a step, so their difference is off by less than one step along an
  /// axis, and its length by less than √3 steps; by 1.75 coarse steps where the difference is rounded down
  /// once more. A size is rounded up by a step at most. To coarse steps it and the room are rounded down, by
  /// less than one each. The rest is for single precision, which rounds 2¹⁵ steps by 2⁻²⁴ of it, a few times.
  struct Limits {
    Limits(double size, double room)
        : coarse(static_cast<Size>(room / kCoarse + 1.75 + 1.0 + 1.0)),
          far(static_cast<float>(room + 2.0)),
          close(static_cast<float>(size - 2.0 - 1.0)) {}
    Size coarse;  ///< coarse steps to a surface: from there on it is not within the room
    float far;    ///< steps to a surface: beyond it is not
    float close;  ///< steps to a surface: within, the balls overlap
  };

  /// Which slots may hold a ball with its surface within the limits.
  static Codes::mask_type sieve(const Cell& cell, const Code& centre, const Limits& limits) {
    const auto square = [&](std::size_t axis) {
      const Sizes steps = stdx::static_simd_cast<Sizes>(cell.at[axis] - centre[axis]);
      const auto coarse = stdx::static_simd_cast<Codes>(steps >> kCoarseBits);
      return Codes(coarse * coarse);
    };
    const Sizes reach = (cell.size >> kCoarseBits) + limits.coarse;
    const auto far = stdx::static_simd_cast<Codes>(stdx::max(reach, Sizes(0)));
    return square(0) + square(1) + square(2) < far * far;
  }

  static float squared_steps(const Cell& cell, std::size_t slot, const Code& centre) {
    float sum = 0.0F;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto steps = static_cast<float>(static_cast<Size>(cell.at[axis][slot] - centre[axis]));
      sum += steps * steps;
    }
    return sum;
  }

  static std::size_t free_slot(const Cell& cell) {
    const auto free = cell.size < Size{0};
    return stdx::any_of(free) ? static_cast<std::size_t>(stdx::find_first_set(free)) : kCrowd;
  }

  bool box_has(const Vec3& at) const {
    return (at.array() >= box_.min.array()).all() && (at.array() <= box_.max.array()).all();
  }

  Code code(const Vec3& at) const {
    const Vec3 steps = (at - box_.min) * per_m_;
    Code code{};
    for (int axis = 0; axis < 3; ++axis) {
      code[static_cast<std::size_t>(axis)] =
          static_cast<std::uint16_t>(static_cast<std::int64_t>(steps[axis]));
    }
    return code;
  }

  void fetch(const Grid::Block& block, bool with_names) const {
    grid_.for_each(block, [&](std::size_t index, const Grid::Place& /*place*/) {
      prefetch(&cells_[index]);
      if (with_names) prefetch(&names_[index]);
      return true;
    });
  }

  /// With three balls to a cell, few have more than seven. Along a side that is much longer than the others
  /// there are fewer cells, so that in a flat box they do not outnumber the balls by much.
  static Grid a_few_in_each(std::size_t count, const Box& box, int dimension) {
    constexpr double kFew = 3.0;
    constexpr double kLongest = 8.0;
    double volume = 1.0;
    for (int axis = 0; axis < dimension; ++axis) volume *= box.max[axis] - box.min[axis];
    const double along_cube = std::pow(static_cast<double>(count) / kFew, 1.0 / dimension);
    return {box, dimension, std::pow(volume, 1.0 / dimension) / along_cube,
            std::max(1.0, kLongest * along_cube)};
  }

  Box box_;
  std::size_t axes_;  ///< that the cells are counted along
  double largest_m_;
  Grid grid_;
  double per_m_;  ///< steps in a metre
  Column<Cell> cells_;
  Column<Names> names_;
  Column<std::uint32_t> next_;  ///< in the chain of those without a slot
};

}  // namespace carom
