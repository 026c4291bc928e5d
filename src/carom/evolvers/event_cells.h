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

#include "carom/evolvers/permute.h"
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
      : is_giant_(radius.size(), 0), cell_(radius.size()), next_(radius.size()), previous_(radius.size()) {
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
    unlink(ball);
    cell_[ball][static_cast<std::size_t>(axis)] += direction;
    link(ball);
  }

  /// Writes down all in the cells around the ball's own, and giants; with them the ball itself. Returns the
  /// part of the room that it took. @pre the room is for all balls and one more
  std::span<std::uint32_t> find_near(std::uint32_t ball, std::span<std::uint32_t> room) const {
    if (!holds(ball)) {
      std::iota(room.begin(), room.end(), 0U);
      return room.first(is_giant_.size());
    }
    std::copy(giants_.begin(), giants_.end(), room.begin());
    return room.first(gather_block(ball, around_, room, giants_.size()));
  }

  /// The same with all in the cells that came near by a crossing.
  std::span<std::uint32_t> find_ahead(std::uint32_t ball, int axis, int direction,
                                      std::span<std::uint32_t> room) const {
    std::array<Span, Dim> spans = around_;
    spans[static_cast<std::size_t>(axis)] = {direction, direction};
    return room.first(gather_block(ball, spans, room, 0));
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
    std::iota(giants_.begin(), giants_.end(), 0U);
    std::fill(heads_.begin(), heads_.end(), kNobody);
    for (auto ball = static_cast<std::uint32_t>(giants_.size()); ball < cell_.size(); ++ball) link(ball);
  }

 private:
  static constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

  /// Cells are wider than the largest diameter by this part of it: room for the rounding of positions.
  static constexpr double kMargin = 1.0 / 1024.0;

  /// On average, at the least: narrower cells are crossed more often than they spare looks.
  static constexpr double kBallsInCell = 0.5;

  static constexpr double kCellsAround = Dim == 2 ? 9.0 : 27.0;
  /// Along an axis; a ball beyond would be in the last one, and those are as many as integers allow.
  static constexpr double kMostCells = 0x1p62;
  static constexpr double kNoCells = std::numeric_limits<double>::infinity();

  using Cell = std::array<std::int64_t, Dim>;

  /// Cells to visit along an axis, counted from a ball's own.
  struct Span {
    std::int64_t first;
    std::int64_t last;
  };

  /// The width of cells for balls up to this radius: no narrower than what holds kBallsInCell.
  double width_for(double radius) const { return std::max(2.0 * radius * (1.0 + kMargin), spacing_); }

  /// The box that the balls stand in, at least as thick as the largest of them.
  void measure(const VectorColumn<Dim>& position, std::span<const double> radius) {
    const double thickness = 2.0 * *std::max_element(radius.begin(), radius.end());
    volume_ = 1.0;
    for (int axis = 0; axis < Dim; ++axis) {
      const auto along = position.axis(axis);
      const auto [low, high] = std::minmax_element(along.begin(), along.end());
      origin_[axis] = *low;
      extent_[axis] = std::max(*high - *low, thickness);
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
      bits[k] = bit_width(static_cast<std::size_t>(cells));
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
    for (std::size_t k = 0; k < Dim; ++k) {
      shares_[k].assign(std::size_t{1} << static_cast<std::size_t>(bits[k]), 0);
      // An axis of one or two entries is all around with less than three of them.
      around_[k] = {bits[k] == 0 ? 0 : -1, bits[k] < 2 ? 0 : 1};
    }
    std::size_t axis = 0;
    std::array<int, Dim> taken{};
    for (int bit = 0; bit < all_bits; ++bit) {
      while (taken[axis] == bits[axis]) axis = (axis + 1) % Dim;
      for (std::size_t number = 0; number < shares_[axis].size(); ++number) {
        shares_[axis][number] |= static_cast<std::uint32_t>((number >> taken[axis]) & 1U) << bit;
      }
      ++taken[axis];
      axis = (axis + 1) % Dim;
    }
  }

  void place(std::uint32_t ball, const Vec<Dim>& position) {
    for (int axis = 0; axis < Dim; ++axis) {
      const double number = std::min(std::floor((position[axis] - origin_[axis]) / width_), kMostCells);
      cell_[ball][static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(number);
    }
    link(ball);
  }

  static int bit_width(std::size_t number) { return static_cast<int>(std::bit_width(number)); }

  /// The bits of one axis in the number of a table entry: those of the cell's number, wrapped around.
  std::uint32_t along(std::size_t axis, std::int64_t number) const {
    return shares_[axis][static_cast<std::size_t>(number) & (shares_[axis].size() - 1)];
  }

  std::uint32_t& head_of(std::uint32_t ball) {
    std::uint32_t entry = 0;
    for (std::size_t k = 0; k < Dim; ++k) entry |= along(k, cell_[ball][k]);
    return heads_[entry];
  }

  void link(std::uint32_t ball) {
    std::uint32_t& head = head_of(ball);
    next_[ball] = head;
    previous_[ball] = kNobody;
    if (head != kNobody) previous_[head] = ball;
    head = ball;
  }

  void unlink(std::uint32_t ball) {
    const std::uint32_t next = next_[ball];
    const std::uint32_t previous = previous_[ball];
    (previous == kNobody ? head_of(ball) : next_[previous]) = next;
    if (next != kNobody) previous_[next] = previous;
  }

  /// Writes down who is in a block of cells, from a place of the room on, and returns where they end. Whether
  /// a cell is empty, and whether a ball is its last, is a toss of a coin, so that no branch is taken on it:
  /// each is written, and kept if it is somebody. First come the heads, then whoever stands behind somebody.
  std::size_t gather_block(std::uint32_t ball, const std::array<Span, Dim>& spans,
                           std::span<std::uint32_t> room, std::size_t begin) const {
    std::size_t end = begin;
    const auto gather = [&](std::uint32_t other) {
      room[end] = other;
      end += other != kNobody ? 1 : 0;
    };
    const Cell& cell = cell_[ball];
    const auto gather_row = [&](std::uint32_t row) {
      for (std::int64_t x = cell[0] + spans[0].first; x <= cell[0] + spans[0].last; ++x) {
        gather(heads_[row | along(0, x)]);
      }
    };
    for (std::int64_t y = cell[1] + spans[1].first; y <= cell[1] + spans[1].last; ++y) {
      if constexpr (Dim == 2) {
        gather_row(along(1, y));
      } else {
        for (std::int64_t z = cell[2] + spans[2].first; z <= cell[2] + spans[2].last; ++z) {
          gather_row(along(1, y) | along(2, z));
        }
      }
    }
    for (std::size_t k = begin; k < end; ++k) gather(next_[room[k]]);
    return end;
  }

  std::vector<std::uint32_t> giants_;
  std::vector<std::uint8_t> is_giant_;
  std::vector<Cell> cell_;
  std::vector<std::uint32_t> next_;                     ///< ball in the same entry of the table
  std::vector<std::uint32_t> previous_;                 ///< the same, backwards
  std::vector<std::uint32_t> heads_;                    ///< the table: a ball in each entry
  std::array<std::vector<std::uint32_t>, Dim> shares_;  ///< of the cells along an axis in the entry's number
  std::array<Span, Dim> around_{};                      ///< the cells around one
  Vec<Dim> origin_;                                     ///< m, where cells are counted from
  Vec<Dim> extent_;                                     ///< m, of the box that the balls stood in
  double volume_ = 0.0;                                 ///< m^Dim, of that box
  double spacing_ = 0.0;                                ///< m, the width of a cell that holds kBallsInCell
  double width_ = kNoCells;                             ///< m, of a cell
};

}  // namespace carom
