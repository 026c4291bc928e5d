#include "carom/broad_phase/list.h"

#include <algorithm>

#include "carom/broad_phase/brute_force.h"
#include "carom/broad_phase/nobody_meets.h"
#include "carom/broad_phase/sort_and_sweep.h"
#include "carom/broad_phase/tree.h"
#include "carom/broad_phase/uniform_grid.h"
#include "carom/broad_phase/wrapped_grid.h"

namespace carom {

namespace {

// The choice is by measured time, ns per ball and step: build, all pairs, and the neighbours of every tenth
// ball, in a gas of packing 0.1 (GCC 12, -O3, x86-64; the least of five runs).
//
//          balls  sizes    brute  sweep   grid   tree
//   2D        96  1:1         62     70     70     64
//            128  1:1         80     68     78     59
//           1024  1:1        839    101     79     99
//          16384  1:1               176     85    142
//          16384  1:3               176    118    134
//          16384  1:4               177    128    140
//          16384  1:20              173    224    134
//          16384  1:1000            155   2183    129
//   3D        96  1:1         77     85    221     91
//            128  1:1        101     90    227    131
//           1024  1:1       1270    171    232    221
//          16384  1:1               951    243    302
//          16384  1:3               897    342    286
//          16384  1:20              813    959    264
//          16384  1:1000            463   7423    236

/// Up to this many balls looking at all pairs is the cheapest.
constexpr std::size_t kFewBalls = 100;
/// From this many on the candidates in a slab across the space are too many for a sweep.
constexpr std::size_t kManyBalls = 1000;
/// Largest radius over smallest above which a tree is faster than one grid for each octave of sizes.
constexpr double kGridSpread = 3.0;

template <int Dim>
struct Row {
  std::string_view name;
  std::unique_ptr<BroadPhase<Dim>> (*make)();
};

template <int Dim, class Visitor>
Row<Dim> row() {
  return {Visitor::kName, []() -> std::unique_ptr<BroadPhase<Dim>> {
            return std::make_unique<BroadPhaseOf<Dim, Visitor>>();
          }};
}

/// A new broad phase is a header beside this one and a row here.
template <int Dim>
std::vector<Row<Dim>> rows() {
  return {row<Dim, BruteForce<Dim>>(), row<Dim, UniformGrid<Dim>>(), row<Dim, SortAndSweep<Dim>>(),
          row<Dim, Tree<Dim>>(), row<Dim, WrappedGrid<Dim>>()};
}

template <int Dim>
std::vector<std::string_view> names() {
  std::vector<std::string_view> names;
  for (const Row<Dim>& row : rows<Dim>()) names.push_back(row.name);
  return names;
}

/// Largest radius over smallest. @pre there are balls
double size_spread(const std::vector<Ball>& balls) {
  const auto [smallest, largest] = std::minmax_element(
      balls.begin(), balls.end(), [](const Ball& a, const Ball& b) { return a.radius < b.radius; });
  return largest->radius / smallest->radius;
}

template <int Dim>
std::string_view suitable(const std::vector<Ball>& balls) {
  if (balls.size() <= kFewBalls) return BruteForce<Dim>::kName;
  if (balls.size() < kManyBalls) return SortAndSweep<Dim>::kName;
  return size_spread(balls) <= kGridSpread ? WrappedGrid<Dim>::kName : Tree<Dim>::kName;
}

}  // namespace

std::vector<std::string_view> broad_phase_names(int dimension) {
  return dimension == 2 ? names<2>() : names<3>();
}

template <int Dim>
std::unique_ptr<BroadPhase<Dim>> make_broad_phase(const Scenario& scene, std::string_view name) {
  if (!scene.effects.collisions) return std::make_unique<BroadPhaseOf<Dim, NobodyMeets<Dim>>>();
  if (name.empty()) name = suitable<Dim>(scene.balls);
  for (const Row<Dim>& row : rows<Dim>()) {
    if (row.name == name) return row.make();
  }
  return nullptr;
}

template std::unique_ptr<BroadPhase<2>> make_broad_phase<2>(const Scenario&, std::string_view);
template std::unique_ptr<BroadPhase<3>> make_broad_phase<3>(const Scenario&, std::string_view);

}  // namespace carom
