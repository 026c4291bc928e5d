#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/broad_phase/count.h"
#include "carom/broad_phase/reach.h"

namespace carom {

/// A quadtree or octree: a square (cube) around all centres, cut into 2^Dim equal cells, and these cut again
/// as long as they hold many balls. Its pairs are those of BruteForce, where the contract of a broad phase
/// stands.
///
/// A ball goes down to the cell that its centre is in, but stays where the cells below are narrower than
/// itself, so large balls are kept high up and small ones far down: the spread of sizes costs nothing. The
/// tree is loose: reaches stick out of their cells, and what a search looks at is the box around all reaches
/// kept at a node and below. Source: T. Ulrich, "Loose Octrees", Game Programming Gems (2000), §4.11.
///
/// Nodes lie in an array, each before those below it, and `skip` leads past these. A search is one loop
/// without a stack: on to the next node where the boxes touch, past it and all below it where not. Built in
/// O(n log n) and searched for all pairs in O(n log n) and what is found.
template <int Dim, class Count = NoCount>
class Tree {
 public:
  static constexpr std::string_view kName = Dim == 2 ? "quadtree" : "octree";

  void build(const VectorColumn<Dim>& position, Bounds bound) {
    bound_ = bound;
    nodes_.clear();
    take_balls(position);
    if (items_.empty()) return;
    grow({0, static_cast<std::uint32_t>(items_.size())}, cell_of_all(), 0, 0);
    note_nodes();
  }

  std::size_t size() const { return items_.size(); }

  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for_each_pair(0, size(), visit);
  }

