#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "carom/permute.h"
#include "carom/world.h"

namespace carom {

/// Who is near whom, kept up to date by the balls' crossings from cell to cell.
///
/// Cells are cubes of one width, wider than the sum of any two radii in them, so that balls in cells that do
/// not touch are apart. Space has no edge: cells are numbered without end, and wrapped around into a table of
/// a power of two along each axis. Cells that share an entry of the table make each other's balls look near,
/// which costs time and changes nothing else.
///
/// Balls too large for the cells are giants: near everybody, in no cell. Who is a giant is decided by what it
/// would cost (choose_giants()); in a scene of a few balls all are.
template <int Dim>
class EventCells {
 public:
  EventCells(const VectorColumn<Dim>& position, std::span<const double> radius)
      : is_giant_(radius.size(), 0),
        cell_(radius.size()),
        entry_(radius.size()),
        next_(radius.size()),
        previous_(radius.size()) {
    measure(position, radius);
    choose_giants(radius);
    if (giants_.size() == radius.size()) return;
    choose_table();
    for (std::uint32_t ball = 0; ball < radius.size(); ++ball) {
      if (is_giant_[ball] == 0) place(ball, position[ball]);
    }
  }

  double width_m() const { return width_; }
  std::size_t giants() const { return giants_.size(); }

  /// Whether the ball is in a cell, and has crossings.
  bool holds(std::uint32_t ball) const { return is_giant_[ball] == 0; }

  /// The lowest corner of the ball's cell, m.
  Vec<Dim> lower_corner(std::uint32_t ball) const {
    Vec<Dim> corner = origin_;
    for (std::size_t k = 0; k < Dim; ++k) {
      corner[static_cast<int>(k)] += width_ * static_cast<double>(cell_[ball][k]);
    }
    return corner;
  }

  /// Moves the ball to the next cell along the axis; direction is 1 or -1.
  void cross(std::uint32_t ball, int axis, int direction) {
    const auto k = static_cast<std::size_t>(axis);
    unlink(ball);
    cell_[ball][k] += direction;
    entry_[ball] = (entry_[ball] & ~masks_[k]) | beside(entry_[ball], k, direction);
    link(ball);
  }

  /// Visits all in the cells around the ball's own, and giants; with them the ball itself.
  /// @param room  to write down whom to visit: for all balls and one more
  template <class Visit>
  void visit_near(std::uint32_t ball, std::span<std::uint32_t> room, const Visit& visit) const {
    if (!holds(ball)) {
      for (std::uint32_t other = 0; other < is_giant_.size(); ++other) visit(other);
      return;
    }
    for (const std::uint32_t giant : giants_) visit(giant);
    visit_cells(entry_[ball], 0, around(entry_[ball], 0), room, visit);
  }

  /// The same with all in the cells that came near by a crossing.
  template <class Visit>
  void visit_ahead(std::uint32_t ball, int axis, int direction, std::span<std::uint32_t> room,
                   const Visit& visit) const {
    const auto k = static_cast<std::size_t>(axis);
    const std::array ahead = {beside(entry_[ball], k, direction)};
    visit_cells(entry_[ball], k, ahead, room, visit);
  }

  /// The balls in the order of the table, in which those that are near in space are near: giants first.
  std::vector<std::uint32_t> order() const {
    std::vector<std::uint32_t> balls = giants_;
    balls.reserve(cell_.size());
    for (const std::uint32_t head : heads_) {
      for (std::uint32_t ball = head; ball != kNobody; ball = next_[ball]) balls.push_back(ball);
    }
    return balls;
  }

  /// Numbers the balls anew: ball `order[k]` becomes ball k. @pre from order()
  void renumber(const std::vector<std::uint32_t>& order) {
    permute(is_giant_, order);
    permute(cell_, order);
    permute(entry_, order);
    std::iota(giants_.begin(), giants_.end(), 0U);
    std::fill(heads_.begin(), heads_.end(), kNobody);
    for (auto ball = static_cast<std::uint32_t>(giants_.size()); ball < cell_.size(); ++ball) link(ball);
  }

 private:
  static constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t kHighestBit = std::numeric_limits<std::uint32_t>::digits - 1;

  /// Cells are wider than the largest diameter by this part of it: room for the rounding of positions.
  static constexpr double kMargin = 1.0 / 1024.0;

  /// On average, at the least: narrower cells are crossed more often than they spare looks.
  static constexpr double kBallsInCell = 0.5;

