#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/engine.h"
#include "scenario/cast.h"
#include "scenario/scenario.h"

namespace carom {

/// Finds the deepest overlap in one moment of a scene after the other. Independent of every engine's own
/// search. @pre no event changes the balls
///
/// Who is near whom changes slowly: the pairs with a gap of less than two margins are listed, and the list
/// holds for as long as no ball has moved by more than one margin since. The margin is what balls move in a
/// few frames, as the first ones show; where that is more than a radius, each frame is listed anew, without a
/// margin.
class OverlapSearch {
 public:
  /// The scene outlives the search.
  explicit OverlapSearch(const Scenario& scenario);

  /// The deepest overlap among the balls, and of a ball with a wall, divided by the smaller radius; 0 where
  /// nothing overlaps. Balls that may pass through each other are not held against each other.
  /// @pre places are finite
  double deepest(std::span<const BallState> balls);

 private:
  using Cell = std::array<std::int64_t, 3>;

  /// The smallest box, along the axes, that the balls' centres are in.
  struct Extent {
    Vec3 low;
    Vec3 high;
  };
  /// A ball as a list was made of it, among those that a search looks at with it.
  struct Listed {
    Vec3 position;
    double radius = 0.0;
    std::uint32_t ball = 0;
  };

  static Extent extent_of(std::span<const BallState> balls);
  bool clear_of(const Wall& wall, const Extent& extent) const;
  double deepest_in_walls(std::span<const BallState> balls, const Extent& extent) const;
  double deepest_in_pairs(std::span<const BallState> balls) const;
  bool list_holds(std::span<const BallState> balls) const;
  void list(std::span<const BallState> balls, const Extent& extent);
  void list_by_sweep(std::span<const BallState> balls);
  void list_by_cells(std::span<const BallState> balls, const Extent& extent);
  void sort_into_cells(std::span<const BallState> balls, const Extent& extent);
  void list_around(const Cell& cell);
  std::size_t index(const Cell& cell) const;
  void list_if_near(const Listed& a, const Listed& b);

  const Scenario& scenario_;
  std::vector<double> radii_m_;
  double smallest_radius_m_ = 0.0;
  double largest_radius_m_ = 0.0;
  double margin_m_ = 0.0;
  std::vector<Vec3> listed_at_;  ///< where the balls were when the list was made; empty before the first
  std::vector<std::pair<std::uint32_t, std::uint32_t>> near_;
  // What listing works in, kept from one time to the next.
  std::vector<Listed> sorted_;         ///< the balls, along x or by cell
  std::vector<std::size_t> cell_of_;   ///< by ball
  std::vector<std::uint32_t> starts_;  ///< of each cell in sorted_, x fastest, and the end
  Cell counts_{};                      ///< of cells along each axis
};

/// The same of a single moment, and where balls come, go and change: sorts along x and looks only at balls
/// whose extents overlap there.
/// @param cast  the balls that are there, with their radii
double deepest_overlap(const Scenario& scenario, const Cast& cast, std::span<const BallState> balls);

/// The same of the balls that the scene begins with.
double deepest_overlap(const Scenario& scenario, std::span<const BallState> balls);

}  // namespace carom