  /// The pairs of a stretch of the balls as they stand in the nodes: of all nodes that begin there. Every
  /// pair is found at that of its two nodes which comes first.
  template <class Visit>
  void for_each_pair(std::size_t begin, std::size_t end, Visit&& visit) const {
    std::vector<ReachBox<Dim>> boxes;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const Range own = nodes_[n].own;
      if (own.first < begin || own.first >= end) continue;
      boxes.clear();
      for (std::uint32_t a = own.first; a < own.end; ++a)
        boxes.push_back(ReachBox<Dim>::around(items_[a].reach));
      for (std::uint32_t a = own.first; a < own.end; ++a) {
        for (std::uint32_t b = a + 1; b < own.end; ++b) visit_if_near(items_[a], items_[b], visit);
      }
      search(box_around(own), n + 1, [&](const Node& other) { visit_across(own, boxes, other, visit); });
    }
  }

  /// The boxes of the node and of those above it grow with the ball.
  void bound_grew(std::size_t ball) {
    Item& item = items_[place_of_[ball]];
    item.reach.bound = bound_[ball];
    const auto box = ReachBox<Dim>::around(item.reach);
    std::uint32_t n = item.node;
    nodes_[n].box.include(box);
    while (n != 0) {
      n = nodes_[n].parent;
      nodes_[n].box.include(box);
    }
  }

  template <class Visit>
  void for_each_near(const Reach<Dim>& reach, Visit&& visit) const {
    search(ReachBox<Dim>::around(reach), 0, [&](const Node& node) {
      for (std::uint32_t b = node.own.first; b < node.own.end; ++b) {
        if (meets(reach, items_[b].reach)) visit(std::size_t{items_[b].ball});
      }
    });
  }

  /// Node by node, each before those below it: balls that are found together stand together.
  void hand_over_order(Column<std::uint32_t>& balls) const {
    for (const Item& item : items_) balls.push_back(item.ball);
  }

  /// Calls visit(low corner, high corner, number of balls kept here and not further down) for every cell,
  /// each before those inside it.
  template <class Visit>
  void for_each_cell(Visit&& visit) const {
    for (const Node& node : nodes_) {
      const Vec<Dim> half = Vec<Dim>::Constant(node.cell.half_width);
      visit(Vec<Dim>(node.cell.centre - half), Vec<Dim>(node.cell.centre + half), node.own.size());
    }
  }

  const Count& count() const { return count_; }

 private:
  static constexpr std::size_t kChildren = std::size_t{1} << Dim;
  /// Up to this many balls a cell is not cut. Steps of 2D gases of packing 0.1 with 128 to 8192 balls, sizes
  /// 1:1 to 1:1000, took 1.3 times as long with 8, 1.06 times as long with 12, and with 24 as long; of 3D
  /// gases of 10³ to 10⁶ balls, sizes 1:20, 0.83 to 0.95 times as long with 48 as with 16, and with 64 as
  /// long.
  static constexpr std::uint32_t kFewBalls = Dim == 2 ? 16 : 48;
  /// A cell this deep is 2⁻⁶⁴ as wide as the whole, finer than coordinates are resolved. Only centres that
  /// are as good as one get here, and only if their bounds are as small.
  static constexpr int kMostCuts = 64;

  /// Places in items_ from first on, up to but without end.
  struct Range {
    std::uint32_t first;
    std::uint32_t end;
    std::uint32_t size() const { return end - first; }
  };

  struct Cell {
    Vec<Dim> centre;
    double half_width;  ///< m

    /// Bit k of the child's number says that it is on the high side of axis k.
    std::size_t child_at(const Vec<Dim>& place) const {
      std::size_t child = 0;
      for (int axis = 0; axis < Dim; ++axis) {
        if (place[axis] >= centre[axis]) child |= std::size_t{1} << axis;
      }
      return child;
    }

    Cell child(std::size_t number) const {
      Cell result{centre, 0.5 * half_width};
      for (int axis = 0; axis < Dim; ++axis) {
        result.centre[axis] += (number >> axis & 1U) != 0 ? result.half_width : -result.half_width;
      }
      return result;
    }
  };

  struct Item {
    Reach<Dim> reach;
    std::uint32_t ball;
    std::uint32_t node;
  };

  struct Node {
    ReachBox<Dim> box;  ///< around the reaches of own balls and of those below
    Cell cell;
    Range own;             ///< the balls that stay here
    std::uint32_t skip;    ///< the next node that is not below this one
    std::uint32_t parent;  ///< of the root itself
  };

  /// Where the balls of a cell go: the first part stays, then one for each child. Part k is what lies between
  /// bounds k and k + 1.
  using Parts = std::array<std::uint32_t, kChildren + 2>;

  void take_balls(const VectorColumn<Dim>& position) {
    items_.resize(bound_.size());
    for (std::size_t i = 0; i < items_.size(); ++i) {
      items_[i] = {{position[i], bound_[i]}, static_cast<std::uint32_t>(i), 0};
    }
    part_of_.resize(items_.size());
    place_of_.resize(items_.size());
  }

  Cell cell_of_all() const {
    Vec<Dim> low = items_.front().reach.centre;
    Vec<Dim> high = low;
    for (const Item& item : items_) {
      low = low.cwiseMin(item.reach.centre);
      high = high.cwiseMax(item.reach.centre);
    }
    return {0.5 * (low + high), 0.5 * (high - low).maxCoeff()};
  }

  /// Makes the node of these balls and all nodes below it; returns its number.
  std::uint32_t grow(Range balls, Cell cell, std::uint32_t parent, int cuts) {
    const Parts parts = cut(balls, cell, cuts);
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    const Range own{parts[0], parts[1]};
    nodes_.push_back({box_around(own), cell, own, 0, parent});
    for (std::size_t child = 0; child < kChildren; ++child) {
      const Range below{parts[child + 1], parts[child + 2]};
      if (below.size() == 0) continue;
      const std::uint32_t made = grow(below, cell.child(child), number, cuts + 1);
      nodes_[number].box.include(nodes_[made].box);
    }
    nodes_[number].skip = static_cast<std::uint32_t>(nodes_.size());
    return number;
  }

  /// Sorts the balls of a cell into those that stay and those of each child. Where all are in one child the
  /// cell becomes that child, and is cut again: there are no nodes with nothing but one node below.
  Parts cut(Range balls, Cell& cell, int& cuts) {
    for (; balls.size() > kFewBalls && cuts < kMostCuts; ++cuts) {
      const Parts parts = count_parts(balls, cell);
      const auto only =
          std::adjacent_find(parts.begin() + 1, parts.end(),
                             [&](std::uint32_t a, std::uint32_t b) { return b - a == balls.size(); });
      if (only == parts.end()) {
        sort_into(balls, parts);
        return parts;
      }
      cell = cell.child(static_cast<std::size_t>(only - parts.begin()) - 1);
    }
    Parts all_stay;
    all_stay.fill(balls.end);
    all_stay[0] = balls.first;
    return all_stay;
  }

  Parts count_parts(Range balls, const Cell& cell) {
    count_.build_operations(balls.size());
    Parts parts{};
    for (std::uint32_t a = balls.first; a < balls.end; ++a) {
      const Reach<Dim>& reach = items_[a].reach;
      // A child is as wide as half this cell, and a ball as wide as two of its bounds.
      const bool stays = 2.0 * reach.bound > cell.half_width;
      part_of_[a] = static_cast<std::uint8_t>(stays ? 0 : 1 + cell.child_at(reach.centre));
      ++parts[part_of_[a] + std::size_t{1}];
    }
    parts[0] = balls.first;
    std::partial_sum(parts.begin(), parts.end(), parts.begin());
    return parts;
  }

  /// Puts every ball into its part, by changing places with one that stands in the way. The balls were in
  /// this order not long ago, so that few have to.
  void sort_into(Range balls, const Parts& parts) {
    count_.build_operations(balls.size());
    Parts next = parts;
    for (std::uint8_t part = 0; part <= kChildren; ++part) {
      for (std::uint32_t& a = next[part]; a < parts[part + std::size_t{1}];) {
        if (part_of_[a] == part) {
          ++a;
          continue;
        }
        const std::uint32_t there = next[part_of_[a]]++;
        std::swap(items_[a], items_[there]);
        std::swap(part_of_[a], part_of_[there]);
      }
    }
  }

  void note_nodes() {
    for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
      for (std::uint32_t a = nodes_[n].own.first; a < nodes_[n].own.end; ++a) {
        items_[a].node = n;
        place_of_[items_[a].ball] = a;
      }
    }
  }

  ReachBox<Dim> box_around(Range balls) const {
    ReachBox<Dim> box;
    for (std::uint32_t a = balls.first; a < balls.end; ++a) {
      box.include(ReachBox<Dim>::around(items_[a].reach));
    }
    return box;
  }

  /// Calls at(node) for the nodes from `first` on whose boxes touch the given one.
  template <class At>
  void search(const ReachBox<Dim>& box, std::size_t first, At&& at) const {
    for (std::size_t n = first; n < nodes_.size();) {
      count_.cell_visits(1);
      if (!box.touches(nodes_[n].box)) {
        n = nodes_[n].skip;
        continue;
      }
      at(nodes_[n]);
      ++n;
    }
  }

  /// Pairs of own balls, in these boxes, with those kept at another node.
  template <class Visit>
  void visit_across(Range own, std::span<const ReachBox<Dim>> boxes, const Node& other, Visit&& visit) const {
    for (std::uint32_t a = own.first; a < own.end; ++a) {
      if (!boxes[a - own.first].touches(other.box)) continue;
      for (std::uint32_t b = other.own.first; b < other.own.end; ++b) {
        visit_if_near(items_[a], items_[b], visit);
      }
    }
  }

  template <class Visit>
  void visit_if_near(const Item& a, const Item& b, Visit&& visit) const {
    if (meets(a.reach, b.reach))
      visit(std::size_t{std::min(a.ball, b.ball)}, std::size_t{std::max(a.ball, b.ball)});
  }

  bool meets(const Reach<Dim>& a, const Reach<Dim>& b) const {
    count_.pair_test();
    return may_meet(a, b);
  }

  Bounds bound_;
  Column<Item> items_;  ///< the balls, node by node
  Column<Node> nodes_;
  Column<std::uint32_t> place_of_;  ///< of each ball in items_
  Column<std::uint8_t> part_of_;    ///< for use while building
  [[no_unique_address]] Count count_;
};

}  // namespace carom