  static constexpr double kCellsAround = Dim == 2 ? 9.0 : 27.0;
  /// Along an axis; a ball beyond would be in the last one, and those are as many as integers allow.
  static constexpr double kMostCells = 0x1p62;
  static constexpr double kNoCells = std::numeric_limits<double>::infinity();

  using Cell = std::array<std::int64_t, Dim>;

  /// Fewest entries along an axis, as a power of two: three cells in a row have entries of their own.
  static constexpr int kFewestBits = 2;

  /// The width of cells for balls up to this radius: no narrower than what holds kBallsInCell.
  double width_for(double radius) const { return std::max(2.0 * radius * (1.0 + kMargin), spacing_); }

  /// The box that the balls stand in, at least as thick as the largest of them.
  void measure(const VectorColumn<Dim>& position, std::span<const double> radius) {
    const double thickness = 2.0 * *std::max_element(radius.begin(), radius.end());
    volume_ = 1.0;
    for (int axis = 0; axis < Dim; ++axis) {
      const auto [low, high] = position.range(axis);
      origin_[axis] = low;
      extent_[axis] = std::max(high - low, thickness);
      volume_ *= extent_[axis];
    }
    spacing_ = std::pow(kBallsInCell * volume_ / static_cast<double>(radius.size()), 1.0 / Dim);
  }

  /// Takes the k largest balls out of the cells, with the k for which balls look at the fewest others. With
  /// the widest ball left of radius r_k, and so cells of width w, one of n balls looks at
  ///   k + (n - k) min(1, (3 w)^Dim / V) + 3^Dim                                          (1)
  /// others and cells, or at n others where there are no cells; and the giants, hit (r/r̃)^(Dim-1) times as
  /// often as a ball of the median radius r̃, look at n each, which is (r/r̃)^(Dim-1) for each ball.
  void choose_giants(std::span<const double> radius) {
    std::vector<std::uint32_t> by_size(radius.size());
    std::iota(by_size.begin(), by_size.end(), 0U);
    std::stable_sort(by_size.begin(), by_size.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return radius[a] > radius[b]; });
    const double median = radius[by_size[by_size.size() / 2]];
    std::size_t giants = by_size.size();
    auto lowest = static_cast<double>(by_size.size());
    double cost_of_giants = 0.0;
    for (std::size_t k = 0; k < by_size.size(); ++k) {
      const double largest = radius[by_size[k]];
      const double share = std::min(1.0, std::pow(3.0 * width_for(largest), Dim) / volume_);
      const double cost = cost_of_giants + static_cast<double>(by_size.size() - k) * share + kCellsAround;
      if (cost < lowest) {
        lowest = cost;
        giants = k;
      }
      cost_of_giants += 1.0 + std::pow(largest / median, Dim - 1);
    }
    giants_.assign(by_size.begin(), by_size.begin() + static_cast<std::ptrdiff_t>(giants));
    for (const std::uint32_t ball : giants_) is_giant_[ball] = 1;
    if (giants < by_size.size()) width_ = width_for(radius[by_size[giants]]);
  }

  /// As many entries along each axis as there are cells in the box, rounded up to a power of two; but in all
  /// not many more than balls, however thin the box is.
  void choose_table() {
    std::array<int, Dim> bits;
    int all_bits = 0;
    for (std::size_t k = 0; k < Dim; ++k) {
      const double cells = std::min(std::ceil(extent_[static_cast<int>(k)] / width_), kMostCells);
      bits[k] = std::max(bit_width(static_cast<std::size_t>(cells)), kFewestBits);
      all_bits += bits[k];
    }
    for (const int most = Dim + bit_width(cell_.size()); all_bits > most; --all_bits) {
      --*std::max_element(bits.begin(), bits.end());
    }
    interleave(bits, all_bits);
    heads_.assign(std::size_t{1} << static_cast<std::size_t>(all_bits), kNobody);
  }

  /// The number of an entry takes one bit of each axis in turn, so that entries that are near in space are
  /// near in memory, along whichever axis. After G. M. Morton, "A computer oriented geodetic data base"
  /// (IBM, 1966).
  void interleave(std::array<int, Dim> bits, int all_bits) {
    std::size_t axis = 0;
    for (int bit = 0; bit < all_bits; ++bit) {
      while (bits[axis] == 0) axis = (axis + 1) % Dim;
      masks_[axis] |= std::uint32_t{1} << static_cast<std::uint32_t>(bit);
      --bits[axis];
      axis = (axis + 1) % Dim;
    }
  }

