// Counts what the broad phases do for gases of more and more balls, and prints by which power of their number
// it grows. It counts and does not time: no clock and no load of the machine has a part in its numbers.

#include <cmath>
#include <cstdint>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "carom/broad_phase/brute_force.h"
#include "carom/broad_phase/count.h"
#include "carom/broad_phase/sort_and_sweep.h"
#include "carom/broad_phase/tree.h"
#include "carom/broad_phase/uniform_grid.h"
#include "core/least_squares.h"
#include "core/random.h"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

/// Share of the cube that the balls would fill without overlap.
constexpr double kPacking = 0.1;
/// Up to here all pairs are looked at in a second.
constexpr std::size_t kMostByBruteForce = 10'000;

template <int Dim>
struct Gas {
  VectorColumn<Dim> position;  ///< m
  std::vector<float> bound;    ///< m
};

/// Balls anywhere in a cube, with bounds from 1/ratio to 1 m, every octave of sizes as common as every other.
template <int Dim>
Gas<Dim> gas(std::size_t count, double ratio) {
  Random random(count);
  Gas<Dim> result{VectorColumn<Dim>(count), {}};
  double volume = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double bound = std::pow(ratio, -random.uniform());
    volume += (Dim == 2 ? 1.0 : 4.0 / 3.0) * std::numbers::pi * std::pow(bound, Dim);
    result.bound.push_back(rounded_up(bound));
  }
  const double side = std::pow(volume / kPacking, 1.0 / Dim);
  for (std::size_t i = 0; i < count; ++i) {
    Vec<Dim> place;
    for (double& coordinate : place) coordinate = random.uniform(0.0, side);
    result.position.set(i, place);
  }
  return result;
}

/// One step's work of a broad phase: build, then all pairs.
template <class BroadPhase, int Dim>
Json work(const Gas<Dim>& balls) {
  BroadPhase broad_phase;
  broad_phase.build(balls.position, balls.bound);
  std::int64_t pairs = 0;
  broad_phase.for_each_pair([&pairs](std::size_t, std::size_t) { ++pairs; });
  const CountTests& count = broad_phase.count();
  return {{"balls", balls.bound.size()},        {"pairs", pairs},
          {"pair_tests", count.pair_tests()},   {"build_operations", count.build_operations()},
          {"cell_visits", count.cell_visits()}, {"total", count.total()}};
}

/// The power of the number of balls by which a column of the work grows, to four digits.
double exponent(const Json& rows, const std::string& column) {
  std::vector<double> log_balls;
  std::vector<double> log_cost;
  for (const Json& row : rows) {
    log_balls.push_back(std::log(row["balls"].get<double>()));
    log_cost.push_back(std::log(row[column].get<double>()));
  }
  return std::round(1e4 * line_through(log_balls, log_cost).slope) / 1e4;
}

template <int Dim, template <int, class> class BroadPhase>
Json growth(double ratio, std::size_t most_balls) {
  Json rows = Json::array();
  for (std::size_t balls = 100; balls <= most_balls; balls *= 10) {
    rows.push_back(work<BroadPhase<Dim, CountTests>>(gas<Dim>(balls, ratio)));
  }
  return {{"broad_phase", BroadPhase<Dim, CountTests>::kName},
          {"dimension", Dim},
          {"size_ratio", ratio},
          {"exponent_of_pair_tests", exponent(rows, "pair_tests")},
          {"exponent_of_total", exponent(rows, "total")},
          {"work", rows}};
}

template <int Dim>
void add_growths(double ratio, Json& all) {
  constexpr std::size_t kMostBalls = 100'000;
  all.push_back(growth<Dim, BruteForce>(ratio, kMostByBruteForce));
  all.push_back(growth<Dim, UniformGrid>(ratio, kMostBalls));
  all.push_back(growth<Dim, SortAndSweep>(ratio, kMostBalls));
  all.push_back(growth<Dim, Tree>(ratio, kMostBalls));
}

Json all_growths() {
  Json all = Json::array();
  for (const double ratio : {1.0, 20.0, 1000.0}) {
    add_growths<2>(ratio, all);
    add_growths<3>(ratio, all);
  }
  return all;
}

}  // namespace
}  // namespace carom

int main() {
  std::cout << carom::Json{{"packing", carom::kPacking}, {"growth", carom::all_growths()}}.dump(2) << "\n";
}
