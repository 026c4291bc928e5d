#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/vec.h"
#include "scenario/scenario.h"

namespace carom {

/// A box cut into equal cells, counted along each axis. What is outside of it is counted to the cell beside.
class Grid {
 public:
  using Place = std::array<std::int64_t, 3>;
  /// All cells from one to another.
  struct Block {
    Place low;
    Place high;
  };

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
      place[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::min(std::max(cells, 0.0), last));
    }
    return place;
  }

  /// The cells that have part in a block.
  Block block(const Vec3& low_corner, const Vec3& high_corner) const {
    return {place(low_corner), place(high_corner)};
  }

  std::size_t index(const Place& place) const {
    return static_cast<std::size_t>((place[2] * counts_[1] + place[1]) * counts_[0] + place[0]);
  }

  /// m, of a cell along the axis where it is longest.
  double longest_side(int dimension) const { return width_.head(dimension).maxCoeff(); }

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

  /// Calls visit(index, place) for every cell of a block, for as long as it returns true.
  template <class Visit>
  void for_each(const Block& block, Visit&& visit) const {
    for (std::int64_t z = block.low[2]; z <= block.high[2]; ++z) {
      for (std::int64_t y = block.low[1]; y <= block.high[1]; ++y) {
        const std::size_t row = index({0, y, z});
        for (std::int64_t x = block.low[0]; x <= block.high[0]; ++x) {
          if (!visit(row + static_cast<std::size_t>(x), Place{x, y, z})) return;
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

}  // namespace carom