  void place(std::uint32_t ball, const Vec<Dim>& position) {
    for (int axis = 0; axis < Dim; ++axis) {
      const double number = std::min(std::floor((position[axis] - origin_[axis]) / width_), kMostCells);
      const auto k = static_cast<std::size_t>(axis);
      cell_[ball][k] = static_cast<std::int64_t>(number);
      entry_[ball] |= spread(cell_[ball][k], masks_[k]);
    }
    link(ball);
  }

  static int bit_width(std::size_t number) { return static_cast<int>(std::bit_width(number)); }

  /// The lowest bits of a number, put where the mask has its bits: so that the number is wrapped around.
  static std::uint32_t spread(std::int64_t number, std::uint32_t mask) {
    std::uint32_t result = 0;
    for (std::uint32_t left = mask; left != 0; left &= left - 1) {
      if ((number & 1) != 0) result |= left & -left;
      number >>= 1;
    }
    return result;
  }

  /// The bits of one axis in the number of the next entry along it, up (direction 1) or down (-1), wrapped
  /// around. Less one, a borrow runs through the bits of other axes, where none is set; and less the mask,
  /// which is more by ~mask + 1, a carry, where all are.
  std::uint32_t beside(std::uint32_t entry, std::size_t axis, int direction) const {
    const std::uint32_t mask = masks_[axis];
    return ((entry & mask) - (direction > 0 ? mask : 1U)) & mask;
  }

  /// Those of an entry and the two beside it.
  std::array<std::uint32_t, 3> around(std::uint32_t entry, std::size_t axis) const {
    return {beside(entry, axis, -1), entry & masks_[axis], beside(entry, axis, 1)};
  }

  void link(std::uint32_t ball) {
    std::uint32_t& head = heads_[entry_[ball]];
    next_[ball] = head;
    previous_[ball] = kNobody;
    if (head != kNobody) previous_[head] = ball;
    head = ball;
  }

  void unlink(std::uint32_t ball) {
    const std::uint32_t next = next_[ball];
    const std::uint32_t previous = previous_[ball];
    (previous == kNobody ? heads_[entry_[ball]] : next_[previous]) = next;
    if (next != kNobody) previous_[next] = previous;
  }

  /// Visits who is in the entries around one, of those along an axis in the given ones. Whether a cell is
  /// empty, and whether a ball is its last, is a toss of a coin, so that no branch is taken on it: each is
  /// written down, and kept if it is somebody: of all numbers kNobody alone has the highest bit. First come
  /// the heads, then, while they are visited, whoever stands behind them.
  template <std::size_t kAlong, class Visit>
  void visit_cells(std::uint32_t entry, std::size_t axis, const std::array<std::uint32_t, kAlong>& along,
                   std::span<std::uint32_t> room, const Visit& visit) const {
    std::size_t end = 0;
    const auto write = [&](std::uint32_t other) {
      room[end] = other;
      end += ~other >> kHighestBit;
    };
    const auto second = around(entry, (axis + 1) % Dim);
    const auto third = around(entry, (axis + 2) % Dim);
    for (const std::uint32_t x : along) {
      for (const std::uint32_t y : second) {
        if constexpr (Dim == 2) {
          write(heads_[x | y]);
        } else {
          for (const std::uint32_t z : third) write(heads_[x | y | z]);
        }
      }
    }
    for (std::size_t k = 0; k < end; ++k) {
      const std::uint32_t other = room[k];
      write(next_[other]);
      visit(other);
    }
  }

  std::vector<std::uint32_t> giants_;
  std::vector<std::uint8_t> is_giant_;
  std::vector<Cell> cell_;
  std::vector<std::uint32_t> entry_;           ///< of the table, for each ball's cell
  std::vector<std::uint32_t> next_;            ///< ball in the same entry of the table
  std::vector<std::uint32_t> previous_;        ///< the same, backwards
  std::vector<std::uint32_t> heads_;           ///< the table: a ball in each entry
  std::array<std::uint32_t, Dim> masks_ = {};  ///< the bits of each axis in an entry's number
  Vec<Dim> origin_;                            ///< m, where cells are counted from
  Vec<Dim> extent_;                            ///< m, of the box that the balls stood in
  double volume_ = 0.0;                        ///< m^Dim, of that box
  double spacing_ = 0.0;                       ///< m, the width of a cell that holds kBallsInCell
  double width_ = kNoCells;                    ///< m, of a cell
};

}  // namespace carom
